// SPDX-License-Identifier: BSD-3-Clause
// Images of sonars: the fan of an imaging sonar from polar to Cartesian coordinates, the waterfall of a side scan.
import {bytesOf, scaleColor} from './images.js';

const FAN_WIDTH = 480;
const LINES_MAX = 240;
const BINS_MAX = 1 << 22;
const COLORS = [...Array(256).keys()].map((i) => scaleColor(i / 255));

function check(holds, text) {
  if (!holds) throw new Error(text);
}

/** Where each pixel of a fan lies in the data: sensor at the bottom, x of the sensor up, y to the left; -1: outside. */
export function fanMap({nbins, nbeams, range_min_m, range_max_m, rad0, radstep}, width = FAN_WIDTH) {
  const end = rad0 + radstep * (nbeams - 1), low = Math.min(rad0, end) - Math.abs(radstep) / 2,
        high = Math.max(rad0, end) + Math.abs(radstep) / 2;
  // Extent in the frame of the sensor: the apex, both edges and, where the fan crosses an axis, its rim.
  const corners = [low, high];
  for (let k = -4; k <= 4; ++k)
    if (k * Math.PI / 2 > low && k * Math.PI / 2 < high) corners.push(k * Math.PI / 2);
  const xs = [0, ...corners.map((angle) => range_max_m * Math.cos(angle))];
  const ys = [0, ...corners.map((angle) => range_max_m * Math.sin(angle))];
  const [x0, x1, y0, y1] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
  const pixel_m = Math.max(y1 - y0, x1 - x0, 1e-6) / width;
  const columns = Math.max(1, Math.ceil((y1 - y0) / pixel_m)), rows = Math.max(1, Math.ceil((x1 - x0) / pixel_m));
  const index = new Int32Array(columns * rows).fill(-1);
  for (let row = 0; row < rows; ++row)
    for (let column = 0; column < columns; ++column) {
      const x = x1 - (row + 0.5) * pixel_m, y = y1 - (column + 0.5) * pixel_m;
      const range = Math.hypot(x, y), bearing = Math.atan2(y, x);
      const bin = Math.floor((range - range_min_m) / (range_max_m - range_min_m) * nbins);
      const beam = nbeams === 1 ? 0 : Math.round((bearing - rad0) / radstep);
      const inside = bin >= 0 && bin < nbins && beam >= 0 && beam < nbeams && bearing >= low && bearing <= high;
      if (inside) index[row * columns + column] = bin * nbeams + beam;
    }
  return {width: columns, height: rows, index, pixel_m, left_m: y1, top_m: x1};
}

/** Draws imaging sonars; keeps the map of the geometry. */
export class FanImage {
  decode(fields) {
    const {nbins, nbeams, range_min_m, range_max_m, rad0, radstep} = fields, data = bytesOf(fields.data);
    check(nbins > 0 && nbeams > 0 && nbins * nbeams <= BINS_MAX, `has ${nbins} x ${nbeams} bins`);
    check(data.length >= nbins * nbeams, `has only ${data.length} of ${nbins * nbeams} bins`);
    check(range_max_m > range_min_m && Number.isFinite(rad0 + radstep), 'has no valid ranges and bearings');
    const key = [nbins, nbeams, range_min_m, range_max_m, rad0, radstep].join();
    if (key !== this.key) this.map = fanMap(fields);
    this.key = key;
    const {width, height, index} = this.map;
    const rgba = new Uint8ClampedArray(4 * width * height), values = new Float32Array(width * height).fill(NaN);
    for (let i = 0; i < index.length; ++i) {
      if (index[i] < 0) continue;
      const value = data[index[i]];
      rgba.set(COLORS[value], 4 * i);
      rgba[4 * i + 3] = 255;
      values[i] = fields.floor_dB + value * fields.dB_per_count;
    }
    const low = fields.floor_dB, high = fields.floor_dB + 255 * fields.dB_per_count;
    return {width, height, rgba, values, low, high, unit: 'dB', note: `to ${range_max_m.toFixed(0)} m`};
  }
}

/** Waterfall of a side scan: one row for each ping, the newest on top, port on the left. */
export class Waterfall {
  constructor() { this.lines = []; }

  decode(fields, time_us) {
    const nbins = fields.nbins, port = bytesOf(fields.port), starboard = bytesOf(fields.starboard);
    check(nbins > 0 && nbins <= BINS_MAX, `has ${nbins} bins`);
    check(port.length >= nbins && starboard.length >= nbins, `has fewer than ${nbins} bins on a side`);
    const line = new Uint8Array(2 * nbins);
    line.set(port.slice(0, nbins).reverse());
    line.set(starboard.subarray(0, nbins), nbins);
    // Another size, or a time before: start again.
    const newest = this.lines[0];
    if (newest && (newest.values.length !== line.length || time_us < newest.time_us)) this.lines = [];
    if (this.lines[0]?.time_us !== time_us) this.lines.unshift({time_us, values: line});
    this.lines.length = Math.min(this.lines.length, LINES_MAX);
    return this.paint(fields);
  }

  paint(fields) {
    const width = this.lines[0].values.length, height = LINES_MAX;
    const rgba = new Uint8ClampedArray(4 * width * height), values = new Float32Array(width * height).fill(NaN);
    this.lines.forEach((line, row) => line.values.forEach((value, column) => {
      const i = row * width + column;
      rgba.set(COLORS[value], 4 * i);
      rgba[4 * i + 3] = 255;
      values[i] = fields.floor_dB + value * fields.dB_per_count;
    }));
    const low = fields.floor_dB, high = fields.floor_dB + 255 * fields.dB_per_count;
    const note = `port ← ${Number(fields.range_max_m).toFixed(0)} m → starboard, newest on top`;
    return {width, height, rgba, values, low, high, unit: 'dB', note};
  }
}
