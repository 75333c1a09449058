// SPDX-License-Identifier: BSD-3-Clause
// Measures the live page in Chromium, against the mock server; `tools/test_page --bench` runs it.  Processor time is
// that of the threads, so that other load on the machine does not count.
import {execFileSync} from 'node:child_process';
import {readdirSync, readFileSync} from 'node:fs';

import {faultsOf, launch, open, until} from './browser.js';
import {MockServer} from './mock_server.js';
import * as scenes from './scenes.js';

const SECONDS = Number(process.env.SHOAL_BENCH_S ?? 20);
const SIZE = {
  width: 640,
  height: 480
};
const WIDE = {
  width: 1280,
  height: 720
};
const TICK_S = 1 / Number(execFileSync('getconf', ['CLK_TCK']));

const median = (numbers) => [...numbers].sort((a, b) => a - b)[numbers.length >> 1];
const wait = (seconds) => new Promise((done) => {
  setTimeout(done, 1000 * seconds);
});

/** Fields of /proc/PID/stat after the name; null: no such process. */
function statOf(pid) {
  try {
    return readFileSync(`/proc/${pid}/stat`, 'latin1').replace(/^.*\) /, '').split(' ');
  } catch {
    return null;
  }
}

function commandOf(pid) {
  try {
    return readFileSync(`/proc/${pid}/cmdline`, 'latin1');
  } catch {
    return '';
  }
}

/** Processor time, in s, of the processes of a browser whose command line has a word; '--type=gpu-process' draws. */
function processor_s(browser, word) {
  const ours = new Set([browser.process().pid]);
  let sum_s = 0;
  // Children have larger numbers than their parents here, apart from the rare wrap.
  for (const pid of readdirSync('/proc').filter((name) => /^\d+$/.test(name)).map(Number).sort((a, b) => a - b)) {
    const stat = statOf(pid);
    if (!stat || !ours.has(Number(stat[1]))) continue;
    ours.add(pid);
    if (commandOf(pid).includes(word)) sum_s += (Number(stat[11]) + Number(stat[12])) * TICK_S;
  }
  return sum_s;
}

/** From goto to the first frame with poses, in s of wall and of processor time; the first one in a new browser. */
async function firstFrames(script, count) {
  const times_s = [], processor = [];
  const browser = await launch([]);
  for (let i = 0; i < count; ++i) {
    const server = await new MockServer(script).listen();
    const start_ms = performance.now(), start_s = processor_s(browser, '');
    const page = await open(browser, `${server.url}#t=secret`, SIZE);
    await until(page, (p) => p.placed && p.frames > 0, 'the first frame');
    times_s.push((performance.now() - start_ms) / 1000);
    processor.push(processor_s(browser, '') - start_s);
    await page.close();
    await server.close();
  }
  await browser.close();
  return {times_s, processor};
}

/** Figures of a page that shows a scene for some seconds while it plays. */
async function load(script, prepare, size = SIZE) {
  const browser = await launch([]);
  const server = await new MockServer(script).listen();
  const page = await open(browser, `${server.url}#t=secret`, size);
  const cdp = await page.createCDPSession();
  await cdp.send('Performance.enable', {timeDomain: 'threadTicks'});
  await until(page, (p) => p.placed && p.frames > 0, 'the first frame');
  await page.evaluate(prepare);
  server.paused = false;
  await wait(4);  // shaders are compiled, and so is JavaScript
  const sample = async () => ({
    ...Object.fromEntries((await cdp.send('Performance.getMetrics')).metrics.map(({name, value}) => [name, value])),
    drawing: processor_s(browser, '--type=gpu-process'),
    states: server.received.filter((message) => message.op === 'ack').length,
    now: performance.now() / 1000,
    probe: await page.evaluate(() => window.shoal.probe()),
  });
  const first = await sample();
  await wait(SECONDS);
  const last = await sample();
  const faults = await faultsOf(page);
  await page.close();
  await server.close();
  await browser.close();
  if (faults.length) throw new Error(faults.join('\n'));
  const passed = (name) => last[name] - first[name];
  const frames = last.probe.frames - first.probe.frames;
  return {
    'states/s': passed('states') / passed('now'),
    'frames/s': frames / passed('now'),
    // What the page does for a frame and the states that came since the frame before.
    'script, ms': 1000 * passed('ScriptDuration') / frames,
    'layout, ms': 1000 * (passed('LayoutDuration') + passed('RecalcStyleDuration')) / frames,
    'page, % of a core': 100 * passed('ThreadTime') / passed('now'),
    'clock, ms': last.probe.cpu_ms,
    'drawing, ms': 1000 * passed('drawing') / frames,
    'heap, MB': last.JSHeapUsedSize / 1e6,
    'draw calls': last.probe.draw_calls,
  };
}

const select = () => window.shoal.select('v500');
const rows = {
  '1000 vehicles': await load(scenes.thousand(), () => {}),
  '1000 vehicles, one selected': await load(scenes.thousand(), select),
  [`100 vehicles and the sea, ${WIDE.width} x ${WIDE.height}`]: await load(scenes.fleet(), () => {}, WIDE),
  '1000 bodies of one vehicle': await load(scenes.thousandBodies(), () => {}),
};
for (const [name, script] of [['land', scenes.land()], ['1000 vehicles', scenes.thousand()]]) {
  const {times_s, processor} = await firstFrames(script, 5);
  console.log(`first frame, ${name}: ${times_s[0].toFixed(2)} s in a new browser, then ${
      median(times_s.slice(1)).toFixed(2)} s (median of ${times_s.length - 1}); processor time ${
      processor[0].toFixed(2)} s and ${median(processor.slice(1)).toFixed(2)} s`);
}
const scene = (script) => JSON.stringify(script.scene).length;
console.log(`1000 vehicles: a state is ${32 + 20 * 1000} bytes, the scene ${scene(scenes.thousand())} bytes`);
const columns = Object.keys(Object.values(rows)[0]);
console.log(`of a frame (${SIZE.width} x ${SIZE.height}, ${SECONDS} s):`);
for (const column of columns) {
  const cells = Object.values(rows).map((row) => (row[column] ?? NaN).toFixed(2).padStart(12));
  console.log(`${column.padEnd(20)}${cells.join('')}`);
}
console.log(`columns: ${Object.keys(rows).join('; ')}`);
