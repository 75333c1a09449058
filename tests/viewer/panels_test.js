// SPDX-License-Identifier: BSD-3-Clause
// Panels of clocks, traffic and water; moments of scores and events; images, films, and who can reach all of it.
import assert from 'node:assert/strict';
import {readFile} from 'node:fs/promises';
import {describe, it} from 'node:test';

import {until} from './browser.js';
import * as scenes from './scenes.js';
import {near, rowsOf, show, text, useBrowser, withPage} from './with_page.js';

useBrowser();

const SIZE = {
  width: 1000,
  height: 600
};

describe('data', () => {
  it('has clocks, traffic, who received whom, and the water', async () => {
    const script = scenes.underwater();
    script.scene.zones.push({name: 'cave', polygon_m: [[0, 0], [9, 0], [9, 9]], z_m: [null, 0], flags: ['gps_denied']});
    await withPage(script, async (page, server) => {
      await show(page, server, 2);
      const channels = (t_s) => [
          ['auv1.clock', 'shoal.clock_status_t', 'auv1', t_s, 50 * t_s],
          ['auv1.clock.truth', 'shoal.clock_status_t', 'auv1', t_s, 50 * t_s],
          ['auv2.clock', 'shoal.clock_status_t', 'auv2', 10 * t_s, 500 * t_s],
          ['sim.state', 'shoal.sim_state_t', '', 20 * t_s, 40000 * t_s]];
      server.sendChannels(2e6, channels(2));
      // Clocks: with the truth, and by the estimate of the clock itself.
      const status = {disciplined: true, since_fix_s: 0.5, estimated_std_s: 1e-4, error_s: 0.002, rate_error: 3e-6};
      await server.publishOnceWanted('auv1.clock.truth', 'clock_status_t', 2e6, status);
      await server.publishOnceWanted(
          'auv2.clock', 'clock_status_t', 2e6,
          {...status, disciplined: false, since_fix_s: -1, error_s: NaN, rate_error: NaN, estimated_std_s: 0.01});
      await page.waitForFunction(() => /no/.test(document.querySelector('#dock-clocks tbody').textContent));
      const clocks = await rowsOf(page, '#dock-clocks');
      // Sound speed 1498.75 m/s at 10 m.
      assert.deepEqual(clocks[0], ['auv1.clock', '2', '3', '✓ yes', '0.5', '0.1', '2.998']);
      assert.deepEqual(clocks[1].slice(0, 6), ['auv2.clock', '–', '–', '✕ no', '–', '10']);
      assert.match(clocks[1][6], /^± 14\.98$/);
      // Traffic: rates by simulated time, sums by vehicle.
      server.sendChannels(4e6, channels(4));
      await page.click('#tab-traffic');
      await page.waitForFunction(() => /1\.0/.test(document.querySelector('#dock-traffic tbody').textContent));
      const rows = await rowsOf(page, '#dock-traffic section:first-child table');
      assert.deepEqual(rows[0], ['auv1', '2.0', '100 B/s', '8', '400 B']);
      assert.deepEqual(rows[3], ['auv2', '10', '500 B/s', '40', '2.0 kB']);
      assert.deepEqual(rows[6], ['sim.state', '20', '40.0 kB/s', '80', '160.0 kB']);
      server.sendPairs(
          [
            {from: 'auv1', to: 'auv2', sent: 10, received: 7, lost: {noise: 1, interference: 2}},
            {from: 'auv2', to: 'auv1', sent: 4, received: 4, lost: {}}
          ],
          4e6);
      await page.waitForFunction(() => document.querySelectorAll('.matrix tr').length === 3);
      assert.equal(await text(page, '.matrix tr:nth-child(2) td:nth-child(3)'), '7/10 ✕');
      assert.equal(await text(page, '.matrix tr:nth-child(3) td:nth-child(2)'), '4/4');
      assert.match(await text(page, '.losses'), /auv1 → auv2: ✕ collision 2, ≈ lost in noise 1/);
      // Water.
      await page.click('#tab-water');
      await page.waitForFunction(() => document.querySelectorAll('#dock-water tbody tr').length === 3);
      const [first] = await rowsOf(page, '#dock-water');
      assert.deepEqual(first, ['auv1', '10.00', '1498.8', '0.000', '–']);
      assert.match(await text(page, '#dock-water ul'), /No GPS in: cave/);
    }, {...SIZE, fragment: '#t=secret&data=clocks'});
  });

  it('says which clocks no device reports, and how one would', async () => {
    const script = scenes.underwater();
    for (const [i, one] of script.scene.vehicles.entries()) one.own_clock = i < 2;
    await withPage(script, async (page, server) => {
      await page.waitForFunction(() => /own clocks/.test(document.getElementById('dock-clocks').textContent));
      const shown = () => page.$$eval(
          '#dock-clocks p', (all) => all.filter((one) => one.checkVisibility()).map((one) => one.textContent));
      assert.deepEqual(await shown(), [
        '2 vehicles have their own clocks without a device that reports it (auv1, auv2); add {name: clock, type: clock, ' +
        'truth: true} to \'devices\' of the vehicle to see it here.'
      ]);
      server.sendChannels(2e6, [['auv1.clock', 'shoal.clock_status_t', 'auv1', 1, 50]]);
      await page.waitForFunction(
          () => /^1 vehicle has its own clock .*\(auv2\)/.test(
              document.querySelector('#dock-clocks p:not([hidden])').textContent));
      for (const one of script.scene.vehicles) one.own_clock = false;
      server.sendChannels(2e6, []);
      server.send({...script.scene, revision: 2});
      await page.waitForFunction(
          () => /^No vehicle .* own clock/.test(document.querySelector('#dock-clocks p:not([hidden])').textContent));
    }, {...SIZE, fragment: '#t=secret&data=clocks'});
  });

  it('of another run replaces that of the run before', async () => {
    await withPage(scenes.land(), async (page, server) => {
      server.sendChannels(1e6, [['rover1.lidar', 'shoal.planar_lidar_t', 'rover1', 5, 100]]);
      await page.waitForFunction(() => /lidar/.test(document.querySelector('#dock-traffic').textContent));
      server.script = scenes.surface();
      server.send(server.script.scene);
      await page.waitForFunction(() => !/lidar/.test(document.querySelector('#dock-traffic').textContent));
    }, {...SIZE, fragment: '#t=secret&data=traffic'});
  });
});

describe('moments', () => {
  it('at which rules failed and events happened are a click away', async () => {
    const script = {...scenes.land(), hello: {source: 'log', end_us: 60e6, name: 'a.lcm'}};
    await withPage(script, async (page, server) => {
      const scores = (t_s, holds, max_m) => server.send({
        op: 'scores',
        time_us: t_s * 1e6,
        rules: [{rule: 'contacts == 0', holds, value: holds ? 0 : 1, bound: 0}],
        metrics: [{name: 'error', figures: {max_m, rms_m: 1}}]
      });
      scores(5, true, 1);
      scores(12, false, 2);
      scores(20, false, 2);
      server.send({op: 'events', items: [{time_us: 33e6, kind: 'fault', who: 'rover1/lidar', text: 'silent'}]});
      await page.click('#tab-scores');
      await page.click('#rules .moment');
      await until(page, (p) => p.time_us === 12e6, 'the time at which the rule failed');
      assert.equal((await page.$$('#metrics .moment')).length, 1);
      await page.click('#tab-events');
      await page.focus('#events');
      await page.keyboard.press('ArrowDown');
      await page.keyboard.press('Enter');
      await until(page, (p) => p.time_us === 33e6, 'the time of the event');
    }, SIZE);
  });
});

describe('rules', () => {
  it('are gray as long as they are not decided, and decided at the end', async () => {
    await withPage(scenes.land(), async (page, server) => {
      const rules = [
        ['distance.travelled_m > 2000', false, 323.9, 2000, '…'],
        ['link.lost_noise >= 10 * 2', false, 3, 20, '…'],
        ['100 < link.received', false, 100, 24, '…'],
        ['bumps.count == 3', false, 1, 3, '…'],
        ['early.rms_m < 4', false, null, 4, '…'],
        // More time cannot help, may or may not, or is not needed.
        ['bumps.count == 0', false, 1, 0, '✕'],
        ['gap.max_gap_s < 10', false, 12, 10, '✕'],
        ['error.rms_m < 4', false, 5, 4, '✕'],
        ['link.received > 0.2 * error.samples', false, 5, 9, '✕'],
        ['error.max_m < 4', true, 3, 4, '✓'],
      ];
      const send = (time_us) => server.send(
          {op: 'scores', time_us, rules: rules.map(([rule, holds, value, bound]) => ({rule, holds, value, bound}))});
      const signs = () => page.$$eval('#rules li', (lines) => lines.map((line) => line.firstChild.textContent));
      send(215e6);
      await page.click('#tab-scores');
      await page.waitForFunction(() => document.querySelectorAll('#rules li').length === 10);
      assert.deepEqual(await signs(), rules.map((rule) => rule[4]));
      server.ended = 'duration';
      await page.waitForFunction(() => !/…/.test(document.getElementById('rules').textContent));
      assert.deepEqual(await signs(), rules.map((rule) => rule[4].replace('…', '✕')));
    }, SIZE);
  });

  it('that may be undecided name figures that there are', async () => {
    const metrics = await readFile(new URL('../../docs/reference/metrics.md', import.meta.url), 'utf8');
    const source = await readFile(new URL('../../viewer/page/panels.js', import.meta.url), 'utf8');
    const growing = /GROWING = new Set\(\[([^\]]*)\]/.exec(source)[1].match(/\w+/g);
    const rows = [...metrics.matchAll(/^\| `(\w+)` \| (\S+) \|/gm)].map(([, name, unit]) => ({name, unit}));
    assert.deepEqual(growing.filter((name) => !rows.some((row) => row.name === name)), []);
    // Each count is one of them.
    const counts = rows.filter(({unit}) => !/^(m|s|deg|ratio|%|bytes\/m|cells|-)$/.test(unit)).map(({name}) => name);
    assert.deepEqual(counts.filter((name) => !growing.includes(name.replace(/^lost_.*/, 'lost'))), []);
  });
});

describe('stability', () => {
  it('has a bar for each margin, in red outside of the support', async () => {
    await withPage(scenes.land(), async (page, server) => {
      const figures = (static_m, zmp_m, capture_m) => server.send({
        op: 'scores',
        time_us: 1e6,
        metrics: [
          {name: 'error', figures: {rms_m: 1}},
          {name: 'support', figures: {static_min_m: 0, static_m, zmp_m, capture_m}},
        ]
      });
      const bars = () => page.$$eval(
          '#stability .margin',
          (lines) => lines.map(
              (line) =>
                  [line.lastChild.textContent, line.querySelector('i').style.width,
                   line.classList.contains('outside')]));
      figures(0.04, 0.02, -0.01);
      await page.click('#tab-scores');
      await page.waitForSelector('#stability .margin');
      // A whole bar is 50 mm.
      assert.deepEqual(await bars(), [['40 mm', '80%', false], ['20 mm', '40%', false], ['-10 mm', '20%', true]]);
      assert.equal(await text(page, '#stability h3'), 'support');
      figures(0.1, null, 0.025);
      await page.waitForFunction(() => /100 mm/.test(document.querySelector('#stability').textContent));
      assert.deepEqual(await bars(), [['100 mm', '100%', false], ['no support', '0%', true], ['25 mm', '25%', false]]);
    }, SIZE);
  });
});

describe('files', () => {
  it('of what is drawn are an image and a film', async () => {
    await withPage(scenes.land(), async (page, server) => {
      await show(page, server, 1);
      await page.click('#show');
      await page.click('#save-image');
      const image = await until(page, (p) => p.saved?.type === 'image/png' && p.saved.bytes > 1000);
      assert.equal(image.saved.name, 'test_land_1.00s.png');
      await page.click('#record');
      server.paused = false;
      await until(page, (p) => p.time_us > 2.5e6, 'some frames');
      await page.click('#stop');
      const film = await until(page, (p) => p.saved?.type === 'video/webm' && p.saved.bytes > 500);
      assert.match(film.saved.name, /^test_land_1\.00s\.webm$/);
    }, {width: 400, height: 320});
  });
});

describe('reach', () => {
  it('of all controls of the data by Tab, without motion for those who want none', async () => {
    await withPage(scenes.underwater(), async (page, server) => {
      server.sendChannels(0, [['auv1.pose', 'shoal.pose_t', 'auv1'], ['auv1.cam', 'shoal.image_t', 'auv1']]);
      for (const tab of ['plots', 'images', 'traffic']) {
        await page.click(`#tab-${tab}`);
        const missed = await page.evaluate(
            () => [...document.querySelectorAll('#dock button, #dock input, #dock select')]
                      .filter((one) => !one.disabled && one.checkVisibility())
                      .filter((one) => {
                        one.focus();
                        const name = one.getAttribute('aria-label') || one.textContent.trim() || one.title;
                        return document.activeElement !== one || one.tabIndex !== 0 || !name;
                      })
                      .map((one) => one.outerHTML));
        assert.deepEqual(missed, []);
      }
      await page.emulateMediaFeatures([{name: 'prefers-reduced-motion', value: 'reduce'}]);
      server.send({op: 'error', text: 'a note'});
      await page.waitForSelector('#toasts div');
      assert.equal(await page.evaluate(() => document.getAnimations().length), 0);
    }, {...SIZE, fragment: '#t=secret&data=plots&plots=auv1.pose/pos[0]&panels=left,events'});
  });

  it('of the data on a phone, without sideways scrolling', async () => {
    await withPage(scenes.underwater(), async (page, server) => {
      server.sendChannels(
          0, [['auv1.a_channel_with_a_very_long_name_of_its_own.truth', 'shoal.clock_status_t', 'auv1']]);
      server.sendPairs([{from: 'auv1', to: 'auv2', sent: 1, received: 0, lost: {noise: 1}}]);
      await page.click('#data');
      for (const tab of ['plots', 'images', 'clocks', 'traffic', 'water']) {
        await (await page.waitForSelector(`#tab-${tab}`, {visible: true})).click();
        await show(page, server, 1);
        const out = await page.evaluate(() => {
          // What scrolls within its own box may be wider.
          const inside = (one) => !one.parentElement.closest('.columns > section, #dock-tabs, #dock-clocks');
          return [...document.querySelectorAll('body *')]
              .filter((one) => one.checkVisibility() && inside(one))
              .filter((one) => {
                const box = one.getBoundingClientRect();
                return one.id !== 'skip' && (box.right > innerWidth + 1 || box.left < -1);
              })
              .map((one) => one.id || one.className || one.tagName);
        });
        assert.deepEqual(out, [], tab);
      }
      assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
      near((await page.$eval('#dock', (dock) => dock.getBoundingClientRect().width)), 378, 1, 'width of the panel');
    }, {width: 390, height: 844});
  });
});
