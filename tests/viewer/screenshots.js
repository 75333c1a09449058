// SPDX-License-Identifier: BSD-3-Clause
// Images of the page for people: node screenshots.js [FOLDER] [NAME ...]
import {until} from './browser.js';
import * as scenes from './scenes.js';
import {takeShots} from './take_shots.js';

const ESTIMATES = [
  {
    vehicle: 'auv1',
    time_us: 2e6,
    pose: [1.5, 1.0, -10.3, 1, 0, 0, 0],
    covariance_m2: [1.2, 0.5, 0, 0.5, 0.8, 0, 0, 0, 0.05]
  },
  {
    vehicle: 'auv2',
    time_us: 2e6,
    pose: [24, 10.5, -14.1, 1, 0, 0, 0],
    covariance_m2: [2.5, -0.9, 0, -0.9, 1.2, 0, 0, 0, 0.08]
  },
];
const sound = (time_us) => [{
  id: 1,
  source: 'auv1',
  position_m: [0, 0, -10],
  time_us,
  duration_us: 4000,
  sound_speed_mps: 1500,
  source_level_dB: 180,
  centre_Hz: 25000,
  bandwidth_Hz: 5000,
  bytes: 32,
  to: '',
  kind: 'message'
}];
const receptions = (time_us) =>
    [{
      id: 1,
      to: 'auv2',
      position_m: [23, 12, -14],
      time_us,
      travel_s: 0.017,
      snr_dB: 14.2,
      outcome: 'none',
      delivered: true
    },
     {
       id: 1,
       to: 'auv3',
       position_m: [-18, 12, -8],
       time_us,
       travel_s: 0.015,
       snr_dB: 3.1,
       outcome: 'interference',
       delivered: false
     },
];
const SCORES = {
  op: 'scores',
  time_us: 0,
  metrics: [{name: 'auv1_error', figures: {rms_m: 1.234, max_m: 3.21}}],
  rules: [
    {rule: 'auv1_error.rms_m < 2', holds: true, value: 1.234, bound: 2},
    {rule: 'contacts == 0', holds: false, value: 2, bound: 0}
  ]
};

/** What to take: scene, size, and what to do before. */
const SHOTS = {
  land: {script: scenes.land(), select: 'rover1', play_s: 4},
  land_dark: {script: scenes.land(), dark: true, select: 'rover2', play_s: 4, keys: ['f']},
  land_wide: {script: scenes.land(), play_s: 1, view: 'orbit,-14,-30,9,0,0,0'},
  underwater: {script: scenes.underwater(), select: 'auv1', time_us: 2e6, send: true},
  underwater_near:
      {script: scenes.underwater(), select: 'auv1', time_us: 2e6, send: true, view: 'orbit,-6,-7,-7,1,1,-10'},
  underwater_above:
      {script: scenes.underwater(), time_us: 2e6, send: true, view: 'orbit,-40,-60,35,0,0,-12', dark: true},
  surface: {script: scenes.surface(), select: 'boat1', play_s: 2, view: 'orbit,-8,-9,4,2,1,0'},
  surface_low: {script: scenes.surface(), play_s: 1, view: 'orbit,-7,-4,1.2,3,2,0.3'},
  surface_below: {script: scenes.surface(), play_s: 1, view: 'orbit,-4,-9,-4,3,0,-0.5'},
  phone: {script: scenes.underwater(), width: 390, height: 844, time_us: 2e6, send: true},
  phone_open: {script: scenes.land(), width: 390, height: 844, play_s: 1, select: 'rover1', keys: [], open: true},
  thousand: {script: scenes.thousand(), play_s: 1},
  options: {script: scenes.land(), play_s: 1, keys: ['v'], select: 'rover1', dark: true},
  help: {script: scenes.land(), play_s: 0.5, keys: ['?']},
};

await takeShots(SHOTS, async (page, server, shot) => {
  if (shot.select) await page.evaluate((one) => window.shoal.select(one), shot.select);
  if (shot.shadows !== false) await page.evaluate(() => document.getElementById('o-shadows').click());
  for (const key of shot.keys ?? []) await page.keyboard.press(key);
  if (shot.open) await page.click('#fold-right');
  server.send(SCORES);
  if (shot.play_s) {
    server.paused = false;
    await until(page, `(p) => p.time_us >= ${shot.play_s * 1e6}`);
    server.paused = true;
    server.show(server.time_us, false);
  } else {
    // Some seconds in steps, for the trails.
    for (let t_us = 0; t_us <= shot.time_us; t_us += 1e5) {
      server.show(t_us, false);
      await until(page, `(p) => p.time_us === ${t_us}`);
    }
  }
  if (shot.view) await page.evaluate((view) => window.shoal.setView(view), shot.view);
  if (shot.send) {
    server.send({op: 'estimates', items: ESTIMATES});
    server.send({op: 'sounds', items: sound(2e6 - 15000)});
    server.send({op: 'receptions', items: receptions(2e6 - 500)});
    server.send(
        {op: 'events', items: [{time_us: 1.5e6, kind: 'fault', who: 'auv3/dvl', text: 'dvl of auv3 is silent'}]});
  }
});
