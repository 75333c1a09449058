// SPDX-License-Identifier: BSD-3-Clause
// Vehicles have the same colors on the page, in films and in plots.
import assert from 'node:assert/strict';
import {readFile} from 'node:fs/promises';
import {it} from 'node:test';

import {ESTIMATE_COLOR, VEHICLE_COLORS} from '../../viewer/page/palette.js';

const source = (path) => readFile(new URL(`../../${path}`, import.meta.url), 'utf8');

it('is one table for page, films and plots', async () => {
  const cpp = await source('sim/base/vehicle_colors.hpp'), python = await source('python/shoal/plots.py');
  const table = /vehicle_colors\{([^}]*)\}/.exec(cpp)[1].match(/[0-9a-f]{6}/g).map((one) => `#${one}`);
  assert.deepEqual(table, VEHICLE_COLORS);
  const estimate = new RegExp('estimate_color = 0x([0-9a-f]{6})').exec(cpp)[1];
  assert.equal(`#${estimate}`, ESTIMATE_COLOR);
  assert.deepEqual(/VEHICLE_COLORS = \(([^)]*)\)/.exec(python)[1].match(/#[0-9a-f]{6}/g), VEHICLE_COLORS);
});

/** Red, green and blue in linear light, as a viewer without cones for middle wavelengths sees them (Machado 2009). */
function asDeuteranope(color) {
  const [r, g, b] = [1, 3, 5].map((at) => (parseInt(color.slice(at, at + 2), 16) / 255) ** 2.2);
  return [0.367 * r + 0.861 * g - 0.228 * b, 0.280 * r + 0.673 * g + 0.047 * b, -0.012 * r + 0.043 * g + 0.969 * b].map(
      (level) => Math.max(0, level) ** (1 / 2.2));
}

it('has colors that color-blind people distinguish', () => {
  const all = [...VEHICLE_COLORS, ESTIMATE_COLOR].map((color) => [color, asDeuteranope(color)]);
  for (const [i, [a, x]] of all.entries())
    for (const [b, y] of all.slice(0, i)) {
      const away = Math.hypot(...x.map((level, k) => level - y[k]));
      assert.ok(away > 0.09, `${a} and ${b} look alike: ${away}`);
    }
});
