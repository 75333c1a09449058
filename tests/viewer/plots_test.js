// SPDX-License-Identifier: BSD-3-Clause
// Plots of fields of channels: of a run and of a log.
import assert from 'node:assert/strict';
import {describe, it} from 'node:test';

import {until} from './browser.js';
import * as scenes from './scenes.js';
import {near, show, useBrowser, withPage} from './with_page.js';

useBrowser();

const CHANNELS = [['rover1.pose', 'shoal.pose_t', 'rover1'], ['rover1.speed', 'shoal.some_t', 'rover1']];
const SIZE = {
  width: 900,
  height: 620
};

/** Chooses a field and a plot for it, as a user does. */
async function plot(page, channel, field, place) {
  const [channels, fields, places] = await page.$$('#dock-plots .form select');
  await channels.select(channel);
  return {
    add: async () => {
      await page.waitForFunction(
          (name) => [...document.querySelectorAll('#dock-plots .form select')[1].options].some((o) => o.value === name),
          {}, field);
      await fields.select(field);
      await places.select(place);
      await page.click('#dock-plots .form button');
    }
  };
}

describe('plots', () => {
  it('collect the messages of a run, one axis for each unit', async () => {
    await withPage(scenes.land(), async (page, server) => {
      await page.click('#data');
      server.sendChannels(0, CHANNELS);
      await page.waitForFunction(() => document.querySelectorAll('#dock-plots .form option').length > 3);
      const pose = (t_s) => ({pos: [t_s, 2 * t_s, NaN], yaw_rad: Math.sin(t_s)});
      // The list of fields comes with the first message.
      const first = await plot(page, 'rover1.pose', 'pos[1]', 'new');
      await server.publishOnceWanted('rover1.pose', 'pose_t', 0, pose(0));
      await first.add();
      await (await plot(page, 'rover1.pose', 'yaw_rad', '0')).add();
      for (let t_s = 1; t_s <= 5; ++t_s) await server.publishOnceWanted('rover1.pose', 'pose_t', t_s * 1e6, pose(t_s));
      const {plots} = await until(page, (p) => p.plots[0]?.[1]?.last_s === 5);
      assert.deepEqual(plots[0].map((trace) => [trace.field, trace.unit]), [['pos[1]', ''], ['yaw_rad', 'rad']]);
      // The value at the time shown.
      await show(page, server, 4, false);
      await page.waitForFunction(
          () => document.querySelector('.plot-legend').textContent.includes('pos[1]8') &&
              document.querySelector('.plot-legend').textContent.includes('-0.757'));
      // A run that was rewound: another branch has no samples of this one.
      await show(page, server, 2);
      await server.publishOnceWanted('rover1.pose', 'pose_t', 2.5e6, pose(2.5));
      const {plots: [[trace]]} = await until(page, (p) => p.plots[0][0].last_s === 2.5);
      assert.equal(trace.count, 3);  // of 1, 2 and 2.5 s
      await page.waitForFunction(() => location.hash.includes('plots=rover1.pose'));
    }, SIZE);
  });

  it('show a log as a whole, seek by a click, zoom by a drag', async () => {
    const script = {
      ...scenes.land(),
      hello: {source: 'log', start_us: 0, end_us: 60e6, name: 'a.lcm'},
      seriesAt: (channel, field, t_s) => (field === 'pos[0]' ? 3 * t_s : 100 - t_s),
    };
    const fragment = '#t=secret&data=plots&plots=rover1.pose/pos[0],rover1.pose/height_m;rover1.speed/v_mps';
    await withPage(script, async (page, server) => {
      const {plots} =
          await until(page, (p) => p.plots.length === 2 && p.plots.flat().every((trace) => trace.count > 0));
      assert.deepEqual(plots.map((one) => one.length), [2, 1]);
      for (const trace of plots.flat()) assert.deepEqual([trace.first_s, trace.last_s], [0, 60]);
      assert.ok(plots[0][0].count >= 200);
      // A click at three quarters of the plot.
      await page.waitForSelector('.plot .u-over');
      await page.waitForFunction(() => document.querySelector('.plot .u-over').clientWidth > 50);
      const box = await page.$eval('.plot .u-over', (over) => {
        const {left, top, width, height} = over.getBoundingClientRect();
        return {left, top, width, height};
      });
      const at = (share) => [box.left + share * box.width, box.top + box.height / 2];
      await page.mouse.click(...at(0.75));
      const probe = await until(page, (p) => p.time_us > 1e6, 'the log goes to 45 s');
      near(probe.time_us / 1e6, 45, 60 / box.width + 0.01, 'time of the click');
      const marker = await page.$eval('.plot .now', (line) => new DOMMatrix(getComputedStyle(line).transform).e);
      near(marker, 0.75 * box.width, 3, 'mark of the time shown');
      // A drag shows a part with samples of its own.
      await page.mouse.move(...at(0.25));
      await page.mouse.down();
      await page.mouse.move(...at(0.4));
      await page.mouse.move(...at(0.5));
      await page.mouse.up();
      const zoomed = await until(page, (p) => p.plots.flat().every((trace) => trace.first_s > 14));
      near(zoomed.plots[0][0].first_s, 15, 60 * 2 / box.width, 'from');
      near(zoomed.plots[1][0].last_s, 30, 60 * 2 / box.width, 'to');
      const [channel] = server.received.filter((message) => message.op === 'series').slice(-1);
      assert.equal(channel.field, 'v_mps');
    }, {...SIZE, fragment});
  });
});
