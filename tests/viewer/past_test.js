// SPDX-License-Identifier: BSD-3-Clause
// The past of a run, its branches, and two logs, on the live page in Chromium against the mock server.
import assert from 'node:assert/strict';
import {describe, it} from 'node:test';

import {until} from './browser.js';
import * as scenes from './scenes.js';
import {near, text, useBrowser, withPage} from './with_page.js';

useBrowser();

/** A run whose server keeps the past. */
const run = (more = {}) => ({...scenes.land(), hello: {past: true}, ...more});

/** Picks a time on the time line. */
const pick = (page, time_s) => page.$eval('#seek', (seek, value) => {
  seek.value = value;
  seek.dispatchEvent(new Event('input'));
}, 1000 * time_s);

/** Waits for an element to be hidden: while time passes the panels are written some times per second. */
const hidden = (page, selector) => page.waitForFunction((name) => document.querySelector(name).hidden, {}, selector);

/** Where rover1 of the scene `land` is: on a circle of 2 m, once around in 20 s. */
const roverAt = (t_s) => [2 * Math.cos(2 * Math.PI * t_s / 20), 2 * Math.sin(2 * Math.PI * t_s / 20)];

describe('past', () => {
  it('shows a time of the past while the run continues, and the present again', async () => {
    await withPage(run(), async (page, server) => {
      server.show(8e6);
      server.paused = false;
      await until(page, (p) => p.time_us > 8.1e6);
      await pick(page, 3);
      const probe = await until(page, (p) => p.past && p.time_us === 3e6, 'three seconds');
      roverAt(3).forEach((value, i) => near(probe.bodies[0].position[i], value, 1e-3, `position ${i}`));
      // The run was not touched: no request, and its time continues.
      const later = await until(page, `(p) => p.newest_us > ${probe.newest_us + 3e5} && p.past`);
      assert.equal(later.time_us, 3e6);
      assert.ok(server.received.every((message) => message.op !== 'control'));
      assert.match(await text(page, '#past'), /past; run at/);
      await page.click('#live');
      await until(page, `(p) => !p.past && p.time_us > ${later.newest_us}`, 'the present');
      assert.ok(server.received.some((message) => message.op === 'look' && message.time_us === null));
      await hidden(page, '#rewind');
    });
  });

  it('plays the past back at a speed, and ends in the present', async () => {
    await withPage(run(), async (page, server) => {
      server.show(8e6);
      await until(page, (p) => p.time_us === 8e6);
      await pick(page, 2);
      await until(page, (p) => p.past && p.time_us === 2e6);
      await page.select('#replay-speed', '0.25');
      await page.click('#replay');
      const probe = await until(page, (p) => p.past && p.time_us > 2.15e6, 'a later time');
      const [x, y] = roverAt(probe.time_us / 1e6);
      // Between states 0.1 s apart: the chord of the circle is within 2 mm of it.
      near(probe.bodies[0].position[0], x, 0.005, 'x');
      near(probe.bodies[0].position[1], y, 0.005, 'y');
      await page.select('#replay-speed', '64');
      await until(page, (p) => !p.past && p.time_us === 8e6, 'the present');
    });
  });

  it('rewinds the run to the time shown', async () => {
    await withPage(run(), async (page, server) => {
      server.show(8e6);
      await until(page, (p) => p.time_us === 8e6);
      await pick(page, 5);
      await until(page, (p) => p.past && p.time_us === 5e6);
      await page.waitForFunction(() => document.getElementById('rewind').textContent === 'Rewind to 5.00 s');
      await page.click('#rewind');
      await until(page, (p) => !p.past && p.newest_us === 5e6 && p.time_us === 5e6, 'rewound');
      assert.equal(server.received.find((message) => message.command === 'rewind').value, 3);
    });
  });

  it('is for readers without the token, who cannot rewind', async () => {
    await withPage(run(), async (page, server) => {
      server.show(8e6);
      await until(page, (p) => p.time_us === 8e6);
      await pick(page, 1);
      await until(page, (p) => p.past && p.time_us === 1e6);
      await hidden(page, '#rewind');
      await page.focus('#view');
      await page.keyboard.press('Escape');
      await until(page, (p) => !p.past && p.time_us === 8e6, 'the present');
    }, {fragment: ''});
  });

  it('asks again when an answer is lost', async () => {
    await withPage(run(), async (page, server) => {
      server.show(8e6);
      await until(page, (p) => p.time_us === 8e6);
      server.deaf = true;
      await pick(page, 4);
      await page.waitForFunction(() => !document.getElementById('live').hidden);
      await until(page, (p) => !p.past);
      server.deaf = false;
      await until(page, (p) => p.past && p.time_us === 4e6);
    });
  });

  it('marks events on the time line; a click shows their time', async () => {
    await withPage(run(), async (page, server) => {
      server.show(8e6);
      await until(page, (p) => p.time_us === 8e6);
      server.send({op: 'events', items: [{time_us: 2.5e6, kind: 'fault', who: 'rover1/lidar', text: '<b>silent</b>'}]});
      await page.waitForSelector('#marks .fault');
      assert.match(await page.$eval('#marks .fault', (mark) => mark.title), /2\.50 s: rover1\/lidar: <b>silent<\/b>/);
      await page.$eval('#marks .fault', (mark) => mark.click());
      await until(page, (p) => p.past && p.time_us === 2.5e6);
    });
  });
});

describe('branches', () => {
  /** Branch 0 as the scene; in branch 1 rover1 is 1 m higher from 4 s on. */
  const twoBranches = () => {
    const script = run();
    script.branches = {
      1: (t_s) => script.posesAt(t_s).map((pose, i) => (i === 0 && t_s >= 4 ? pose.with(2, pose[2] + 1) : pose)),
    };
    return script;
  };
  const list = {
    op: 'branches',
    present: 0,
    by: 'poses',
    items: [
      {branch: 0, parent: null, start_us: 0, end_us: null, differs_us: null},
      {branch: 1, parent: 0, start_us: 3e6, end_us: 9e6, differs_us: 4e6}
    ]
  };

  it('shows another branch as ghosts at the same time, and the first difference', async () => {
    await withPage(twoBranches(), async (page, server) => {
      server.show(8e6);
      await until(page, (p) => p.time_us === 8e6);
      await hidden(page, '#branches');
      server.send(list);
      await page.waitForFunction(() => !document.getElementById('branches').hidden);
      assert.match(await text(page, '#branch-list'), /Branch 1.*3\.00 s – 9\.00 s.*differs from 4\.00 s/);
      await page.click('#branch-list [data-branch="1"]');
      const probe = await until(page, (p) => p.ghosts.length === 3, 'ghosts');
      const ghost = probe.ghosts.find((one) => one.name === probe.bodies[0].name);
      near(ghost.position[2] - probe.bodies[0].position[2], 1, 1e-3, 'height of the ghost');
      near(ghost.position[0], probe.bodies[0].position[0], 1e-3, 'x of the ghost');
      await page.waitForFunction(
          () => /rover1.*: 1 m apart/.test(document.getElementById('branch-distance').textContent));
      // The first difference, by its mark on the time line.
      await page.$eval('#marks .difference', (mark) => mark.click());
      await until(page, (p) => p.past && p.time_us === 4e6 && p.ghosts.length === 3);
      await page.click('#branch-list [data-branch="1"]');
      await until(page, (p) => p.ghosts.length === 0, 'no ghosts');
    });
  });

  it('shows a second log at once, without bodies that it lacks', async () => {
    const script = {...scenes.land(), hello: {source: 'log', end_us: 60e6, name: 'a.lcm'}};
    script.branches = {1: (t_s) => script.posesAt(t_s).map((pose, i) => (i === 1 ? pose.with(0, NaN) : pose))};
    await withPage(script, async (page, server) => {
      server.show(7e6);
      server.send({
        op: 'branches',
        present: 0,
        by: 'sim.hash',
        items: [
          {branch: 0, parent: null, name: 'a.lcm', start_us: 0, end_us: 60e6, differs_us: null},
          {branch: 1, parent: null, name: '<i>b.lcm', start_us: 0, end_us: 60e6, differs_us: 2e6, differs_step: 200}
        ]
      });
      const probe = await until(page, (p) => p.ghosts.length === 2, 'ghosts of the second log');
      assert.ok(!probe.ghosts.some((ghost) => ghost.name === probe.bodies[1].name));
      assert.match(await text(page, '#branch-list'), /<i>b\.lcm.*differs from 2\.00 s \(step 200\)/);
      await page.click('#branch-list [data-time]');
      await until(page, (p) => p.time_us === 2e6);
    });
  });
});
