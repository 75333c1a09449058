// SPDX-License-Identifier: BSD-3-Clause
// Returns of sensors and ranges in the scene.
import assert from 'node:assert/strict';
import {describe, it} from 'node:test';

import {until} from './browser.js';
import * as scenes from './scenes.js';
import {near, show, useBrowser, withPage} from './with_page.js';

useBrowser();

const SMALL = {
  width: 480,
  height: 360
};

/** Rotates a vector by a quaternion w, x, y, z. */
function turn([w, x, y, z], v) {
  const t = [2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])];
  return [
    v[0] + w * t[0] + y * t[2] - z * t[1], v[1] + w * t[1] + z * t[0] - x * t[2], v[2] + w * t[2] + x * t[1] - y * t[0]
  ];
}

/** A point of the frame of a sensor in the world. */
function toWorld(bodyPose, devicePose, point) {
  const inBody = turn(devicePose.slice(3), point).map((x, i) => x + devicePose[i]);
  return turn(bodyPose.slice(3), inBody).map((x, i) => x + bodyPose[i]);
}

function compare(points, expected) {
  assert.equal(points.length, expected.length);
  points.forEach((point, i) => point.forEach((x, k) => near(x, expected[i][k], 0.01, `point ${i}, axis ${k}`)));
}

describe('lights', () => {
  it('are the colors of their parts from the first report on, until the time jumps', async () => {
    const script = scenes.land(), [rover] = script.scene.vehicles;
    rover.devices.push({name: 'lights', type: 'led', body: 0, pose: scenes.at(0, 0, 0), channels: ['rover1.lights']});
    script.scene.bodies[0].parts[1].name = 'lamp';
    await withPage(script, async (page, server) => {
      await show(page, server, 0);
      const color = () => page.evaluate(() => window.shoal.presentColor('rover1/chassis/lamp'));
      assert.equal(await color(), 0xe8ecef);
      const report = {utime: 0, light: ['a'], intensity: [1], part: ['chassis/lamp'], color: [0xff8000]};
      await server.publishOnceWanted('rover1.lights', 'led_t', 0.1e6, report);
      await page.waitForFunction(() => window.shoal.presentColor('rover1/chassis/lamp') === 0xff8000);
      await show(page, server, 0);  // a jump: what belongs to another time goes
      await page.waitForFunction(() => window.shoal.presentColor('rover1/chassis/lamp') === 0xe8ecef);
    }, SMALL);
  });
});

describe('returns', () => {
  it('of lidars are where the sensor was when it measured, while it moves', async () => {
    const script = scenes.land(), [rover] = script.scene.vehicles;
    rover.devices[0].pose = scenes.at(0.12, 0.05, 0.3, 0.7);
    rover.devices.push({name: 'top', type: 'lidar3d', body: 0, pose: scenes.at(0, 0, 0.5), channels: ['rover1.top']});
    await withPage(script, async (page, server) => {
      await page.evaluate(() => window.shoal.select('rover1'));
      await show(page, server, 0);
      for (let t_s = 0.1; t_s < 1.05; t_s += 0.1) await show(page, server, Math.round(10 * t_s) / 10, false);
      // A fan of 31 beams that was measured between two states; two beams without a return.
      const ranges = Float32Array.from({length: 31}, (_, i) => 2 + 0.05 * i);
      ranges[3] = ranges[4] = 5;
      const t_s = 0.85, [pose] = script.posesAt(t_s);
      await server.publishOnceWanted(
          'rover1.lidar', 'planar_lidar_t', 0.9e6, {utime: t_s * 1e6, ranges, rad0: -1.5, radstep: 0.1});
      await until(page, (p) => p.returns.some((one) => one.channel === 'rover1.lidar' && one.count === 29));
      const beams = [...ranges.keys()].filter((i) => ranges[i] < 5);
      compare(
          await page.evaluate(() => window.shoal.returnsOf('rover1.lidar')),
          beams.map((i) => toWorld(pose, rover.devices[0].pose, [
                      ranges[i] * Math.cos(-1.5 + 0.1 * i), ranges[i] * Math.sin(-1.5 + 0.1 * i), 0
                    ])));
      // A revolution of 0.2 s: each point has the pose of its own time.
      const count = 40, angle = (i) => 2 * Math.PI * i / count, offset_us = (i) => -200000 + i * 5000;
      const list = (value) => Float32Array.from({length: count}, (_, i) => value(i));
      await server.publishOnceWanted('rover1.top', 'point_cloud_t', 1e6, {
        utime: 1e6,
        count,
        x_m: list((i) => 4 * Math.cos(angle(i))),
        y_m: list((i) => 4 * Math.sin(angle(i))),
        z_m: list(() => -0.2),
        time_offsets_us: BigInt64Array.from({length: count}, (_, i) => BigInt(offset_us(i))),
      });
      await until(page, (p) => p.returns.some((one) => one.channel === 'rover1.top' && one.count === 40));
      const points = await page.evaluate(() => window.shoal.returnsOf('rover1.top'));
      points.forEach((point, i) => {
        const [body] = script.posesAt(1 + offset_us(i) / 1e6);
        const expected = toWorld(body, rover.devices[2].pose, [4 * Math.cos(angle(i)), 4 * Math.sin(angle(i)), -0.2]);
        // Poses are taken every 10 ms: 5 ms at 0.31 rad/s and 4 m.
        point.forEach((x, k) => near(x, expected[k], 0.01, `point ${i}, axis ${k}`));
      });
      // Another time shown: the returns of the future go.
      await show(page, server, 0.5);
      await until(page, (p) => p.returns.length === 0);
    }, SMALL);
  });

  it('of lasers have rays from the sensor, of the selected vehicle or of all', async () => {
    const script = scenes.land(), [one, two] = script.scene.vehicles;
    two.devices.push({name: 'eye', type: 'lidar', body: 1, pose: scenes.at(0, 0, 0.2), channels: ['rover2.eye']});
    one.devices[0].pose = scenes.at(0.12, 0.05, 0.3, 0.7);
    await withPage(script, async (page, server) => {
      await page.evaluate(() => window.shoal.select('rover1'));
      await show(page, server, 1);
      const scan = {utime: 1e6, ranges: Float32Array.from([2, 5, 3]), rad0: -0.5, radstep: 0.5};
      await server.publishOnceWanted('rover1.lidar', 'planar_lidar_t', 1e6, scan);
      await until(page, (p) => p.returns[0]?.count === 2 && p.returns[0].rays === 0);
      // The second beam, of the largest range, has no return.
      const choose = (id, value) => page.evaluate((option, to) => {
        document.getElementById(option).value = to;
        document.getElementById(option).dispatchEvent(new Event('input'));
      }, id, value);
      await choose('o-rays', 'selected');
      await until(page, (p) => p.returns[0]?.rays === 2);
      const [body] = script.posesAt(1);
      const hit = (range, angle) =>
          toWorld(body, one.devices[0].pose, [range * Math.cos(angle), range * Math.sin(angle), 0]);
      const eye = toWorld(body, one.devices[0].pose, [0, 0, 0]);
      compare(await page.evaluate(() => window.shoal.raysOf('rover1.lidar')), [eye, hit(2, -0.5), eye, hit(3, 0.5)]);
      // Rays without the points, and those of the other vehicle.
      await choose('o-returns', 'off');
      await until(page, (p) => p.returns[0]?.count === 0 && p.returns[0].rays === 2);
      await choose('o-rays', 'all');
      await server.publishOnceWanted('rover2.eye', 'planar_lidar_t', 1e6, scan);
      await until(page, (p) => p.returns.find(({channel}) => channel === 'rover2.eye')?.rays === 3);
      await choose('o-rays', 'off');
      await until(page, (p) => p.returns.length === 0);
    }, SMALL);
  });

  it('of a DVL, an altimeter and a multibeam lie on their beams', async () => {
    const script = scenes.underwater(), [auv] = script.scene.vehicles, [body] = script.posesAt(0);
    auv.devices[0].channels = ['auv1.dvl'];
    const device = (name, type, view) => {
      auv.devices.push(
          {name, type, body: 0, pose: scenes.at(0.3, 0.1, -0.2, 0.4), channels: [`auv1.${name}`], field_of_view: view});
    };
    device('alt', 'altimeter', {kind: 'cone', axis: [0, 0, -1], half_angle_rad: 0.1, range_m: 50});
    device('swath', 'multibeam', {kind: 'beams', directions: [], range_m: 50});
    await withPage(script, async (page, server) => {
      await page.evaluate(() => window.shoal.select('auv1'));
      await show(page, server, 1);
      await server.publishOnceWanted('auv1.dvl', 'dvl_t', 1e6, {
        utime: 1e6,
        beam_range_m: [12, 13, null, 15],
        beam_valid: [true, true, false, true],
      });
      await server.publishOnceWanted('auv1.alt', 'sonar_range_t', 1e6, {utime: 1e6, range_m: 18.5, valid: true});
      const angles_rad = Float32Array.from({length: 41}, (_, i) => -1 + 0.05 * i);
      const ranges_m = angles_rad.map((angle) => 20 / Math.cos(angle));
      const valid = Uint8Array.from({length: 41}, (_, i) => Number(i !== 7));
      await server.publishOnceWanted('auv1.swath', 'multibeam_t', 1e6, {utime: 1e6, angles_rad, ranges_m, valid});
      await until(page, (p) => p.returns.length === 3);
      const {directions} = auv.devices[0].field_of_view;
      compare(await page.evaluate(() => window.shoal.returnsOf('auv1.dvl')), [
        [0, 12], [1, 13], [3, 15]
      ].map(([i, range]) => toWorld(body, auv.devices[0].pose, directions[i].map((x) => x * range))));
      compare(
          await page.evaluate(() => window.shoal.returnsOf('auv1.alt')),
          [toWorld(body, auv.devices[1].pose, [0, 0, -18.5])]);
      const beams = [...angles_rad.keys()].filter((i) => i !== 7);
      compare(
          await page.evaluate(() => window.shoal.returnsOf('auv1.swath')),
          beams.map((i) => toWorld(body, auv.devices[2].pose, [0, 20 * Math.tan(angles_rad[i]), -20])));
    }, SMALL);
  });
});

describe('ranges', () => {
  it('are spheres about the receiver beside the true distance', async () => {
    const script = scenes.underwater(), [auv1, auv2] = script.scene.vehicles;
    script.posesAt = () => [scenes.at(0, 0, -10), scenes.at(30, 40, -10), scenes.at(0, 10, -10)];
    const add = (vehicle, name, type, body) =>
        vehicle.devices.push({name, type, body, pose: scenes.at(0, 0, 0.2), channels: [`${vehicle.name}.${name}`]});
    add(auv1, 'usbl', 'usbl', 0);
    add(auv1, 'modem', 'acoustic_modem', 0);
    add(auv1, 'radio', 'range_beacon', 0);
    add(auv2, 'answer', 'transponder', 1);
    await withPage(script, async (page, server) => {
      await page.evaluate(() => window.shoal.select('auv1'));
      await show(page, server, 1);
      await server.publishOnceWanted('auv1.usbl', 'usbl_t', 1e6, {
        utime: 1e6,
        target: 'auv2/answer',
        range_m: 50.5,
        position_m: [30.3, 40.4, 0],
      });
      server.publish('auv1.modem', 'acoustic_received_t', 1e6, {utime: 1e6, source: 'auv3', travel_time_s: 0.01});
      server.publish('auv1.radio', 'range_beacon_t', 1e6, {utime: 1e6, beacon: ['pole', 'auv2'], range_m: [7, null]});
      const {ranges} = await until(page, (p) => p.ranges.length === 3);
      const byName = Object.fromEntries(ranges.map((range) => [range.name, range]));
      const usbl = byName['auv1 → auv2/answer'];
      assert.equal(usbl.range_m, 50.5);
      near(usbl.true_m, 50, 1e-3, 'true distance');
      [0, 0, -9.8].forEach((value, i) => near(usbl.center[i], value, 1e-3, `center ${i}`));
      // 1498.8 m/s at 9.8 m, by the profile of the scene.
      near(byName['auv1 → auv3'].range_m, 14.988, 0.001, 'travel time times sound speed');
      near(byName['auv1 → auv3'].true_m, Math.hypot(10, 0.2), 1e-3, 'to the vehicle');
      assert.equal(byName['auv1 → pole'].true_m, null);
      await page.evaluate(() => {
        const list = document.getElementById('o-ranges');
        list.value = 'off';
        list.dispatchEvent(new Event('input'));
      });
      await until(page, (p) => p.ranges.length === 0);
    }, SMALL);
  });
});
