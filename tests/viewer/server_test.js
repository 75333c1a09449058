// SPDX-License-Identifier: BSD-3-Clause
// The live page of a running server: SHOAL_VIEW_URL, set by tools/test_page --server.
import assert from 'node:assert/strict';
import {after, before, it} from 'node:test';

import {faultsOf, launch, open, until} from './browser.js';

const url = process.env.SHOAL_VIEW_URL;
let browser;

before(async () => {
  browser = await launch();
});
after(async () => {
  await browser.close();
});

it('shows a scene that moves, and nothing goes wrong', async () => {
  const page = await open(browser, url);
  const first = await until(page, (p) => p.scene !== null && p.frames > 1, 'the first frame');
  assert.ok(first.bodies.length > 0);
  const moved = await until(page, `(p) => p.time_us > ${first.time_us}`, 'a later time');
  console.log(`${moved.scene.world}: ${moved.bodies.length} bodies, ${moved.vehicles.length} vehicles, ${
      moved.cpu_ms.toFixed(1)} ms per frame`);
  for (const body of moved.bodies) assert.ok(body.position.every(Number.isFinite), body.name);
  assert.deepEqual(await faultsOf(page), []);
  await page.close();
});
