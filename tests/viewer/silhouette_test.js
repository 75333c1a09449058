// SPDX-License-Identifier: BSD-3-Clause
// Does the page draw each body where `shoal snap` draws it?  Every shipped world at its start, from two places: close
// to the first vehicle, and from far enough to see all vehicles.
import assert from 'node:assert/strict';
import {mkdtemp, readdir, readFile, rm} from 'node:fs/promises';
import {tmpdir} from 'node:os';
import {basename, join} from 'node:path';
import {after, before, describe, it} from 'node:test';

import {faultsOf, launch, open, until} from './browser.js';
import {readPng} from './png.js';
import {ROOT, serve, shoal} from './program.js';

const SIZE = {
  width: 320,
  height: 240
},
      FOV_DEG = 60, SHARE_MIN = 0.95;
const worlds = process.env.SHOAL_WORLDS?.split(':') ??
    (await readdir(join(ROOT, 'worlds'))).filter((name) => name.endsWith('.yaml')).map((name) => join('worlds', name));
let browser, folder;

/** Image of snap, as a text for each pixel: the color of its label; '': nothing. */
async function labelsOf(world, {eye, look}) {
  const out = join(folder, 'labels.png');
  await shoal(
      'snap', world, `--eye=${eye.join()}`, `--look=${look.join()}`, '--fov', String(FOV_DEG), '--size',
      `${SIZE.width}x${SIZE.height}`, '--image', 'segmentation_vehicles', '--out', out);
  const {data, channels} = readPng(await readFile(out));
  return Array.from({length: SIZE.width * SIZE.height}, (_, i) => {
    const color = data.subarray(i * channels, i * channels + 3).toString('hex');
    return color === '000000' ? '' : color;
  });
}

/** Bodies of the page, as a text for each pixel: the vehicle, or the name of the object; '': nothing. */
async function ownersOf(page, view, bodies) {
  const ids = await page.evaluate((expected) => window.shoal.bodyMask(expected), {...view, fov_deg: FOV_DEG, ...SIZE});
  return ids.map((id) => (id === 0 ? '' : bodies[id - 1].owner || bodies[id - 1].name));
}

/**
 * Shares of pixels with the same thing on both sides, of those with something on either side: of all, and without the
 * ground.  The label of an owner is the one that best of its pixels have.
 */
function compare(owners, labels, ground) {
  const common = new Map();
  owners.forEach((owner, i) => {
    if (!owner) return;
    if (!common.has(owner)) common.set(owner, new Map());
    const counts = common.get(owner);
    counts.set(labels[i], (counts.get(labels[i]) ?? 0) + 1);
  });
  const labelOf = new Map([...common].map(([owner, counts]) => {
    counts.delete('');
    return [owner, [...counts].sort((a, b) => b[1] - a[1])[0]?.[0]];
  }));
  const groundLabels = new Set([...ground].map((owner) => labelOf.get(owner)));
  const share = (skip) => {
    let same = 0, either = 0;
    owners.forEach((owner, i) => {
      const here = owner !== '' && !(skip && ground.has(owner));
      const there = labels[i] !== '' && !(skip && groundLabels.has(labels[i]));
      if (here || there) ++either;
      if (here && there && labelOf.get(owner) === labels[i]) ++same;
    });
    return {share: either ? same / either : 1, pixels: either};
  };
  return {all: share(false), entities: share(true)};
}

const DIRECTIONS = [[-0.55, -0.75, 0.5], [0.75, -0.55, 0.5], [0.55, 0.75, 0.5], [-0.75, 0.55, 0.5], [0.1, 0, 1]];

/** A place to look from, in direction i. */
function viewFrom(look, distance_m, i) {
  const length = Math.hypot(...DIRECTIONS[i]);
  return {
    look: look.map((x) => +x.toFixed(3)),
    eye: look.map((x, k) => +(x + DIRECTIONS[i][k] * distance_m / length).toFixed(3)),
  };
}

/** Place close to a vehicle: of several the one that shows the greatest part of it. */
async function closeView(page, vehicle, bodies, ground) {
  let best = null, shown = -1;
  for (let i = 0; i < DIRECTIONS.length && shown < 2000; ++i)
    for (const times of [4, 2]) {
      const view = viewFrom(vehicle.position, times * vehicle.radius_m, i);
      const pixels = (await ownersOf(page, view, bodies)).filter((owner) => owner !== '' && !ground.has(owner)).length;
      if (pixels > shown) [best, shown] = [view, pixels];
      if (shown >= 2000) break;
    }
  return best;
}

/** Place from which all vehicles are in view. */
function farView(vehicles) {
  const points = vehicles.map((one) => one.position);
  const middle = [0, 1, 2].map((i) => points.reduce((sum, p) => sum + p[i], 0) / points.length);
  const reach_m =
      Math.max(...points.map((p) => Math.hypot(...p.map((x, i) => x - middle[i])))) + 2 * vehicles[0].radius_m;
  return viewFrom(middle, 2.2 * reach_m, 0);
}

before(async () => {
  browser = await launch();
  folder = await mkdtemp(join(tmpdir(), 'silhouettes-'));
});
after(async () => {
  await browser?.close();
  await rm(folder, {recursive: true});
});

describe('silhouettes', () => {
  for (const world of worlds)
    it(basename(world, '.yaml'), async () => {
      const server = await serve('run', world, '--view', '--view-port', '0', '--bus', 'none', '--paused', '--quiet');
      const page = await open(browser, server.url, SIZE);
      try {
        const probe = await until(page, (p) => p.scene !== null && p.placed && p.frames > 0, 'the first frame');
        const bodies = await page.evaluate(() => window.shoal.bodies());
        const isGround = (body) => body.parts.some((part) => ['plane', 'terrain'].includes(part.shape));
        const ground = new Set(bodies.filter(isGround).map((body) => body.owner || body.name));
        const close = await closeView(page, probe.vehicles[0], bodies, ground);
        for (const [name, view] of Object.entries({close, far: farView(probe.vehicles)})) {
          const result = compare(await ownersOf(page, view, bodies), await labelsOf(world, view), ground);
          const text =
              `${name}: ${(100 * result.all.share).toFixed(2)} % of ${result.all.pixels} pixels, without the ground ${
                  (100 * result.entities.share).toFixed(2)} % of ${result.entities.pixels}`;
          console.log(`${basename(world)}, ${text}`);
          assert.ok(result.all.share >= SHARE_MIN, text);
          if (name === 'close') assert.ok(result.entities.pixels > 500 && result.entities.share >= SHARE_MIN, text);
        }
        assert.deepEqual(await faultsOf(page), []);
      } finally {
        await page.close();
        await server.end();
      }
    });
});
