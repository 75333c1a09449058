// SPDX-License-Identifier: BSD-3-Clause
// Images of cameras and sonars: pixels equal the message.
import assert from 'node:assert/strict';
import {describe, it} from 'node:test';
import {crc32, deflateSync} from 'node:zlib';

import {until} from './browser.js';
import * as scenes from './scenes.js';
import {near, useBrowser, withPage} from './with_page.js';

useBrowser();

const WIDTH = 24, HEIGHT = 10;
const FORMATS = {
  rgb: 859981650,
  grey: 1497715271,
  mjpeg: 1196444237,
  grey16: 909199180,
  float: 842221382,
  png: 541544016
};

function image(pixelformat, data, row_stride) {
  return {utime: 1, width: WIDTH, height: HEIGHT, row_stride, pixelformat, size: data.length, data, metadata: []};
}

/** CRC of a part of a PNG, also where node has none. */
function crc(bytes) {
  if (crc32) return crc32(bytes);
  let sum = ~0;
  for (const byte of bytes) {
    sum ^= byte;
    for (let k = 0; k < 8; ++k) sum = sum & 1 ? (sum >>> 1) ^ 0xedb88320 : sum >>> 1;
  }
  return ~sum >>> 0;
}

/** A PNG with 16 bits of grey whose rows have the five filters in turn. */
function png16(values) {
  const row = 2 * WIDTH, raw = Buffer.alloc(row * HEIGHT), rows = [];
  values.forEach((value, i) => raw.writeUInt16BE(value, 2 * i));
  for (let y = 0; y < HEIGHT; ++y) {
    const line = Buffer.alloc(row + 1);
    line[0] = y % 5;
    for (let x = 0; x < row; ++x) {
      const a = x >= 2 ? raw[y * row + x - 2] : 0, b = y ? raw[(y - 1) * row + x] : 0;
      const c = x >= 2 && y ? raw[(y - 1) * row + x - 2] : 0;
      const [pa, pb, pc] = [Math.abs(b - c), Math.abs(a - c), Math.abs(a + b - 2 * c)];
      const paeth = pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
      line[x + 1] = raw[y * row + x] - [0, a, b, (a + b) >> 1, paeth][y % 5];
    }
    rows.push(line);
  }
  const part = (name, data) => {
    const body = Buffer.concat([Buffer.from(name), data]), ends = Buffer.alloc(8);
    ends.writeUInt32BE(data.length, 0);
    ends.writeUInt32BE(crc(body), 4);
    return Buffer.concat([ends.subarray(0, 4), body, ends.subarray(4)]);
  };
  const head = Buffer.alloc(13);
  head.writeUInt32BE(WIDTH, 0);
  head.writeUInt32BE(HEIGHT, 4);
  head[8] = 16;
  const data = deflateSync(Buffer.concat(rows));
  return Buffer.concat([
    Buffer.from('89504e470d0a1a0a', 'hex'), part('IHDR', head), part('IDAT', data.subarray(0, 40)),
    part('IDAT', data.subarray(40)), part('IEND', Buffer.alloc(0))
  ]);
}

/** Publishes an image and returns its pixels on the page: {width, height, rgba, values}. */
async function shown(page, server, channel, type, time_us, fields) {
  await server.publishOnceWanted(channel, type, time_us, fields);
  await until(page, `(p) => p.images.some((one) => one.channel === '${channel}' && one.time_us === ${time_us})`);
  return page.evaluate((name) => {
    const {image} = window.shoal.imageOf(name);
    const canvas = document.querySelector(`canvas[aria-label="Image of ${name}"]`);
    const {data} = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
    return {width: canvas.width, height: canvas.height, rgba: [...data], values: image.values && [...image.values]};
  }, channel);
}

describe('images', () => {
  it('of cameras have the pixels of the message', async () => {
    await withPage(scenes.land(), async (page, server) => {
      server.sendChannels(0, [['rover1.front', 'shoal.image_t', 'rover1']]);
      const show = (time_us, fields) => shown(page, server, 'rover1.front', 'image_t', time_us, fields);
      // Grey and color, with bytes between the rows.
      const stride = 3 * WIDTH + 4;
      const rgb = Uint8Array.from({length: stride * HEIGHT}, (_, i) => i * 7 % 256);
      const color = await show(1e6, image(FORMATS.rgb, rgb, stride));
      assert.deepEqual([color.width, color.height], [WIDTH, HEIGHT]);
      const grey = Uint8Array.from({length: WIDTH * HEIGHT}, (_, i) => i);
      const levels = await show(2e6, image(FORMATS.grey, grey, WIDTH));
      for (let y = 0; y < HEIGHT; ++y)
        for (let x = 0; x < WIDTH; ++x) {
          const i = y * WIDTH + x, from = y * stride + 3 * x;
          assert.deepEqual(color.rgba.slice(4 * i, 4 * i + 4), [rgb[from], rgb[from + 1], rgb[from + 2], 255]);
          assert.deepEqual(levels.rgba.slice(4 * i, 4 * i + 4), [grey[i], grey[i], grey[i], 255]);
        }
      // Depths in meters and millimeters, raw and as PNG: the values, not only their colors.
      const meters = Float32Array.from({length: WIDTH * HEIGHT}, (_, i) => (i % 5 ? i / 8 : Infinity));
      const depth = await show(3e6, image(FORMATS.float, new Uint8Array(meters.buffer), 4 * WIDTH));
      assert.equal(depth.values[6], 0.75);
      assert.deepEqual(depth.rgba.slice(0, 4), [0, 0, 0, 255]);
      const mm = Uint16Array.from({length: WIDTH * HEIGHT}, (_, i) => i * 273 % 65536);
      const raw = await show(4e6, image(FORMATS.grey16, new Uint8Array(mm.buffer), 2 * WIDTH));
      assert.deepEqual(raw.values, [...mm]);
      const packed = await show(5e6, image(FORMATS.png, Uint8Array.from(png16(mm)), 0));
      assert.deepEqual(packed.values, [...mm]);
      // JPEG: one color all over, within the loss of the format.
      const jpeg = await page.evaluate(async ([width, height]) => {
        const canvas = new OffscreenCanvas(width, height), context = canvas.getContext('2d');
        context.fillStyle = 'rgb(200, 120, 40)';
        context.fillRect(0, 0, width, height);
        const blob = await canvas.convertToBlob({type: 'image/jpeg', quality: 0.95});
        return [...new Uint8Array(await blob.arrayBuffer())];
      }, [WIDTH, HEIGHT]);
      const film = await show(6e6, image(FORMATS.mjpeg, Uint8Array.from(jpeg), 0));
      [200, 120, 40].forEach((level, k) => near(film.rgba[4 * 30 + k], level, 4, `channel ${k}`));
      // What is wrong with a message stands below its image.
      await server.publishOnceWanted('rover1.front', 'image_t', 7e6, image(FORMATS.rgb, rgb.subarray(0, 20), stride));
      await page.waitForFunction(
          () => /has only 20 bytes of pixels/.test(document.querySelector('figcaption').textContent));
    }, {fragment: '#t=secret&data=images&images=rover1.front', width: 800, height: 500});
  });

  it('of sonars are a fan and a waterfall', async () => {
    await withPage(scenes.underwater(), async (page, server) => {
      const nbins = 30, nbeams = 21, radstep = 0.05, rad0 = -0.5;
      const data = Uint8Array.from({length: nbins * nbeams}, (_, i) => i % 251);
      const fields =
          {nbins, nbeams, range_min_m: 1, range_max_m: 31, rad0, radstep, floor_dB: 40, dB_per_count: 0.5, data};
      const fan = await shown(page, server, 'auv1.sonar', 'sonar_image_t', 1e6, fields);
      const map = await page.evaluate(async (one) => {
        const {fanMap} = await import('/sonar_images.js');
        const {pixel_m, left_m, top_m} = fanMap(one);
        return {pixel_m, left_m, top_m};
      }, {...fields, data: []});
      // The middle of each bin and beam that is larger than a pixel.
      for (let bin = 10; bin < nbins; bin += 3)
        for (let beam = 0; beam < nbeams; beam += 4) {
          const range = 1 + bin + 0.5, bearing = rad0 + beam * radstep;
          const column = Math.floor((map.left_m - range * Math.sin(bearing)) / map.pixel_m);
          const row = Math.floor((map.top_m - range * Math.cos(bearing)) / map.pixel_m);
          assert.equal(fan.values[row * fan.width + column], 40 + 0.5 * data[bin * nbeams + beam], `${bin} ${beam}`);
        }
      // Two pings of a side scan: the newer on top, port mirrored on the left.
      const ping = (from) => ({
        range_min_m: 0,
        range_max_m: 50,
        floor_dB: 0,
        dB_per_count: 1,
        nbins: 20,
        port: Uint8Array.from({length: 20}, (_, i) => from + i),
        starboard: Uint8Array.from({length: 20}, (_, i) => from + 100 + i),
      });
      await shown(page, server, 'auv1.side', 'side_scan_t', 1e6, ping(0));
      const {values, width} = await shown(page, server, 'auv1.side', 'side_scan_t', 2e6, ping(10));
      assert.equal(width, 40);
      assert.deepEqual([values[0], values[19], values[20], values[39]], [29, 10, 110, 129]);
      assert.deepEqual([values[40], values[40 + 39]], [19, 119]);
    }, {fragment: '#t=secret&data=images&images=auv1.sonar,auv1.side', width: 800, height: 500});
  });
});
