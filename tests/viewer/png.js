// SPDX-License-Identifier: BSD-3-Clause
// Reads the PNG files that shoal writes: 8 bits, not interlaced.
import {inflateSync} from 'node:zlib';

/** Decodes a PNG file; returns {width, height, channels, data}. */
export function readPng(file) {
  if (file.readUInt32BE(0) !== 0x89504e47) throw new Error('not a PNG file');
  const width = file.readUInt32BE(16), height = file.readUInt32BE(20), channels = [1, 0, 3, 0, 2, 0, 4][file[25]];
  if (file[24] !== 8 || !channels || file[28] !== 0) throw new Error('PNG of an unexpected kind');
  const parts = [];
  for (let at = 8; at < file.length; at += 12 + file.readUInt32BE(at))
    if (file.toString('latin1', at + 4, at + 8) === 'IDAT')
      parts.push(file.subarray(at + 8, at + 8 + file.readUInt32BE(at)));
  const packed = inflateSync(Buffer.concat(parts)), stride = width * channels, data = Buffer.alloc(stride * height);
  // Each row has a filter: the difference to the byte at the left, above, and so on.
  for (let row = 0; row < height; ++row) {
    const filter = packed[row * (stride + 1)];
    for (let i = 0; i < stride; ++i) {
      const to = row * stride + i;
      const left = i >= channels ? data[to - channels] : 0, above = row > 0 ? data[to - stride] : 0;
      const corner = i >= channels && row > 0 ? data[to - stride - channels] : 0;
      const guess = left + above - corner;
      const [a, b, c] = [left, above, corner].map((value) => Math.abs(guess - value));
      const paeth = a <= b && a <= c ? left : b <= c ? above : corner;
      data[to] = packed[row * (stride + 1) + 1 + i] + [0, left, above, (left + above) >> 1, paeth][filter];
    }
  }
  return {width, height, channels, data};
}
