// SPDX-License-Identifier: BSD-3-Clause
// What shows that there is a sea: its surface, depths of the vehicles, sound between them.
import assert from 'node:assert/strict';
import {describe, it} from 'node:test';

import {until} from './browser.js';
import {readPng} from './png.js';
import {at, land, surface, underwater} from './scenes.js';
import {near, show, text, useBrowser, withPage} from './with_page.js';

useBrowser();

const setSwitch = (page, name, on) => page.evaluate((id, checked) => {
  document.getElementById(id).checked = checked;
  document.getElementById(id).dispatchEvent(new Event('input'));
}, `o-${name}`, on);

/** Share of the pixels of the middle of the page that are nearly white, and the range of green of the others. */
async function brightnessOf(page) {
  const clip = {x: 300, y: 150, width: 300, height: 260};
  const {data, channels} = readPng(Buffer.from(await page.screenshot({clip})));
  const red = [], green = [];
  for (let i = 0; i < data.length; i += channels) red.push(data[i]), green.push(data[i + 1]);
  green.sort((a, b) => a - b);
  return {
    white: red.filter((level) => level > 185).length / red.length,
    range: green[Math.floor(0.9 * green.length)] - green[Math.floor(0.1 * green.length)],
  };
}

describe('depths', () => {
  it('are lines to the surface and the bottom with their lengths as text', async () => {
    await withPage(underwater(), async (page, server) => {
      await show(page, server, 2);
      // The floor is at -30 m below auv1.
      const probe = await until(page, (p) => p.labels.includes('depth 10.0 m') && p.labels.includes('altitude 20.0 m'));
      const [one] = probe.depths.vehicles;
      assert.equal(one.name, 'auv1');
      near(one.depth_m, 10, 1e-3, 'depth');
      near(one.altitude_m, 20, 1e-3, 'altitude');
      assert.equal(probe.depths.vehicles.length, 3);
      // The scale begins at the surface, and its numbers are the depths of its ticks.
      assert.equal(probe.depths.scale[0].text, '0 m');
      for (const tick of probe.depths.scale) near(-tick.position[2], parseFloat(tick.text), 1e-3, tick.text);
      assert.ok(probe.depths.scale.length >= 3, `${probe.depths.scale.length} ticks`);
      await setSwitch(page, 'depths', false);
      await until(page, (p) => p.depths.vertices === 0 && !p.labels.some((label) => label.startsWith('depth')));
    });
  });

  it('of boats without a bottom are none, and on land there are none', async () => {
    await withPage(surface(), async (page, server) => {
      const {depths} = await show(page, server, 1);
      const of = (name) => depths.vehicles.find((one) => one.name === name);
      assert.equal(of('boat1').depth_m, 0);
      near(of('auv1').depth_m, 2.5, 1e-3, 'depth');
      assert.deepEqual(depths.vehicles.map((one) => one.altitude_m), [null, null, null]);
    });
    await withPage(land(), async (page, server) => {
      assert.deepEqual((await show(page, server, 1)).depths, {vehicles: [], scale: [], vertices: 0});
    });
  });
});

describe('the surface', () => {
  const sea = (waves) => {
    const script = surface();
    script.scene.water.waves = waves;
    return script;
  };
  const look = async (waves) => {
    let found;
    await withPage(sea(waves), async (page, server) => {
      await show(page, server, 1);
      await setSwitch(page, 'depths', false);
      await page.evaluate(() => window.shoal.setView('orbit,-160,-12,9,-150,0,0'));
      const {frames} = await page.evaluate(() => window.shoal.probe());
      await page.evaluate(() => window.dispatchEvent(new Event('resize')));
      await until(page, `(p) => p.frames > ${frames + 1}`).catch(() => {});
      found = await brightnessOf(page);
    });
    return found;
  };
  const wave = (amplitude_m) => [{amplitude_m, k_radpm: 1, omega_radps: 3.13, phase_rad: 0, direction_rad: 0.4}];

  it('has foam where it is steep, light on its waves, and lines where it is flat', async () => {
    const flat = await look([]), small = await look(wave(0.05)), steep = await look(wave(0.4));
    assert.equal(flat.white, 0, 'foam on a flat sea');
    assert.ok(small.range > flat.range + 4, `waves of 5 cm: ${small.range}, flat ${flat.range}`);
    assert.ok(steep.white > 0.02, `foam on ${steep.white} of the pixels`);
  });
});

describe('sound', () => {
  const sound = {
    id: 7,
    source: 'auv1',
    position_m: [0, 0, -10],
    duration_us: 20000,
    sound_speed_mps: 1500,
    kind: 'message',
  };
  const reception = {id: 7, to: 'auv2', position_m: [24, 12, -14], travel_s: 0.018, snr_dB: 9, outcome: 'interference'};

  it('is drawn slower while it would cross the scene in less than a second, and says so', async () => {
    const script = underwater();
    script.posesAt = () => [at(0, 0, -10), at(24, 12, -14), at(-18, 12, -8)];
    await withPage(script, async (page, server) => {
      server.paused = false;
      // The probe of the frame in which it is drawn: it is soon gone, on a busy machine between two frames.
      await until(page, (p) => p.time_us > 2e5);
      let found = null, time_us = 0;
      while (!found) {
        ({time_us} = await until(page, (p) => p.sounds.length === 0 && p.sound_lines.length === 0));
        server.send({op: 'sounds', items: [{...sound, time_us}]});
        server.send({op: 'receptions', items: [{...reception, time_us: time_us + 18000}]});
        found = await page
                    .waitForFunction(
                        () => {
                          const drawn = window.shoal.probe();
                          return drawn.sounds.length === 1 && drawn.sounds[0].slowness > 1 &&
                              drawn.sound_lines.length > 0 && drawn;
                        },
                        {polling: 20, timeout: 3000})
                    .catch(() => null);
      }
      const probe = await found.jsonValue();
      // It takes 0.8 s to 1.2 times the distance of its receiver, in place of 22 ms.
      const distance_m = Math.hypot(24, 12, 4);
      near(probe.sounds[0].slowness, 0.8 / (1.2 * distance_m / 1500), 0.1, 'slowness');
      assert.ok(probe.sounds[0].outer_m < 2 * distance_m, `${probe.sounds[0].outer_m} m`);
      assert.match(await text(page, '#legend'), /sound is drawn 3[67] times slower/);
      // The line from sender to receiver fades within 2.5 s.
      const [line] = probe.sound_lines;
      assert.deepEqual([line.from, line.to, line.outcome], [[0, 0, -10], [24, 12, -14], 'interference']);
      near(line.left, 1 - (probe.time_us - time_us - 18000) / 2.5e6, 1e-3, 'what is left of the line');
      await until(page, (p) => p.sound_lines.length === 0 && p.sounds.length === 0);
    });
  });

  it('is drawn as it is where it is slow enough', async () => {
    await withPage(underwater(), async (page, server) => {
      server.speed = 0.01;
      server.paused = false;
      const {time_us} = await until(page, (p) => p.time_us > 0);
      server.send({op: 'sounds', items: [{...sound, time_us}]});
      const probe = await until(page, (p) => p.sounds.length === 1 && p.sounds[0].outer_m > 10);
      assert.equal(probe.sounds[0].slowness, 1);
      near(probe.sounds[0].outer_m, 1500e-6 * (probe.time_us - time_us), 0.01, 'radius');
      assert.doesNotMatch(await text(page, '#legend'), /slower/);
    });
  });
});

describe('vehicles', () => {
  /** Two AUVs that go east and away from each other, the first with devices. */
  const pair = (speed_mps) => {
    const script = underwater();
    const device = (name, type, pose) => ({name, type, body: 0, pose, channels: []});
    script.scene.vehicles[0].devices = [
      device('rudder', 'fin', at(-0.8, 0, 0)), device('planes', 'fin', [-0.8, 0, 0, Math.SQRT1_2, Math.SQRT1_2, 0, 0]),
      device('propeller', 'thruster', at(-0.85, 0, 0)), device('lamp', 'led', at(0.6, 0, 0.16))
    ];
    script.posesAt = (t_s) => [at(0.2 * t_s, 0, -10), at(24 + speed_mps * t_s, 12, -14), at(-18, 12, -8)];
    return script;
  };

  it('under water have fins, a propeller that turns, a nose and a band', async () => {
    await withPage(pair(0), async (page, server) => {
      const first = await show(page, server, 1), later = await show(page, server, 1.5, false);
      const own = (probe) => probe.fittings.filter((one) => one.vehicle === 0);
      const count = (shape) => own(first).filter((one) => one.shape === shape).length;
      assert.deepEqual({box: count('box'), cylinder: count('cylinder'), sphere: count('sphere')}, {
        box: 2 + 3,   // fins, blades
        cylinder: 2,  // hub, band
        sphere: 2     // nose, lamp
      });
      assert.ok(own(first).some((one) => one.shape === 'cylinder' && one.color === '#56b4e9'), 'a band in its color');
      // A vehicle without devices has a nose and a band only.
      assert.equal(first.fittings.filter((one) => one.vehicle === 1).length, 2);
      // All move by 0.1 m to the east, and the blades turn about the x axis.
      own(first).forEach((one, i) => {
        const two = own(later)[i];
        near(two.position[0] - one.position[0], 0.1, 1e-4, `${one.shape} moves`);
        const turned = Math.hypot(two.position[1] - one.position[1], two.position[2] - one.position[2]);
        assert.equal(turned > 0.01, one.turns, `${one.shape} turns by ${turned} m`);
      });
      // They are not shapes of collisions.
      await page.select('#o-shapes', 'collision');
      await until(page, (p) => p.fittings.length === 0);
    });
  });

  it('that leave the view are brought back, until the user moves the camera', async () => {
    await withPage(pair(20), async (page, server) => {
      server.show(0);
      await page.keyboard.press('Home');
      const inside = `(p) => p.vehicles.every(({pixel}) => pixel && pixel[0] > 200 && pixel[0] < 760 && pixel[1] > 50)`;
      await until(page, inside);
      server.paused = false;
      await until(page, '(p) => p.time_us > 4e6');
      const {camera} = await until(page, inside);
      await page.keyboard.press('+');
      const kept = (await page.evaluate(() => window.shoal.probe())).camera.target;
      assert.ok(kept[0] > 20, `the camera looks at ${kept}`);
      const {time_us} = await page.evaluate(() => window.shoal.probe());
      const last = await until(page, `(p) => p.time_us > ${time_us + 3e6}`);
      near(last.camera.target[0], kept[0], 0.5, 'the target stays');
      assert.equal(camera.mode, 'orbit');
    });
  });
});

describe('the resolution', () => {
  it('falls to a half while frames take long, and the page says so', async () => {
    await withPage(underwater(), async (page) => {
      const seen = await page.evaluate(async () => {
        const {Resolution} = await import('./resolution.js');
        const ratios = [], hidden = [];
        const resolution = new Resolution({setPixelRatio: (ratio) => ratios.push(ratio)}, true);
        const note = () => hidden.push(document.getElementById('coarse').hidden);
        const start_ms = performance.now();
        note();
        for (let i = 1; i <= 20; ++i) resolution.adapt(true, start_ms + 300 * i);
        note();
        resolution.adapt(false, start_ms + 300 * 20 + 1000);  // nothing moves
        note();
        return {ratios, hidden};
      });
      assert.deepEqual(seen, {ratios: [1, 0.5, 1], hidden: [true, false, true]});
    });
  });
});
