// SPDX-License-Identifier: BSD-3-Clause
// Laws that the page must keep, against the simulator: waves against `shoal medium`, sound against its recorded
// arrivals.
import assert from 'node:assert/strict';
import {mkdtemp, rm} from 'node:fs/promises';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {after, before, it} from 'node:test';
import {pathToFileURL} from 'node:url';

import {faultsOf, launch, open, until} from './browser.js';
import {serve, shoal} from './program.js';

let browser, folder;
before(async () => {
  browser = await launch();
  folder = await mkdtemp(join(tmpdir(), 'laws-'));
});
after(async () => {
  await browser?.close();
  await rm(folder, {recursive: true});
});

/** Rows of a channel of a log: objects by the names of the columns. */
async function rowsOf(log, channel) {
  const [head, ...lines] =
      (await shoal('log', 'csv', log, channel)).trim().split('\n').map((line) => line.replaceAll('"', '').split(','));
  return lines.map((line) => Object.fromEntries(head.map((name, i) => [name, line[i]])));
}

it('has the water surface of shoal medium within 1 cm at 100 points', async () => {
  const world = 'worlds/otter_sea.yaml';
  const server = await serve('run', world, '--view', '--view-port', '0', '--bus', 'none', '--paused', '--quiet');
  const page = await open(browser, server.url, {width: 320, height: 240});
  try {
    await until(page, (p) => p.scene !== null && p.frames > 0);
    const level_m = await page.evaluate(() => window.shoal.waterLevel());
    const points =
        [...Array(100).keys()].map((i) => [+(7.3 * i - 350).toFixed(3), +(250 * Math.sin(1.7 * i)).toFixed(3)]);
    const at_s = (i) => [0, 12.3, 3600][i % 3];
    const heights = await page.evaluate(
        (all, times) => all.map((point, i) => window.shoal.waterHeights([point], times[i] * 1e6)[0]), points,
        points.map((_, i) => at_s(i)));
    for (let i = 0; i < points.length; ++i) {
      const output = await shoal('medium', world, `--at=${points[i].join()},-5`, '--time', String(at_s(i)));
      const expected_m = Number(/^surface\s+(\S+) m$/m.exec(output)[1]);
      assert.ok(
          Math.abs(level_m + heights[i] - expected_m) < 0.01,
          `at ${points[i]}, ${at_s(i)} s: ${level_m + heights[i]}, expected ${expected_m}`);
    }
    assert.deepEqual(await faultsOf(page), []);
  } finally {
    await page.close();
    await server.end();
  }
});

it('has a ping at each receiver when it arrives there, within 0.5 %', async () => {
  const log = join(folder, 'run.lcm');
  // Exit code 1: the rules of the world need a longer run.
  await shoal(
      'run', 'worlds/coop_underwater.yaml', '--launch', '--duration', '40', '--quiet', '--results', folder, '--record',
      log)
      .catch((error) => assert.equal(error.code, 1, error.message));
  await shoal('report', folder);
  const sounds = await rowsOf(log, 'sim.sound'), arrivals = await rowsOf(log, 'sim.sound.arrival');
  const page = await open(browser, pathToFileURL(join(folder, 'run.html')).href, {width: 320, height: 240});
  try {
    const {epoch_us} = await until(page, (p) => p.scene !== null && p.frames > 0);
    await page.focus('#view');
    await page.keyboard.press(' ');
    let checked = 0;
    for (const arrival of arrivals.filter((one) => Number(one.travel_time_s) > 0.02)) {
      const sound = sounds.find((one) => one.source === arrival.source && one.sequence === arrival.sequence);
      const id = `${sound.source}#${sound.sequence}`;
      const time_us = Math.round(Number(sound.utime) - epoch_us + 1e6 * Number(arrival.travel_time_s));
      if (time_us > 39e6) continue;
      await page.evaluate((t_us) => window.shoal.seek(t_us), time_us);
      const probe =
          await until(page, `(p) => Math.abs(p.time_us - ${time_us}) < 2 && p.sounds.some((s) => s.id === '${id}')`);
      const place = (row) => [0, 1, 2].map((k) => Number(row[`position_m[${k}]`] ?? row[`position_m_${k}`]));
      const a = place(sound), b = place(arrival), distance_m = Math.hypot(...a.map((x, k) => x - b[k]));
      const {outer_m} = probe.sounds.find((one) => one.id === id);
      assert.ok(Math.abs(outer_m - distance_m) < 0.005 * distance_m, `${id}: ${outer_m} m, expected ${distance_m} m`);
      if (++checked >= 12) break;
    }
    assert.ok(checked >= 3, `${checked} arrivals`);
    assert.deepEqual(await faultsOf(page), []);
  } finally {
    await page.close();
  }
});
