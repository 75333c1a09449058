// SPDX-License-Identifier: BSD-3-Clause
// The live page in Chromium against the mock server.  A test fails on any console error, page error, refused content,
// foreign request or missing file.
import assert from 'node:assert/strict';
import {readdir, readFile} from 'node:fs/promises';
import {describe, it} from 'node:test';
import {gzipSync} from 'node:zlib';

import {faultsOf, open, until} from './browser.js';
import {MockServer} from './mock_server.js';
import * as scenes from './scenes.js';
import {browser, near, show, text, useBrowser, withPage} from './with_page.js';

/** A PNG file of one pixel. */
const ONE_PIXEL = 'iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg==';

/** A page that may steer has the tab of actions. */
const FORMS = {
  op: 'forms',
  actions: [{word: 'log', meaning: 'writes', main: 'text', main_alone: true, keys: [{key: 'text', type: 'text'}]}]
};

useBrowser();

describe('scene', () => {
  it('draws every body where the state says, at the right pixel', async () => {
    await withPage(scenes.land(), async (page, server) => {
      const probe = await show(page, server, 5);
      // rover1 after a quarter turn on a circle of 2 m.
      const rover = probe.bodies[0];
      [0, 2, 0.14].forEach((value, i) => near(rover.position[i], value, 1e-3, `position ${i}`));
      // Its pixel, by the pinhole model from the camera of the probe.
      const {position, target, fov_deg} = probe.camera;
      const minus = (a, b) => a.map((x, i) => x - b[i]), dot = (a, b) => a.reduce((s, x, i) => s + x * b[i], 0);
      const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
      const unit = (a) => a.map((x) => x / Math.hypot(...a));
      const ahead = unit(minus(target, position)), right = unit(cross(ahead, [0, 0, 1])), up = cross(right, ahead);
      const d = minus(rover.position, position), focal_px = 300 / Math.tan(fov_deg * Math.PI / 360);
      near(rover.pixel[0], 480 + focal_px * dot(d, right) / dot(d, ahead), 0.5, 'pixel x');
      near(rover.pixel[1], 300 - focal_px * dot(d, up) / dot(d, ahead), 0.5, 'pixel y');
    });
  });

  it('shows the shapes of collisions, and the wire frame', async () => {
    const script = scenes.land();
    script.scene.bodies[0].parts[2].collides = false;
    const total = script.scene.bodies.flatMap((body) => body.parts).filter((part) => part.shape !== 'plane').length;
    await withPage(script, async (page, server) => {
      const {shapes: drawn} = await show(page, server, 1);
      assert.deepEqual([drawn.which, drawn.parts, drawn.wire, drawn.planes], ['drawn', total, 0, 1]);
      const choose = (value) => page.evaluate((to) => {
        document.getElementById('o-shapes').value = to;
        document.getElementById('o-shapes').dispatchEvent(new Event('input'));
      }, value);
      await choose('collision');
      const {shapes: collide} = await until(page, (p) => p.shapes.which === 'collision');
      assert.deepEqual([collide.parts, collide.wire, collide.planes], [total - 1, 0, 1]);
      await choose('wire');
      const {shapes: wire} = await until(page, (p) => p.shapes.which === 'wire');
      assert.deepEqual([wire.parts, wire.wire, wire.planes], [total, wire.groups, 1]);
      // It is still drawn where the state says, and as before when it is chosen again.
      await show(page, server, 2);
      await choose('drawn');
      const {shapes: again, bodies: [rover]} = await until(page, (p) => p.shapes.which === 'drawn');
      assert.deepEqual(again, drawn);
      near(rover.position[0], 2 * Math.cos(2 * Math.PI * 2 / 20), 1e-3, 'x');
    });
  });

  it('shows a state of another revision only after its scene', async () => {
    await withPage(scenes.land(), async (page, server) => {
      await show(page, server, 1);
      server.script.scene.revision = 2;
      server.show(7e6);
      server.script.scene.vehicles.pop();
      server.send(server.script.scene);
      server.show(8e6);
      const probe = await until(page, (p) => p.scene.revision === 2 && p.time_us === 8e6);
      assert.equal(probe.vehicles.length, 2);
    });
  });

  it('says what is wrong with a scene and keeps the one before', async () => {
    await withPage(scenes.land(), async (page, server) => {
      const bad = structuredClone(server.script.scene);
      bad.bodies[1].parts[0].size_m = [1, 'x', 1];
      server.send(bad);
      await page.waitForFunction(
          () => /body 'rover2\/chassis', part 0: 'size_m' must be 3 numbers/.test(
              document.getElementById('events').textContent));
      assert.equal((await page.evaluate(() => window.shoal.probe())).bodies.length, 5);
    });
  });

  it('draws meshes and images that come as assets, and says which one is broken', async () => {
    const script = scenes.land();
    // A tetrahedron of 4 triangles, an image of one pixel, and a mesh that is cut off.
    const mesh = Buffer.alloc(12 + 12 * 4 + 12 * 4);
    [1, 4, 4].forEach((value, i) => mesh.writeUInt32LE(value, 4 * i));
    [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1].forEach((value, i) => mesh.writeFloatLE(value, 12 + 4 * i));
    [0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3].forEach((value, i) => mesh.writeUInt32LE(value, 60 + 4 * i));
    const image = Buffer.concat([Buffer.from([3, 0, 0, 0]), Buffer.from(ONE_PIXEL, 'base64')]);
    script.assets =
        new Map([['000000000000000a', mesh], ['000000000000000b', image], ['000000000000000c', mesh.subarray(0, 50)]]);
    script.scene.materials.push({name: 'poster', texture: {pattern: 'image', asset: '000000000000000b', size_m: 1}});
    const part = (shape) => ({name: 'part', pose: [0, 0, 1, 1, 0, 0, 0], material: 3, ...shape});
    script.scene.bodies[4].parts.push(
        part({shape: 'mesh', asset: '000000000000000a'}), part({shape: 'mesh', asset: '000000000000000c'}));
    await withPage(script, async (page, server) => {
      await show(page, server, 1);
      await page.waitForFunction(
          () => /asset 000000000000000c: mesh: wrong length/.test(document.getElementById('events').textContent));
      const assets = server.requests.filter((path) => path.startsWith('/asset/')).sort();
      assert.deepEqual(assets, ['/asset/000000000000000a', '/asset/000000000000000b', '/asset/000000000000000c']);
    });
  });

  it('reports broken messages and continues', async () => {
    await withPage(scenes.land(), async (page, server) => {
      for (const {socket} of server.clients) {
        for (const junk
                 of ['{', '[]', '{"op": 3}', '{"op": "later", "x": 1}', '{"op":"sounds"}',
                     '{"op":"estimates","items":[{}]}'])
          socket.send(junk);
        for (const bytes of [[], [1], [9, ...Array(40).fill(0)], [1, ...Array(50).fill(255)]])
          socket.send(Buffer.from(bytes));
      }
      const probe = await show(page, server, 3);
      assert.equal(probe.connected, true);
    });
  });

  it('moves smoothly between states while a run plays', async () => {
    await withPage(scenes.land(), async (page, server) => {
      server.paused = false;
      const probe =
          await until(page, (p) => p.time_us > 1.5e6 && p.vehicles[0].trail.points >= 2, 'a trail that grows');
      const [x, y] = probe.bodies[0].position;
      // Interpolated positions stay within the chord of the circle: 33 ms at 0.63 m/s, on a busy machine up to 1.4 s.
      near(Math.hypot(x, y), 2, 0.05, 'radius of the circle');
      near(Math.atan2(y, x), 2 * Math.PI * probe.time_us / 20e6, 0.02, 'angle at the shown time');
    });
  });
});

describe('sound', () => {
  it('expands by the sound speed, as thick as it lasts', async () => {
    await withPage(scenes.underwater(), async (page, server) => {
      server.send({
        op: 'sounds',
        items: [{
          id: 7,
          source: 'auv1',
          position_m: [0, 0, -10],
          time_us: 1e6,
          duration_us: 20000,
          sound_speed_mps: 1500,
          kind: 'ping'
        }]
      });
      for (const after_s of [0.01, 0.03, 0.06]) {
        const probe = await show(page, server, 1 + after_s, false);
        assert.equal(probe.sounds.length, 1);
        near(probe.sounds[0].outer_m, 1500 * after_s, 0.005 * 1500 * after_s, 'outer radius');
        near(probe.sounds[0].inner_m, Math.max(0, 1500 * (after_s - 0.02)), 0.005 * 1500 * after_s, 'inner radius');
      }
    });
  });

  it('marks what became of it at each receiver, in a sign and a legend', async () => {
    await withPage(scenes.underwater(), async (page, server) => {
      await show(page, server, 2);
      const reception = (to, position_m, outcome) =>
          ({id: 1, to, position_m, time_us: 1.9e6, travel_s: 0.02, snr_dB: 9, outcome});
      server.send({
        op: 'receptions',
        items: [
          reception('auv2', [20, 12, -14], 'interference'), reception('auv3', [-18, 10, -8], 'interference'),
          reception('auv1', [0, 0, -10], 'half_duplex')
        ]
      });
      const probe = await until(page, (p) => p.marks.length === 3 && p.labels.length >= 6);
      // A mark hides no name.
      assert.deepEqual(
          probe.labels.filter((label) => !/^depth|^altitude|^\d/.test(label)).sort(),
          ['auv1', 'auv2', 'auv3', 'collision 9 dB', 'collision 9 dB', 'receiver was sending 9 dB']);
      assert.equal(probe.marks.filter((mark) => mark.outcome === 'interference').length, 2);
      assert.match(await text(page, '#legend'), /collision.*receiver was sending|receiver was sending.*collision/);
    });
  });
});

describe('estimates', () => {
  it('draws ellipsoids along the eigenvectors of the covariance', async () => {
    await withPage(scenes.underwater(), async (page, server) => {
      await show(page, server, 2);
      // R diag(4, 1, 0.25) R' with R: 30 degrees about z, so eigenvalues and axes are known.
      const c = Math.cos(Math.PI / 6), s = Math.sin(Math.PI / 6);
      const covariance_m2 = [4 * c * c + s * s, 3 * c * s, 0, 3 * c * s, 4 * s * s + c * c, 0, 0, 0, 0.25];
      server.send(
          {op: 'estimates', items: [{vehicle: 'auv1', time_us: 2e6, pose: [3, 4, -10, 1, 0, 0, 0], covariance_m2}]});
      const {estimates: [estimate]} = await until(page, (p) => p.estimates.length === 1 && p.estimates[0].error_m > 0);
      near(estimate.error_m, 5, 1e-3, 'error');
      const order = [0, 1, 2].sort((a, b) => estimate.axes_m[b] - estimate.axes_m[a]);
      [2, 1, 0.5].forEach((length_m, i) => near(estimate.axes_m[order[i]], length_m, 1e-6, `axis ${i}`));
      near(
          Math.abs(estimate.axes[0][order[0]] * c + estimate.axes[1][order[0]] * s), 1, 1e-6,
          'long axis at 30 degrees');
    });
  });
});

describe('paths', () => {
  const check = (page, id, on) => page.evaluate((option, to) => {
    document.getElementById(option).checked = to;
    document.getElementById(option).dispatchEvent(new Event('input'));
  }, id, on);

  it('of programs are drawn through their points, at their depth or at the height of the vehicle', async () => {
    await withPage(scenes.underwater(), async (page, server) => {
      await show(page, server, 2);
      server.send({
        op: 'paths',
        items: [
          {channel: 'auv1.path', vehicle: 'auv1', time_us: 1e6, points: [[0, 0, 10], [30, 5, 12.5]], loop: true},
          {channel: 'auv2.autopilot.cmd', vehicle: 'auv2', time_us: 2e6, points: [[1, 2, null], [3, 4, null]]},
          {channel: 'nobody.path', vehicle: 'nobody', time_us: 2e6, points: 'none'},
        ]
      });
      const {paths} = await until(page, (p) => p.paths.length === 2 && p.paths[1].points[0][2] < -13);
      assert.deepEqual(paths.map((path) => path.channel), ['auv1.path', 'auv2.autopilot.cmd']);
      const expected = [[[0, 0, -10], [30, 5, -12.5], [0, 0, -10]], [[1, 2, -13.95], [3, 4, -13.95]]];
      paths.forEach(({points}, i) => {
        assert.equal(points.length, expected[i].length);
        points.forEach((point, j) => point.forEach((x, k) => near(x, expected[i][j][k], 1e-3, `${i} ${j} ${k}`)));
      });
      // Back in time only the older one is left; switched off there is none.
      await show(page, server, 1.5);
      await until(page, (p) => p.paths.length === 1);
      await check(page, 'o-paths', false);
      await until(page, (p) => p.paths.length === 0);
      await check(page, 'o-paths', true);
      await until(page, (p) => p.paths.length === 1);
      server.send({op: 'paths', items: []});
      await until(page, (p) => p.paths.length === 0);
    });
  });
});

describe('layers', () => {
  it('in modules of their own are all listed', async () => {
    const folder = new URL('../../viewer/page/', import.meta.url);
    const textOf = (file) => readFile(new URL(file, folder), 'utf8');
    const list = await textOf('own_layers.js');
    for (const file of (await readdir(folder)).filter((name) => name.endsWith('.js')))
      if (/^export class Layer /m.test(await textOf(file))) assert.ok(list.includes(`import('./${file}')`), file);
  });
});

describe('water', () => {
  it('has the waves of the run in its shader, within 1 cm at 100 points', async () => {
    await withPage(scenes.underwater(), async (page) => {
      const points = [...Array(100).keys()].map((i) => [7.3 * i - 350, 250 * Math.sin(1.7 * i)]);
      for (const t_s of [0, 12.345, 86400]) {
        const heights = await page.evaluate((p, t_us) => window.shoal.waterHeights(p, t_us), points, t_s * 1e6);
        points.forEach(([x, y], i) => near(heights[i], scenes.elevation(scenes.WAVES, x, y, t_s), 0.01, `height ${i}`));
      }
    });
  });
});

describe('connection', () => {
  it('says that it is disconnected, and takes the new scene of a server that came back', async () => {
    const first = await new MockServer(scenes.land()).listen();
    const allowed = /ERR_CONNECTION_REFUSED|WebSocket connection to/;
    const page = await open(browser, `${first.url}#t=secret`, {allowed});
    try {
      await until(page, (p) => p.scene !== null);
      await show(page, first, 4);
      await first.close();
      const lost = await until(page, (p) => /disconnected since [1-9]/.test(p.banner));
      assert.match(lost.banner, /showing t = 4\.00 s/);
      const second = await new MockServer(scenes.surface()).listen(first.port);
      const back = await until(page, (p) => p.connected && p.scene.world === 'test_surface' && p.banner === '');
      assert.equal(back.vehicles.length, 3);
      assert.deepEqual(await faultsOf(page), []);
      await second.close();
    } finally {
      await page.close();
    }
  });

  it('says that a run has ended, and where its log is, not that the connection is lost', async () => {
    const server = await new MockServer(scenes.land()).listen();
    const page =
        await open(browser, `${server.url}#t=secret`, {allowed: /ERR_CONNECTION_REFUSED|WebSocket connection to/});
    try {
      await until(page, (p) => p.scene !== null);
      await show(page, server, 4);
      await server.end('duration', 'runs/a.lcm');
      const probe = await until(page, (p) => p.banner !== '');
      assert.equal(probe.banner, 'the run has ended (duration), showing t = 4.00 s; its log: runs/a.lcm');
      assert.ok(await page.$eval('#banner', (banner) => banner.classList.contains('calm')));
      assert.deepEqual(await faultsOf(page), []);
    } finally {
      await page.close();
    }
  });

  it('says that a frozen server does not answer', async () => {
    await withPage(scenes.land(), async (page, server) => {
      server.frozen = true;
      await until(page, (p) => /the server does not answer/.test(p.banner));
      server.frozen = false;
      await until(page, (p) => p.banner === '');
    });
  });

  it('shows a page that joins late what the others see', async () => {
    await withPage(scenes.land(), async (page, server) => {
      await show(page, server, 6);
      const late = await open(browser, `${server.url}#t=secret`);
      const probe = await until(late, (p) => p.time_us === 6e6);
      near(probe.bodies[0].position[0], 2 * Math.cos(0.6 * Math.PI), 1e-3, 'x');
      assert.deepEqual(await faultsOf(late), []);
      await late.close();
    });
  });

  it('acknowledges every state', async () => {
    await withPage(scenes.land(), async (page, server) => {
      server.paused = false;
      await until(page, (p) => p.frames > 12);
      const acknowledged = server.received.filter((message) => message.op === 'ack').map((message) => message.sequence);
      assert.ok(acknowledged.length > 5);
      assert.deepEqual(acknowledged, acknowledged.map((_, i) => acknowledged[0] + i));
    });
  });
});

describe('steering', () => {
  it('says what the run waits for, in the words of the server', async () => {
    const waits = 'waits 0.2 s for \'client\'';
    await withPage(scenes.land(), async (page, server) => {
      server.waits_for = waits;
      await page.waitForFunction(
          (words) => document.getElementById('status').textContent.split(' · ').includes(words), {}, waits);
    });
  });

  it('pauses, steps, changes the speed and rewinds a run', async () => {
    await withPage(scenes.land(), async (page, server) => {
      await show(page, server, 5);
      await page.click('#step10');
      await until(page, (p) => p.time_us === 5.1e6, 'ten steps of 10 ms');
      await page.keyboard.press('.');
      await until(page, (p) => p.time_us === 5.11e6, 'one step');
      await page.select('#speed', '4');
      await page.click('#play');
      await until(page, (p) => p.time_us > 5.3e6, 'playing');
      assert.equal(server.speed, 4);
      // A server that introduces itself again, as after --watch, does not change the choice.
      server.send({op: 'hello', version: 1, source: 'run', world: 'test_land', control: true});
      await page.waitForFunction(() => document.getElementById('speed').options.length > 3);
      assert.equal(await page.$eval('#speed', (select) => select.value), '4');
      await page.focus('#view');
      await page.keyboard.press(' ');
      await page.waitForFunction(() => document.getElementById('play').getAttribute('aria-label') === 'Continue');
      // Back to 2 s by the time line, after a confirmation.
      await page.$eval('#seek', (seek) => {
        seek.value = 2000;
        seek.dispatchEvent(new Event('input'));
      });
      assert.match(await text(page, '#rewind'), /Rewind to 2\.00 s/);
      await page.click('#rewind');
      await until(page, (p) => p.time_us === 2e6, 'rewound');
    });
  });

  it('is read-only without the token', async () => {
    await withPage(scenes.land(), async (page, server) => {
      assert.equal((await page.evaluate(() => window.shoal.probe())).control, false);
      assert.equal(await text(page, '#badge'), 'read-only');
      const disabled =
          await page.$$eval('#play, #step1, #step10, #speed, #seek', (all) => all.every((one) => one.disabled));
      assert.ok(disabled);
      await page.focus('#view');
      await page.keyboard.press(' ');
      await page.keyboard.press('.');
      await show(page, server, 1);
      assert.ok(server.received.every((message) => message.op !== 'control'));
    }, {fragment: '#t=wrong'});
  });

  it('seeks in a log', async () => {
    const script = {...scenes.land(), hello: {source: 'log', end_us: 60e6, name: 'a.lcm'}};
    await withPage(script, async (page, server) => {
      await page.$eval('#seek', (seek) => {
        seek.value = 30500;
        seek.dispatchEvent(new Event('input'));
        seek.dispatchEvent(new Event('change'));
      });
      await until(page, (p) => p.time_us === 30.5e6);
      await page.focus('#view');
      await page.keyboard.press(',');
      await until(page, (p) => p.time_us === 29.5e6, 'one second back');
      await page.click('#play');
      await until(page, (p) => p.time_us > 29.6e6, 'playing');
      assert.ok(server.received.some((message) => message.op === 'play' && message.paused === false));
    });
  });
});

describe('views', () => {
  it('selects by a click in the list, in the scene, and by keys', async () => {
    await withPage(scenes.land(), async (page, server) => {
      const probe = await show(page, server, 1);
      await page.click('#vehicles li:nth-child(2)');
      await until(page, (p) => p.selected === 'rover2');
      await page.mouse.click(...probe.vehicles[2].pixel);
      await until(page, (p) => p.selected === 'rover3');
      await page.focus('#view');
      await page.keyboard.press('[');
      await until(page, (p) => p.selected === 'rover2');
      await page.keyboard.press('Escape');
      await until(page, (p) => p.selected === null);
    });
  });

  it('finds vehicles by a part of their name', async () => {
    await withPage(scenes.thousand(), async (page) => {
      await page.type('#search', 'v99');
      const shown = await page.$$eval('#vehicles li', (items) => items.filter((item) => !item.hidden).length);
      assert.equal(shown, 11);  // v99, v990 to v999
      await page.keyboard.press('Enter');
      await until(page, (p) => p.selected === 'v99');
    });
  });

  it('shows pose, speed and depth of the selected vehicle', async () => {
    await withPage(scenes.underwater(), async (page, server) => {
      await page.evaluate(() => window.shoal.select('auv2'));
      for (let t_s = 0; t_s <= 2; t_s += 0.25) await show(page, server, t_s, false);
      const values = () => page.$$eval(
          '#values tr',
          (lines) => Object.fromEntries(lines.map((line) => [line.cells[0].textContent, line.cells[1].textContent])));
      const rows = await values();
      assert.equal(rows['x east, m'], '23.00');
      assert.equal(rows['depth, m'], '14.00');
      assert.equal(rows['speed, m/s'], '1.50');
      // Two poses on both sides of a jump give no speed.
      await show(page, server, 60);
      const after = await values();
      assert.equal(after['speed, m/s'], '–');
      assert.deepEqual(Object.values(after).filter((value) => /^-0[.0]*°?$/.test(value)), [], 'zeros have no sign');
    });
  });

  it('first shows all that moves, as large as the part of the page between the panels allows', async () => {
    // A room of 70 m with loose walls, as in erl_room.
    const script = scenes.land(), wall = (x, y, size_m) => ({
                                    name: `wall ${x} ${y}`,
                                    owner: '',
                                    kind: 'object',
                                    fixed: false,
                                    pose: scenes.at(x, y, 2),
                                    parts: [{shape: 'box', size_m, pose: scenes.at(0, 0, 0), material: 0}],
                                  });
    const walls =
        [wall(35, 0, [1, 70, 4]), wall(-35, 0, [1, 70, 4]), wall(0, 34.5, [68.9, 1, 4]), wall(0, -34.5, [68.9, 1, 4])];
    script.scene.bodies.push(...walls.map((body, i) => ({...body, id: script.scene.bodies.length + i})));
    const rovers = script.posesAt;
    script.posesAt = (t_s) => [...rovers(t_s), ...walls.map(({pose}) => pose)];
    await withPage(script, async (page, server) => {
      const {camera: {position, target, fov_deg}} = await show(page, server, 1);
      // All corners of the room by the pinhole model: inside the free part, which they nearly fill on one side.
      const minus = (a, b) => a.map((x, i) => x - b[i]), dot = (a, b) => a.reduce((s, x, i) => s + x * b[i], 0);
      const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
      const unit = (a) => a.map((x) => x / Math.hypot(...a));
      const ahead = unit(minus(target, position)), right = unit(cross(ahead, [0, 0, 1])), up = cross(right, ahead);
      const focal_px = 450 / Math.tan(fov_deg * Math.PI / 360);
      // Panels of 220 and 300 px, 10 px from the edges: what is free about the middle is 2 x (720 - 310) px wide.
      const free_px = [820, 900 - 2 * 40], used = [0, 0];
      for (const x of [-35.5, 35.5])
        for (const y of [-35, 35])
          for (const z of [0, 4]) {
            const d = minus([x, y, z], position);
            used[0] = Math.max(used[0], 2 * focal_px * Math.abs(dot(d, right)) / dot(d, ahead) / free_px[0]);
            used[1] = Math.max(used[1], 2 * focal_px * Math.abs(dot(d, up)) / dot(d, ahead) / free_px[1]);
          }
      assert.ok(Math.max(...used) > 0.85 && used[0] <= 1 && used[1] <= 1, `shares used: ${used}`);
      assert.ok(Math.hypot(...minus(position, target)) < 150, `from ${position}`);
    }, {width: 1440, height: 900});
  });

  it('never orbits below the ground', async () => {
    await withPage(scenes.land(), async (page) => {
      await page.evaluate(() => window.shoal.setView('orbit,10,0,-5,0,0,0'));
      const {camera} = await until(page, (p) => p.camera.position[2] > 0);
      near(camera.position[2], 0.05 + 0.02 * Math.hypot(10, 5), 0.02, 'height at the lowest');
    });
    // Of a terrain, whose samples are 4 m apart.
    await withPage(scenes.underwater(), async (page) => {
      await page.evaluate(() => window.shoal.setView('orbit,40,0,-60,0,0,-10'));
      const {camera: {position: [x, y, z]}} = await until(page, (p) => p.camera.position[2] > -40);
      const ground = -30 + 4 * Math.sin(x / 24) * Math.cos(y / 31) + 2.5 * Math.sin((x + 2 * y) / 17);
      assert.ok(z > ground - 0.5, `${z} above ${ground}`);
    });
  });

  it('keeps a followed vehicle in the middle, and the offset that the user chose', async () => {
    await withPage(scenes.land(), async (page, server) => {
      await page.evaluate(() => window.shoal.select('rover1'));
      await page.focus('#view');
      await page.keyboard.press('f');
      let offset = null;
      for (let t_s = 0.5; t_s <= 6; t_s += 0.5) {
        const probe = await show(page, server, t_s, false);
        const [x, y] = probe.vehicles[0].pixel;
        near(x, 480, 0.02 * 960, 'pixel x');
        near(y, 300, 0.02 * 600, 'pixel y');
        const now = probe.camera.position.map((value, i) => value - probe.vehicles[0].position[i]);
        offset ??= now;
        now.forEach((value, i) => near(value, offset[i], 0.02, `offset ${i}`));
      }
    });
  });

  it('turns with a chased vehicle', async () => {
    await withPage(scenes.land(), async (page, server) => {
      await page.evaluate(() => window.shoal.select('rover1'));
      await page.focus('#view');
      await page.keyboard.press('c');
      for (let t_s = 0.5; t_s <= 5; t_s += 0.5) {
        const probe = await show(page, server, t_s, false);
        const [x, y] = probe.camera.position.map((value, i) => value - probe.vehicles[0].position[i]);
        const yaw = 2 * Math.PI * t_s / 20 + Math.PI / 2;
        // Behind the vehicle: the offset points against its heading.
        near(x * Math.cos(yaw) + y * Math.sin(yaw), -Math.hypot(x, y), 0.02, 'behind');
      }
    });
  });

  it('chases a vehicle from ten times its radius, or from where the user came closer', async () => {
    await withPage(scenes.land(), async (page) => {
      await page.evaluate(() => {
        window.shoal.select('rover1');
        window.shoal.setView('orbit,20,0,10,2,0,0');
      });
      await page.focus('#view');
      await page.keyboard.press('c');
      const distance_m = ({camera, vehicles: [{position}]}) =>
          Math.hypot(...camera.position.map((value, i) => value - position[i]));
      let probe = await until(page, (p) => p.camera.mode === 'chase');
      const near_m = 10 * probe.vehicles[0].radius_m;
      near(distance_m(probe), near_m, 0.01 * near_m, 'distance');
      // Closer in another mode: that distance stays.
      await page.keyboard.press('f');
      for (let i = 0; i < 4; ++i) await page.keyboard.press('+');
      await page.keyboard.press('c');
      probe = await until(page, (p) => p.camera.mode === 'chase');
      near(distance_m(probe), 0.8 ** 4 * near_m, 0.01 * near_m, 'distance that the user chose');
    });
  });

  it('keeps the selected vehicle in the view from above', async () => {
    await withPage(scenes.land(), async (page, server) => {
      await page.evaluate(() => {
        window.shoal.select('rover1');
        window.shoal.setView('orbit,40,-8,6,40,0,0');
      });
      await page.focus('#view');
      await page.keyboard.press('2');
      const rover = (p) => p.vehicles[0].pixel;
      let probe =
          await until(page, (p) => p.camera.mode === 'top' && p.vehicles[0].pixel !== null, 'the rover in view');
      near(rover(probe)[0], 480, 2, 'pixel x');
      near(rover(probe)[1], 300, 2, 'pixel y');
      // Half a circle of 4 m moves it out of a view of 9 m, which moves along; north stays up.
      for (const t_s of [2, 6, 10]) {
        probe = await show(page, server, t_s);
        near(rover(probe)[0], 480, 2, `pixel x at ${t_s} s`);
        near(rover(probe)[1], 300, 2, `pixel y at ${t_s} s`);
      }
      near(probe.camera.position[0], probe.vehicles[0].position[0], 0.01, 'above it');
      // Another one that is in view already moves nothing.
      await page.evaluate(() => window.shoal.setView('top,0,0,40,0,0,0'));
      await page.keyboard.press(']');
      probe = await until(page, (p) => p.selected === 'rover2');
      near(probe.camera.position[0], 0, 0.01, 'x of the view');
    });
  });

  it('looks along the vehicle, and through its camera', async () => {
    await withPage(scenes.land(), async (page, server) => {
      await page.evaluate(() => window.shoal.select('rover1'));
      await page.click('#first');
      let probe = await show(page, server, 20);  // a whole turn
      const ahead = (p) => p.camera.target.map((value, i) => value - p.camera.position[i]);
      near(ahead(probe)[1], 1, 1e-3, 'rover1 starts northward');
      await page.click('#devices button');
      probe = await until(
          page, (p) => p.camera.mode === 'device' && Math.abs(p.camera.fov_deg - 51.566) < 0.01,
          'the field of view of the camera: 0.9 rad');
      [2, 0.25, 0.44].forEach((value, i) => near(probe.camera.position[i], value, 2e-3, `position ${i}`));
    });
  });

  it('takes the view from the address and keeps the token in it', async () => {
    await withPage(scenes.land(), async (page) => {
      const probe = await until(page, (p) => p.selected === 'rover2');
      [5, 6, 7].forEach((value, i) => near(probe.camera.position[i], value, 0.01, `position ${i}`));
      await page.waitForFunction(() => location.hash.includes('view=orbit'));
      await page.evaluate(() => window.shoal.select('rover3'));
      await page.waitForFunction(() => location.hash.includes('select=rover3'));
      assert.match(await page.evaluate(() => location.hash), /^#t=secret&/);
    }, {fragment: '#t=secret&view=orbit,5,6,7,0,0,0&select=rover2'});
  });

  it('measures between two points', async () => {
    await withPage(scenes.land(), async (page, server) => {
      await show(page, server, 1);
      await page.evaluate(() => window.shoal.setView('top,0,0,20,0,0,0'));
      await page.focus('#view');
      await page.keyboard.press('m');
      await page.mouse.click(480, 300);
      await page.mouse.click(580, 300);
      await page.waitForFunction(() => window.shoal.probe().tape !== '');
      const {tape, camera} = await page.evaluate(() => window.shoal.probe());
      // From the crate (0.7 m high) in the middle to the ground 100 pixels to the right.
      const meter_px = 300 / Math.tan(camera.fov_deg * Math.PI / 360) / camera.position[2];
      const level_m = Number(/level ([\d.]+)/.exec(tape)[1]);
      near(level_m, 100 / meter_px, 0.05, 'distance');
      near(Number(/up ([-\d.]+)/.exec(tape)[1]), -0.7, 0.01, 'height');
    });
  });
});

describe('safety and reach', () => {
  it('shows names that are markup as text', async () => {
    const script = scenes.hostile();
    await withPage(script, async (page, server) => {
      await page.evaluate((name) => window.shoal.select(name), script.name);
      server.send({op: 'events', items: [{time_us: 0, kind: 'event', who: script.name, text: script.name}]});
      server.send({
        op: 'scores',
        metrics: [{name: script.name, figures: {[script.name]: 1}}],
        rules: [{rule: script.name, holds: true}]
      });
      server.send({op: 'error', text: script.name});
      await show(page, server, 1);
      assert.equal(await text(page, '#name'), script.name);
      assert.equal(await page.$$eval('img', (images) => images.length), 0);
      assert.ok(!(await page.title()).startsWith('owned'));
    });
  });

  it('reaches every control by Tab, each with a name', async () => {
    await withPage(scenes.land(), async (page) => {
      await page.evaluate(() => window.shoal.select('rover1'));
      const controls = await page.evaluate(
          () => [...document.querySelectorAll('button, input, select, a[href], [tabindex="0"]')]
                    .filter((one) => !one.disabled && one.checkVisibility())
                    .map((one) => {
                      one.dataset.number = String(document.querySelectorAll('[data-number]').length);
                      const label = one.getAttribute('aria-label') || one.textContent.trim() ||
                          one.labels?.[0]?.textContent.trim();
                      return {number: one.dataset.number, name: label || one.title || one.id, named: Boolean(label)};
                    }));
      assert.ok(controls.length > 20);
      assert.deepEqual(controls.filter((one) => !one.named), []);
      const reached = new Set();
      for (let i = 0; i < controls.length + 5; ++i) {
        await page.keyboard.press('Tab');
        reached.add(await page.evaluate(() => document.activeElement.dataset.number));
      }
      assert.deepEqual(controls.filter((one) => !reached.has(one.number)).map((one) => one.name), []);
    });
  });

  it('fits a phone without sideways scrolling', async () => {
    await withPage(scenes.land(), async (page) => {
      for (const open_panel of [null, '#fold-left', '#fold-left', '#tab-scores', '#fold-right', '#show']) {
        if (open_panel) await page.click(open_panel);
        const out = await page.evaluate(
            () => [...document.querySelectorAll('body *')]
                      .filter((one) => one.checkVisibility())
                      .filter((one) => {
                        const box = one.getBoundingClientRect();
                        return one.id !== 'skip' && (box.right > innerWidth + 1 || box.left < -1);
                      })
                      .map((one) => one.id || one.className || one.tagName));
        assert.deepEqual(out, [], `after ${open_panel}`);
      }
    }, {width: 390, height: 844});
  });

  it('has all tabs and the chip of the vehicles side by side on a phone', async () => {
    for (const width of [320, 360, 390]) {
      await withPage({...scenes.thousand(), forms: FORMS}, async (page) => {
        await page.waitForFunction(() => !document.getElementById('tab-act').hidden);
        const hidden = await page.evaluate(() => ['fold-left', 'count', 'tab-vehicle'].filter((id) => {
          const {left, right, top, bottom} = document.getElementById(id).getBoundingClientRect();
          const at = document.elementFromPoint((left + right) / 2, (top + bottom) / 2);
          return at?.id !== id;
        }));
        assert.deepEqual(hidden, [], `${width} px`);
        // A tab opens its sheet over the whole width, and the button folds it.
        await page.click('#tab-scores');
        near(await page.$eval('#right', (right) => right.getBoundingClientRect().width), width - 12, 1, 'sheet');
        await page.click('#fold-right');
        await page.click('#fold-left');
        near(await page.$eval('#left', (left) => left.getBoundingClientRect().width), width - 12, 1, 'sheet');
      }, {width, height: 740});
    }
  });

  it('changes between light and dark', async () => {
    await withPage(scenes.land(), async (page) => {
      assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), 'dark');
      await page.click('#theme');
      assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), 'light');
    }, {dark: true});
  });

  it('is small', async () => {
    const server = await new MockServer(scenes.land()).listen();
    const page = await open(browser, server.url);
    await until(page, (p) => p.scene !== null);
    const paths = [...new Set(server.requests)];
    await page.close();
    await server.close();
    let bytes = 0, packed = 0;
    for (const path of paths) {
      const data = await readFile(new URL(`../../viewer/page${path === '/' ? '/index.html' : path}`, import.meta.url));
      bytes += data.length;
      packed += gzipSync(data).length;
    }
    console.log(`page: ${paths.length} files, ${bytes} bytes, ${packed} with gzip`);
    assert.ok(paths.length <= 60, `${paths.length} files`);
    assert.ok(bytes <= 900e3, `${bytes} bytes`);
    assert.ok(packed <= 275e3, `${packed} bytes with gzip`);
  });
});

describe('load', () => {
  it('draws a thousand moving vehicles', async () => {
    await withPage(scenes.thousand(), async (page, server) => {
      server.paused = false;
      const probe = await until(page, (p) => p.time_us > 3e6 && p.frames > 20, 'a thousand vehicles');
      console.log(`1000 vehicles: ${probe.cpu_ms.toFixed(1)} ms of the page's processor time per frame, ${
          probe.draw_calls} draw calls, ${(probe.frames / probe.time_us * 1e6).toFixed(0)} frames/s${
          probe.software ? ' (no GPU)' : ''}`);
      assert.equal(probe.vehicles.length, 1000);
      assert.ok(probe.draw_calls < 40, `${probe.draw_calls} draw calls`);
      // At a time of a state: between two the page draws straight ways, and a busy machine makes them long.
      server.paused = true;
      const i = 537,
            again = setInterval(() => server.show(4e6, true), 500);  // none is sent to a page with two unanswered
      const {vehicles} = await until(page, (p) => p.time_us === 4e6).finally(() => clearInterval(again));
      near(vehicles[i].position[0], 6.5 * (i % 32) - 100 + Math.sin(4 + i), 0.01, 'x of one of them');
    }, {width: 640, height: 480});
  });
});
