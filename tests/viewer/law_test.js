// SPDX-License-Identifier: BSD-3-Clause
// Laws that the page must keep, against the simulator: waves against `shoal medium`, sound against its recorded
// arrivals.
import assert from 'node:assert/strict';
import {mkdtemp, rm, writeFile} from 'node:fs/promises';
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

/** A world with every kind of current that is not random, and tides. */
const CURRENTS = `shoal: 1
name: currents
medium:
  water: {surface_m: 2}
  current:
    - {velocity_mps: [0.2, -0.1, 0.01]}
    - {type: profile, profile: [{depth_m: 0, velocity_mps: [0.3, 0, 0]}, {depth_m: 10, velocity_mps: [0, 0.2, 0.02]},
       {depth_m: 30, velocity_mps: [-0.1, 0, 0]}]}
    - {type: power_law, speed_mps: 0.5, direction_deg: 120, water_depth_m: 40}
    - {type: wind_driven, speed_mps: 0.4, direction_deg: -30, reference_depth_m: 20}
    - {type: vortex, center_m: [40, 30], peak_speed_mps: 0.3, core_radius_m: 10}
    - {type: vortex, center_m: [-60, 0], peak_speed_mps: -0.6, core_radius_m: 25, core: rankine}
    - {type: grid, file: grid.csv}
  tides:
    - {amplitude_m: 1.5, period_s: 600, phase_deg: 40, current_mps: 0.4, current_direction_deg: 70, current_lead_deg: 80}
    - {amplitude_m: 0.3, period_s: 170}
objects: [{name: bottom, fixed: true, position_m: [0, 0, -60], parts: [{shape: plane}]}]
`;

it('has the currents and the tide of shoal medium at 60 points', async () => {
  const world = join(folder, 'currents.yaml');
  await writeFile(world, CURRENTS);
  await writeFile(
      join(folder, 'grid.csv'),
      'x_m,y_m,east_mps,north_mps\n-20,-20,0.1,0.2\n20,-20,0.3,-0.4\n-20,40,0.5,0.6\n20,40,-0.7,0.8\n');
  const server = await serve('run', world, '--view', '--view-port', '0', '--bus', 'none', '--paused', '--quiet');
  const page = await open(browser, server.url, {width: 320, height: 240});
  try {
    await until(page, (p) => p.scene !== null && p.frames > 0);
    for (let i = 0; i < 60; ++i) {
      const point = [+(100 * Math.sin(2.3 * i)).toFixed(3), +(80 * Math.cos(1.1 * i)).toFixed(3), -0.9 * i - 1];
      const time_s = [0, 57.5, 400, 1234.5][i % 4];
      const [velocity, tide_m] = await page.evaluate(
          (p, t_us) => [window.shoal.currentAt(p, t_us), window.shoal.tideAt(t_us)], point, time_s * 1e6);
      const output = await shoal('medium', world, `--at=${point.join()}`, '--time', String(time_s));
      const expected = /^water velocity\s+(\S+) (\S+) (\S+) m/m.exec(output).slice(1).map(Number);
      const surface_m = Number(/^surface\s+(\S+) m$/m.exec(output)[1]);
      for (let k = 0; k < 3; ++k)
        assert.ok(Math.abs(velocity[k] - expected[k]) < 6e-4, `at ${point}, ${time_s} s: ${velocity}, not ${expected}`);
      assert.ok(Math.abs(2 + tide_m - surface_m) < 6e-4, `at ${time_s} s: ${2 + tide_m}, not ${surface_m}`);
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
