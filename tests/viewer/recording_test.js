// SPDX-License-Identifier: BSD-3-Clause
// The page of `shoal report` with a run inside, opened as a file: no server, no request.
import assert from 'node:assert/strict';
import {mkdtemp, readFile, rm} from 'node:fs/promises';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {after, before, describe, it} from 'node:test';
import {pathToFileURL} from 'node:url';

import {faultsOf, launch, open, until} from './browser.js';
import {shoal} from './program.js';

const DURATION_S = 20;
let browser, folder, output;

/** Opens the page; counts every request but that of the file itself. */
async function withPage(test) {
  const page = await open(browser, 'about:blank');
  const url = pathToFileURL(join(folder, 'run.html')).href, requests = [];
  page.on('request', (request) => {
    if (!/^(blob|data):/.test(request.url())) requests.push(request.url().replace(/#.*/, ''));
  });
  try {
    await page.goto(url);
    await until(page, (p) => p.scene !== null && p.frames > 0, 'the first frame');
    await test(page);
    assert.deepEqual(await faultsOf(page), []);
    assert.deepEqual(requests, [url]);
  } finally {
    await page.close();
  }
}

const seek = (page, t_s) => page.$eval('#seek', (line, ms) => {
  line.value = ms;
  line.dispatchEvent(new Event('input'));
  line.dispatchEvent(new Event('change'));
}, 1000 * t_s);

const pause = async (page) => {
  await page.focus('#view');
  await page.keyboard.press(' ');
  await page.waitForFunction(() => document.getElementById('play').getAttribute('aria-label') === 'Continue');
};

before(async () => {
  folder = await mkdtemp(join(tmpdir(), 'recording-'));
  await shoal(
      'run', 'worlds/dynamic_warehouse.yaml', '--bus', 'none', '--duration', String(DURATION_S), '--quiet', '--results',
      folder, '--record', join(folder, 'run.lcm'));
  output = await shoal('report', folder);
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await rm(folder, {recursive: true});
});

describe('recording', () => {
  it('is beside the report, which links to it', async () => {
    assert.match(output, /run\.html: the run in 3-D, [\d.]+ MB, 0 to 20 s, \d+ states/);
    assert.match(await readFile(join(folder, 'report.html'), 'utf8'), /<a href="run\.html">/);
    assert.ok((await readFile(join(folder, 'run.html'))).length < 20e6);
  });

  it('plays by itself, and bodies move', async () => {
    await withPage(async (page) => {
      const first = await until(page, (p) => p.time_us > 0.2e6);
      const later = await until(page, `(p) => p.time_us > ${first.time_us + 2e6}`);
      const moved = later.bodies.filter(
          (body, i) => Math.hypot(...body.position.map((x, k) => x - first.bodies[i].position[k])) > 0.05);
      assert.ok(moved.length > 0, 'no body moved');
      assert.equal(later.banner, '');
    });
  });

  it('seeks while it is paused, to the poses of the run', async () => {
    await withPage(async (page) => {
      await pause(page);
      const tracks = (await readFile(join(folder, 'tracks.csv'), 'utf8'))
                         .trim()
                         .split('\n')
                         .slice(1)
                         .map((line) => line.split(','));
      for (const t_s of [15, 3.5, 10]) {
        await seek(page, t_s);
        const probe = await until(page, `(p) => Math.abs(p.time_us - ${t_s * 1e6}) < 1e3`, `${t_s} s`);
        for (const vehicle of probe.vehicles) {
          const row = tracks.find(([time_s, name]) => name === vehicle.name && Math.abs(Number(time_s) - t_s) < 1e-6);
          assert.ok(row, `${vehicle.name} at ${t_s} s`);
          for (const k of [0, 1, 2])
            assert.ok(
                Math.abs(vehicle.position[k] - Number(row[2 + k])) < 0.02,
                `${vehicle.name} at ${t_s} s: ${vehicle.position}, expected ${row}`);
        }
      }
    });
  });

  it('has all cameras, and plays to the end', async () => {
    await withPage(async (page) => {
      const name = (await page.evaluate(() => window.shoal.probe())).vehicles[0].name;
      await page.evaluate((one) => window.shoal.select(one), name);
      for (const mode of ['top', 'follow', 'chase', 'first', 'fly', 'orbit']) {
        await page.select('#camera', mode);
        await until(page, `(p) => p.camera.mode === '${mode}'`);
      }
      await seek(page, DURATION_S - 0.5);
      await until(page, `(p) => p.time_us === ${DURATION_S * 1e6}`, 'the end');
      await page.waitForFunction(() => document.getElementById('play').getAttribute('aria-label') === 'Continue');
    });
  });
});
