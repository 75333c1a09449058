// SPDX-License-Identifier: BSD-3-Clause
// Two branches, or two logs, side by side on the live page in Chromium against the mock server.
import assert from 'node:assert/strict';
import {describe, it} from 'node:test';

import {until} from './browser.js';
import * as scenes from './scenes.js';
import {near, show, text, useBrowser, withPage} from './with_page.js';

useBrowser();

/** Two logs: in the second one rover1 is 1 m higher, and the second body is missing. */
function twoLogs() {
  const script = {...scenes.land(), hello: {source: 'log', end_us: 60e6, name: 'a.lcm'}};
  script.branches = {
    1: (t_s) => script.posesAt(t_s).map(
        (pose, i) =>
            (i === 0     ? pose.with(2, pose[2] + 1) :
                 i === 1 ? pose.with(0, NaN) :
                           pose)),
  };
  return script;
}

const LIST = {
  op: 'branches',
  present: 0,
  by: 'sim.hash',
  items: [
    {branch: 0, parent: null, name: 'a.lcm', start_us: 0, end_us: 60e6, differs_us: null},
    {branch: 1, parent: null, name: '<i>b.lcm', start_us: 0, end_us: 60e6, differs_us: 2e6, differs_step: 200}
  ]
};

/** Opens both logs and shows them side by side. */
async function besides(page, server) {
  await show(page, server, 7);
  server.send(LIST);
  await until(page, (p) => p.ghosts.length > 0, 'ghosts of the second log');
  await page.focus('#view');
  await page.keyboard.press('b');
  await until(page, (p) => p.sides?.others.length > 0, 'two parts');
  await page.keyboard.press('Home');
  const inside = (p) => p.sides.others.every(({pixel: at}) => {
    const {x, y, width, height} = p.sides.regions[1].clip;
    return at && at[0] > x && at[0] < x + width && at[1] > y && at[1] < y + height;
  });
  return until(page, inside, 'all in view');
}

describe('side by side', () => {
  it('shows each log in its half, with the same camera and its name', async () => {
    await withPage(twoLogs(), async (page, server) => {
      const probe = await besides(page, server);
      assert.deepEqual(probe.sides.names, ['a.lcm', '<i>b.lcm']);
      const [left, right] = probe.sides.regions;
      // Between the list and the details, whose widths are 220 and 300 px, 10 px from the edges.
      const split = (230 + (1280 - 310)) / 2;
      assert.deepEqual([left.clip.width, right.clip.x], [split, split]);
      assert.deepEqual([left.width, left.height], [right.width, right.height]);
      const here = probe.vehicles.find((one) => one.name === 'rover1');
      const there = probe.sides.others.find((one) => one.name === 'rover1');
      near(there.position[2] - here.position[2], 1, 1e-3, 'height in the second log');
      near(there.position[0], here.position[0], 1e-3, 'x in the second log');
      // The same camera: 1 m higher, so above, in the other half.
      assert.ok(here.pixel[0] < split && there.pixel[0] > split, `${here.pixel} ${there.pixel}`);
      assert.ok(there.pixel[1] < here.pixel[1] - 2, 'higher on the page');
      near(there.pixel[0] - right.x, here.pixel[0] - left.x, 0.08 * left.width, 'x in its half');
      // What is picked in a half is what it shows.
      await page.mouse.click(...there.pixel);
      await until(page, (p) => p.selected === 'rover1');
      // One that the second log lacks stands in the first one only.
      assert.equal(probe.sides.others.length, probe.vehicles.length - 1);
    }, {width: 1280, height: 800});
  });

  it('stands one above the other on a phone', async () => {
    await withPage(twoLogs(), async (page, server) => {
      const probe = await besides(page, server);
      const [upper, lower] = probe.sides.regions;
      assert.deepEqual([upper.clip.width, upper.clip.height], [390, lower.clip.y]);
      const there = probe.sides.others.find((one) => one.name === 'rover1');
      assert.ok(there.pixel[1] > lower.clip.y, `${there.pixel}`);
      // An open sheet leaves both in view above it.
      await page.click('#tab-scores');
      const sheet = await page.$eval('#sheets', (sheets) => sheets.getBoundingClientRect().top);
      await page.focus('#view');
      await page.keyboard.press('Home');
      await until(page, `(p) => p.vehicles.concat(p.sides.others).every(({pixel}) => pixel && pixel[1] < ${sheet})`);
    }, {width: 390, height: 844});
  });

  it('hides no vehicle behind a panel', async () => {
    await withPage(twoLogs(), async (page, server) => {
      await besides(page, server);
      await page.evaluate(() => window.shoal.select('rover1'));
      await page.focus('#view');
      for (const key of ['f', 'c', 'Home']) {
        await page.keyboard.press(key);
        const seen = `(p) => [p.vehicles[0], p.sides.others.find(({name}) => name === 'rover1')].every(({pixel}) =>
            pixel && document.elementFromPoint(...pixel)?.id === 'view')`;
        await until(page, seen, `both in view after ${key}`);
      }
      // With another size of what is free the views have other sizes.
      const before = await until(page, (p) => p);
      await page.click('#fold-right');
      await until(page, `(p) => p.sides.regions[1].clip.x > ${before.sides.regions[1].clip.x} + 100`);
    }, {width: 1000, height: 600});
  });

  it('has the estimates of both logs, each against its own truth', async () => {
    await withPage(twoLogs(), async (page, server) => {
      await besides(page, server);
      const [x, y, z] = server.script.posesAt(7)[0];
      const estimate = (dz) => ({vehicle: 'rover1', time_us: 7e6, pose: [x, y, z + dz, 1, 0, 0, 0]});
      server.send({op: 'estimates', items: [estimate(0.25)]});
      // In the second log the rover is 1 m higher.
      server.send({op: 'estimates', branch: 1, items: [estimate(1.5)]});
      const other = `p.sides.others.find(({name}) => name === 'rover1')`;
      let probe = await until(page, `(p) => p.estimates[0]?.error_m && ${other}.error_m !== null`, 'both errors');
      near(probe.estimates[0].error_m, 0.25, 1e-3, 'error in the first log');
      near(probe.sides.others.find(({name}) => name === 'rover1').error_m, 0.5, 1e-3, 'error in the second log');
      await page.evaluate(() => window.shoal.select('rover1'));
      probe = await until(page, (p) => p.labels.filter((label) => /^rover1 {2}error/.test(label)).length === 2);
      assert.deepEqual(
          probe.labels.filter((label) => /error/.test(label)), ['rover1  error 0.25 m', 'rover1  error 0.50 m']);
      // A time without estimates has none.
      server.send({op: 'estimates', branch: 1, items: []});
      await until(page, `(p) => ${other}.error_m === null`);
    }, {width: 1280, height: 800});
  });

  it('turns both with one camera, and goes back to ghosts', async () => {
    await withPage(twoLogs(), async (page, server) => {
      const before = await besides(page, server);
      await page.keyboard.press('2');
      const pixel = (probe) => probe.sides.others.find((one) => one.name === 'rover1').pixel;
      const moved = `(p) => Math.abs((p.sides.others.find((one) => one.name === 'rover1').pixel?.[1] ?? 0)
                                     - ${pixel(before)[1]}) > 5`;
      const above = await until(page, moved, 'seen from above');
      assert.equal(above.camera.mode, 'top');
      await page.select('#sides', 'over');
      const probe = await until(page, (p) => p.sides === null && p.ghosts.length > 0, 'overlaid');
      assert.ok(probe.vehicles[0].pixel);
      assert.ok(await page.$eval('#side-names', (names) => names.hidden));
    });
  });

  it('says in each half what the programs of the branch do', async () => {
    const script = {...scenes.land(), hello: {past: true, record: 'branched', programs: 'restarted programs'}};
    script.branches = {0: script.posesAt};
    await withPage(script, async (page, server) => {
      await show(page, server, 7);
      server.send({
        op: 'branches',
        present: 1,
        by: 'poses',
        items: [
          {branch: 0, parent: null, start_us: 0, end_us: 9e6, differs_us: null, programs: 'recorded commands'},
          {branch: 1, parent: 0, start_us: 3e6, end_us: null, differs_us: null, programs: 'restarted programs'}
        ]
      });
      await page.waitForFunction(() => !document.getElementById('branches').hidden);
      assert.match(await text(page, '#branch-list'), /Branch 0.*recorded commands.*Branch 1.*restarted programs/);
      await page.focus('#view');
      await page.keyboard.press('b');
      assert.match(await text(page, '#toasts'), /show a branch or a second log as ghosts first/);
      await page.click('#branch-list [data-branch="0"]');
      await page.focus('#view');
      await page.keyboard.press('b');
      await until(page, (p) => p.sides !== null);
      assert.equal(await text(page, '#side-a'), 'Branch 1 (restarted programs)');
      assert.equal(await text(page, '#side-b'), 'Branch 0 (recorded commands)');
      // After its end a branch stands still, and its name says so.
      await until(page, (p) => p.sides.others.length === p.vehicles.length, 'both');
      await show(page, server, 14);
      await page.waitForFunction(() => / ended at 9\.00 s$/.test(document.getElementById('side-b').textContent));
      const probe = await until(page, (p) => p);
      assert.equal(probe.sides.others.length, probe.vehicles.length);
    });
  });

  it('asks for a branch with restarted programs or with recorded commands', async () => {
    const hello = {past: true, record: 'recorded', programs: 'recorded commands', may_launch: true};
    await withPage({...scenes.land(), hello}, async (page, server) => {
      await show(page, server, 7);
      await page.click('#branch');
      await page.select('#branch-programs', 'recorded');
      await page.click('#branch');
      // The server here has no branches, and says so of each request.
      await page.waitForFunction(() => document.querySelectorAll('#events .problem, #toasts div').length > 1);
      const requested = server.received.filter((message) => message.command === 'branch');
      assert.deepEqual(requested.map((message) => message.text), ['restarted', 'recorded']);
    });
  });
});
