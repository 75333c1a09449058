// SPDX-License-Identifier: BSD-3-Clause
// Distances of two logs, the budget of modems, images of sonars in the scene, events of before a page connected.
import assert from 'node:assert/strict';
import {it} from 'node:test';

import {until} from './browser.js';
import * as scenes from './scenes.js';
import {near, rowsOf, show, text, useBrowser, withPage} from './with_page.js';

useBrowser();

it('plots the distance of each vehicle between two logs, with the first difference',
   () => withPage({...scenes.underwater(), hello: {source: 'log', end_us: 5e6}}, async (page, server) => {
     const t_us = [...Array(50).keys()].map((i) => i * 1e5);
     const vehicles = [
       {name: 'auv1', distance_m: t_us.map((t) => Math.max(0, t - 2e6) / 1e6)},
       {name: 'auv2', distance_m: t_us.map(() => null)},
     ];
     server.send({op: 'distances', t_us, vehicles, differs_us: 2e6, left_out: 0});
     const {distances} = await until(page, (p) => p.distances.traces.length === 2);
     assert.equal(distances.differs_s, 2);
     assert.deepEqual(distances.traces[0], {name: 'auv1', count: 50, first_m: 0, last_m: 2.9});
     await show(page, server, 3);
     await page.click('#tab-distances');
     await page.waitForSelector('#dock-distances canvas');
     await page.waitForFunction(() => document.querySelector('#dock-distances output').textContent === '1');
     assert.equal(await text(page, '#dock-distances p'), 'First difference at 2.000 s');
     // A click on the plot goes to its time.
     const box = await page.$eval('#dock-distances .u-over', (over) => {
       const {x, y, width, height} = over.getBoundingClientRect();
       return {x, y, width, height};
     });
     await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
     await until(page, (p) => Math.abs(p.time_us - 2.45e6) < 2e5);
     // Something else than distances is none.
     server.send({op: 'distances', t_us: ['x'], vehicles});
     await until(page, (p) => p.distances.traces.length === 0);
   }, {fragment: '#t=secret&data=water', width: 800, height: 600}));

it('has the budget of the modems', async () => {
  const script = scenes.underwater();
  script.scene.vehicles[0].devices.push(
      {name: 'modem', type: 'acoustic_modem', body: 0, pose: scenes.at(0, 0, 0), channels: [], data_rate_bps: 80});
  await withPage(script, async (page, server) => {
    // In ten seconds two messages of 10 bytes and 1.3 s each, then none for 100 s.
    const items = (count) => [{name: 'auv1/modem', count, bytes: 10 * count, sending_us: 1.3e6 * count}];
    server.send({op: 'modems', time_us: 10e6, items: items(2)});
    await page.waitForFunction(() => document.querySelectorAll('[aria-label="Budget of the modems"] tbody tr').length);
    const table = '[aria-label="Budget of the modems"]';
    assert.deepEqual((await rowsOf(page, table))[0], ['auv1/modem', '26 %', '120.0', '20 %', '80', '2', '20', '2.6']);
    for (let t_s = 20; t_s <= 110; t_s += 10) server.send({op: 'modems', time_us: t_s * 1e6, items: items(2)});
    await page.waitForFunction((selector) => /0\.0 %/.test(document.querySelector(selector).textContent), {}, table);
    assert.deepEqual((await rowsOf(page, table))[0].slice(1, 4), ['0.0 %', '0.0', '0.0 %']);
    // The run went back: the counts begin again.
    server.send({op: 'modems', time_us: 5e6, items: items(1)});
    await page.waitForFunction((selector) => /26 %/.test(document.querySelector(selector).textContent), {}, table);
  }, {fragment: '#t=secret&data=traffic', width: 800, height: 600});
});

it('draws the image of a sonar in the plane of its beams', async () => {
  const script = scenes.underwater(), pose = scenes.at(0.5, 0.2, -0.1, 0.4);
  script.scene.vehicles[0].devices.push(
      {name: 'sonar', type: 'imaging_sonar', body: 0, pose, channels: ['auv1.sonar']});
  await withPage(script, async (page, server) => {
    await page.evaluate(() => window.shoal.select('auv1'));
    await show(page, server, 1);
    const nbins = 30, nbeams = 21, radstep = 0.05, rad0 = -0.5;
    const data = Uint8Array.from({length: nbins * nbeams}, (_, i) => i % 251);
    const fields = {
      utime: 1e6,
      nbins,
      nbeams,
      range_min_m: 1,
      range_max_m: 31,
      rad0,
      radstep,
      floor_dB: 40,
      dB_per_count: 0.5,
      data
    };
    await server.publishOnceWanted('auv1.sonar', 'sonar_image_t', 1e6, fields);
    await until(page, (p) => p.sonars.length === 1);
    const map = await page.evaluate(async (one) => {
      const {fanMap} = await import('/sonar_images.js');
      const {pixel_m, left_m, top_m} = fanMap(one);
      return {pixel_m, left_m, top_m};
    }, {...fields, data: []});
    for (const [bin, beam] of [[10, 0], [20, 10], [29, 20]]) {
      // The middle of this bin, in the frame of the sensor and in the world: the vehicle is at (0, 0, -10), not turned.
      const range = 1 + bin + 0.5, bearing = rad0 + beam * radstep;
      const column = Math.floor((map.left_m - range * Math.sin(bearing)) / map.pixel_m);
      const row = Math.floor((map.top_m - range * Math.cos(bearing)) / map.pixel_m);
      const {at, value_dB, rgba} =
          await page.evaluate((u, v) => window.shoal.sonarPixel('auv1.sonar', u, v), column, row);
      assert.equal(value_dB, 40 + 0.5 * data[bin * nbeams + beam]);
      assert.equal(rgba[3], 255);
      near(at[0], 0.5 + range * Math.cos(0.4 + bearing), map.pixel_m, 'x');
      near(at[1], 0.2 + range * Math.sin(0.4 + bearing), map.pixel_m, 'y');
      near(at[2], -10.1, 1e-5, 'z');
    }
    // Outside of the fan it is transparent; another vehicle has none.
    assert.equal((await page.evaluate(() => window.shoal.sonarPixel('auv1.sonar', 0, 0))).rgba[3], 0);
    await page.evaluate(() => window.shoal.select('auv2'));
    await until(page, (p) => p.sonars.length === 0);
  }, {width: 800, height: 600});
});

it('takes the events of before it connected, once, and says how many were not kept',
   () => withPage(scenes.land(), async (page, server) => {
     const lines = () => page.$$eval('#events li', (all) => all.map((line) => line.textContent));
     const event = (t_s, word) => ({time_us: t_s * 1e6, kind: 'event', who: word, text: 'happened'});
     server.send({op: 'events', items: [event(3, 'third')]});
     server.send({op: 'error', text: 'a problem of this page'});
     await page.waitForFunction(() => document.querySelectorAll('#events li').length === 2);
     const all = [event(1, 'first'), event(2, 'second'), event(3, 'third')];
     server.send({op: 'events', all: true, dropped: 7, items: all});
     await page.waitForFunction(() => document.querySelectorAll('#events li').length === 5);
     const shown = await lines();
     assert.match(shown[0], /third: happened/);
     assert.match(shown[2], /first: happened/);
     assert.match(shown[3], /7 earlier events were not kept/);
     assert.match(shown[4], /a problem of this page/);
     await page.waitForFunction(() => document.querySelectorAll('#marks button').length === 3);
     // Another page connects: the same list comes again.
     server.send({op: 'events', all: true, dropped: 7, items: all});
     server.send({op: 'events', items: [event(4, 'fourth')]});
     await page.waitForFunction(() => /fourth/.test(document.querySelector('#events').textContent));
     assert.equal((await lines()).length, 6);
   }));
