// SPDX-License-Identifier: BSD-3-Clause
// Images of the panels of data for people: node data_screenshots.js [FOLDER] [NAME ...]
import * as scenes from './scenes.js';
import {takeShots} from './take_shots.js';

const CHANNELS = [
  ['rover1.front', 'shoal.image_t', 'rover1', 100, 9e6],
  ['rover1.lidar', 'shoal.planar_lidar_t', 'rover1', 200, 4e5],
  ['rover1.pose', 'shoal.pose_t', 'rover1', 900, 90000],
  ['auv1.sonar', 'shoal.sonar_image_t', 'auv1', 20, 9e5],
  ['auv1.side', 'shoal.side_scan_t', 'auv1', 100, 1e5],
  ['auv1.clock.truth', 'shoal.clock_status_t', 'auv1', 10, 500],
  ['auv2.clock', 'shoal.clock_status_t', 'auv2', 10, 500],
  ['auv1.modem', 'shoal.acoustic_received_t', 'auv1', 12, 600],
  ['sim.bodies', 'shoal.sim_bodies_t', '', 300, 3e6],
];

/** A log whose fields are waves of several periods. */
function log() {
  return {
    ...scenes.land(),
    hello: {source: 'log', start_us: 0, end_us: 120e6, name: 'a.lcm'},
    seriesAt: (channel, field, t_s) =>
        field.length * Math.sin(t_s / field.length) + (field.includes('z') ? t_s / 9 : 0),
  };
}

function lidarScan(server) {
  const beams = 181;
  // Walls of the scene by rays from rover1 at time 0: at (2.12, 0, 0.44), heading north.
  const ranges = Float32Array.from({length: beams}, (_, i) => {
    const angle = Math.PI / 2 - Math.PI / 2 + i * Math.PI / 180, dx = Math.cos(angle), dy = Math.sin(angle);
    return Math.min(dy > 0.01 ? (5.9 - 0.12) / dy : 30, dx < -0.01 ? 7.9 / -dx : 30);
  });
  return server.publishOnceWanted(
      'rover1.lidar', 'planar_lidar_t', 0, {utime: 0, ranges, rad0: -Math.PI / 2, radstep: Math.PI / 180});
}

/** The land with a lidar that sees its walls. */
function far() {
  const script = scenes.land(), [lidar] = script.scene.vehicles[0].devices;
  lidar.field_of_view = {...lidar.field_of_view, range_m: 30};
  return script;
}

/** A ramp with a disc, as an `image_t`. */
function camera(kind) {
  const width = 160, height = 120, step = kind === 'depth' ? 4 : 3, data = Buffer.alloc(step * width * height);
  for (let v = 0; v < height; ++v)
    for (let u = 0; u < width; ++u) {
      const disc = Math.hypot(u - 90, v - 60) < 30, i = v * width + u;
      if (kind === 'depth')
        data.writeFloatLE(disc ? 2.5 : v > 50 ? 200 / (v - 40) : Infinity, 4 * i);
      else
        [disc ? 220 : u, disc ? 90 : 140, disc ? 60 : 255 - 2 * v].forEach(
            (x, k) => data.writeUInt8(Math.max(0, x), 3 * i + k));
    }
  return {
    utime: 0,
    width,
    height,
    row_stride: step * width,
    pixelformat: kind === 'depth' ? 842221382 : 859981650,
    size: data.length,
    data: new Uint8Array(data),
    metadata: kind === 'depth' ? [{key: 'unit', n: 1, value: [109]}] : [],
  };
}

async function sonars(server) {
  const nbins = 120, nbeams = 96;
  const data = Uint8Array.from({length: nbins * nbeams}, (_, i) => {
    const bin = Math.floor(i / nbeams), beam = i % nbeams;
    const wall = Math.abs(bin - 80 + 8 * Math.sin(beam / 15)) < 3, spot = Math.hypot(bin - 40, beam - 60) < 4;
    return wall ? 200 : spot ? 250 : 30 + (bin * 7 + beam * 13) % 40;
  });
  await server.publishOnceWanted('auv1.sonar', 'sonar_image_t', 1e6, {
    nbins,
    nbeams,
    range_min_m: 0.5,
    range_max_m: 30,
    rad0: -1.05,
    radstep: 2.1 / 95,
    floor_dB: 40,
    dB_per_count: 0.5,
    data
  });
  for (let ping = 0; ping < 200; ++ping) {
    const side = (offset) => Uint8Array.from(
        {length: 150},
        (_, bin) =>
            (bin < 25 + 5 * Math.sin(ping / 20) ?
                 10 :
                 120 + 60 * Math.sin(bin / 9 + offset + ping / 30) + (bin * 31 + ping * 17) % 40));
    await server.publishOnceWanted('auv1.side', 'side_scan_t', 1e6 + ping * 1e5, {
      range_min_m: 0,
      range_max_m: 50,
      floor_dB: 20,
      dB_per_count: 0.4,
      nbins: 150,
      port: side(0),
      starboard: side(2)
    });
  }
}

function ranging() {
  const script = scenes.underwater(), [auv1, auv2] = script.scene.vehicles;
  auv1.devices[0].channels = ['auv1.dvl'];
  auv1.devices.push({name: 'usbl', type: 'usbl', body: 0, pose: scenes.at(0, 0, 0.2), channels: ['auv1.usbl']});
  auv2.devices.push({name: 'answer', type: 'transponder', body: 1, pose: scenes.at(0, 0, 0.2), channels: []});
  return script;
}

async function clocks(server) {
  const status = {disciplined: true, since_fix_s: 0.4, estimated_std_s: 1e-5, error_s: 2.1e-5, rate_error: 3.2e-7};
  await server.publishOnceWanted('auv1.clock.truth', 'clock_status_t', 1e6, status);
  await server.publishOnceWanted(
      'auv2.clock', 'clock_status_t', 1e6,
      {...status, disciplined: false, since_fix_s: 831.2, error_s: null, rate_error: null, estimated_std_s: 0.0031});
}

function receptions(server) {
  const names = ['auv1', 'auv2', 'auv3'];
  const items = names.flatMap(
      (from, i) =>
          names.filter((to) => to !== from)
              .map(
                  (to, k) =>
                      ({from, to, sent: 40, received: 40 - 9 * i - 5 * k, lost: {noise: 5 * k, interference: 9 * i}})));
  server.sendPairs(items, 4e6);
  server.sendChannels(
      4e6, CHANNELS.map(([name, type, vehicle, count, bytes]) => [name, type, vehicle, 2 * count, 2 * bytes]));
}

const SHOTS = {
  plots: {
    script: log(),
    fragment:
        '&select=rover1&data=plots&plots=rover1.pose/pos[0],rover1.pose/speed_mps,rover1.pose/pos_z_m;rover1.imu/gyro_z_radps',
    run: (server) => server.show(40e6)
  },
  lidar: {script: far(), fragment: '&select=rover1&view=orbit,-1,-9,6,0,2,0', run: lidarScan},
  camera: {
    script: scenes.land(),
    dark: true,
    fragment: '&data=images&images=rover1.front,rover1.depth',
    run: async (server) => {
      await server.publishOnceWanted('rover1.front', 'image_t', 0, camera('rgb'));
      await server.publishOnceWanted('rover1.depth', 'image_t', 0, camera('depth'));
    }
  },
  sonar: {script: scenes.underwater(), fragment: '&data=images&images=auv1.sonar,auv1.side', run: sonars},
  ranges: {
    script: ranging(),
    fragment: '&select=auv1&view=orbit,-18,-26,4,6,4,-12',
    run: async (server) => {
      await server.publishOnceWanted(
          'auv1.dvl', 'dvl_t', 0, {utime: 0, beam_range_m: [21, 23, 22, 20], beam_valid: [true, true, true, true]});
      await server.publishOnceWanted(
          'auv1.usbl', 'usbl_t', 0, {utime: 0, target: 'auv2/answer', range_m: 24.5, position_m: [20, 13.2, -5]});
    }
  },
  clocks: {script: scenes.underwater(), fragment: '&data=clocks', run: clocks},
  traffic: {script: scenes.underwater(), fragment: '&data=traffic&select=auv1', run: receptions},
  water: {script: scenes.underwater(), fragment: '&data=water', run: () => {}},
  show: {script: scenes.land(), fragment: '', run: () => {}, click: '#show'},
  phone_plots: {
    script: log(),
    width: 390,
    height: 844,
    fragment: '&data=plots&plots=rover1.pose/pos[0],rover1.pose/speed_mps',
    run: () => {}
  },
  phone_traffic: {script: scenes.underwater(), width: 390, height: 844, fragment: '&data=traffic', run: receptions},
};

await takeShots(SHOTS, async (page, server, shot) => {
  server.sendChannels(2e6, CHANNELS);
  await shot.run(server);
  if (shot.click) await page.click(shot.click);
  // Long enough for all panels to draw.
  await new Promise((resolve) => {
    setTimeout(resolve, 2500);
  });
});
