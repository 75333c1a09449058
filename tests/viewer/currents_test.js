// SPDX-License-Identifier: BSD-3-Clause
// Currents and tides on the page.
import assert from 'node:assert/strict';
import {it} from 'node:test';

import {until} from './browser.js';
import {at, underwater} from './scenes.js';
import {near, rowsOf, show, useBrowser, withPage} from './with_page.js';

useBrowser();

const TIDE = {
  amplitude_m: 2,
  period_s: 400,
  phase_rad: 0,
  current_mps: 0.3,
  current_direction_rad: 0,
  current_lead_rad: Math.PI / 2
};

/** The scene under water with a tide and currents. */
function moving(currents, tides = []) {
  const script = underwater();
  Object.assign(script.scene.water, {currents, tides, mean_level_m: 0});
  return script;
}

const VORTEX = {
  type: 'vortex',
  center_m: [0, 0],
  peak_speed_mps: 0.5,
  core_radius_m: 10,
  core: 'rankine'
};

async function choose(page, which, depth_m = 1) {
  await page.evaluate((value, depth) => {
    const set = (id, to) => {
      document.getElementById(id).value = to;
      document.getElementById(id).dispatchEvent(new Event('input'));
    };
    set('o-current-depth', depth);
    set('o-currents', value);
  }, which, depth_m);
}

it('draws currents on a grid at a depth',
   () => withPage(moving([VORTEX]), async (page) => {
     assert.equal((await until(page, (p) => p.frames > 0)).currents.length, 0);  // off by default
     await choose(page, 'grid', 7);
     const {currents} = await until(page, (p) => p.currents.length === 121);
     for (const {position: [x, y, z], velocity_mps: [east, north, up]} of currents) {
       assert.equal(z, -7);
       // Rankine: rigid rotation in the core, then falling with the distance.
       const r = Math.hypot(x, y), speed = r === 0 ? 0 : 0.5 * Math.min(r / 10, 10 / r);
       near(east, r === 0 ? 0 : -speed * y / r, 1e-9, 'east');
       near(north, r === 0 ? 0 : speed * x / r, 1e-9, 'north');
       assert.equal(up, 0);
     }
   }));

it('draws the current at each vehicle that is in the water',
   () => withPage(moving([{type: 'profile', rows: [[0, 0.4, 0, 0], [100, 0, 0.4, 0]]}]), async (page) => {
     await choose(page, 'vehicles');
     const {currents, vehicles} = await until(page, (p) => p.currents.length > 0);
     const wet = vehicles.filter((vehicle) => vehicle.position[2] <= 0);
     assert.equal(currents.length, wet.length);
     wet.forEach(({position}, i) => {
       near(currents[i].velocity_mps[0], 0.4 * (1 + position[2] / 100), 1e-6, 'east');
       near(currents[i].velocity_mps[1], -0.4 * position[2] / 100, 1e-6, 'north');
     });
   }));

it('raises and lowers the water with the tide',
   () => withPage(moving([], [TIDE]), async (page, server) => {
     near((await show(page, server, 0)).level_m, 2, 2e-3, 'high water');
     near((await show(page, server, 100)).level_m, 0, 2e-3, 'mean water');
     near((await show(page, server, 200)).level_m, -2, 2e-3, 'low water');
     // The tidal current leads by a quarter of the period: falling water.
     await choose(page, 'grid');
     const {currents} = await until(page, (p) => p.currents.length > 0);
     near(currents[0].velocity_mps[0], 0, 1e-9, 'slack at low water');
     near((await show(page, server, 300)).currents[0].velocity_mps[0], 0.3, 1e-9, 'peak');
   }));

it('takes the random part of a current from the run, and its mean before',
   () => withPage(moving([{type: 'gauss_markov', speed_mps: 0.3, direction_rad: 0}, VORTEX]), async (page, server) => {
     await show(page, server, 5);
     const at_far = () => page.evaluate((t) => window.shoal.currentAt([1e9, 0, -3], t), 5e6);
     near((await at_far())[0], 0.3, 1e-6, 'mean');
     await page.click('#data');
     await page.click('#tab-water');
     await page.waitForFunction(() => document.querySelectorAll('#dock-water tbody tr').length === 3);
     assert.match((await rowsOf(page, '#dock-water'))[0][3], /^≈ /);
     server.send({op: 'current', time_us: 5e6, velocity_mps: [0.1, 0.2, 0.01]});
     await page.waitForFunction(() => window.shoal.currentAt([1e9, 0, -3], 5e6)[2] === 0.01);
     near((await at_far())[0], 0.1, 1e-6, 'east');
     // The vehicle is at the center of the vortex.
     await page.waitForFunction(() => document.querySelector('#dock-water tbody tr').cells[3].textContent === '0.224');
     assert.equal((await rowsOf(page, '#dock-water'))[0][4], '63');
     // Another time has another random part.
     near((await page.evaluate(() => window.shoal.currentAt([1e9, 0, -3], 20e6)))[0], 0.3, 1e-6, 'mean');
   }));

it('leaves out entries that it does not know or that lack numbers',
   () => withPage(
       moving([{type: 'whirl'}, {type: 'vortex', center_m: [0, 0]}, {type: 'grid', columns: 2, rows: 2}, null]),
       async (page) => {
         await choose(page, 'grid');
         assert.deepEqual(await page.evaluate(() => window.shoal.currentAt([1, 2, -3], 0)), [0, 0, 0]);
       }));
