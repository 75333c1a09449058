// SPDX-License-Identifier: BSD-3-Clause
// Images of cameras: decoding of messages `image_t` into pixels.  Images of sonars: sonar_images.js.

/** Pixel formats of bot_core, and that of PNG. */
const RGB = 859981650, GREY = 1497715271, MJPEG = 1196444237, GREY16 = 909199180, FLOAT32 = 842221382, PNG = 541544016;
const PIXELS_MAX = 1 << 25;

/** Colors from dark blue to yellow, readable for the color-blind: six points of viridis (van der Walt and Smith). */
const SCALE = [[68, 1, 84], [65, 68, 135], [42, 120, 142], [34, 168, 132], [122, 209, 81], [253, 231, 37]];

/** Color of a share from 0 to 1, as [red, green, blue]. */
export function scaleColor(share) {
  const at = Math.max(0, Math.min(1, share)) * (SCALE.length - 1);
  const i = Math.min(SCALE.length - 2, Math.floor(at)), rest = at - i;
  return SCALE[i].map((low, k) => Math.round(low + rest * (SCALE[i + 1][k] - low)));
}

const TABLE = Uint8ClampedArray.from([...Array(256).keys()].flatMap((i) => scaleColor(i / 255)));

/** Paints values from low to high into pixels; those that are not finite, and zeros if `zeroIsNone`, stay dark. */
export function paintValues(values, width, height, zeroIsNone) {
  let low = Infinity, high = -Infinity;
  const known = (value) => Number.isFinite(value) && !(zeroIsNone && value === 0);
  for (const value of values)
    if (known(value)) [low, high] = [Math.min(low, value), Math.max(high, value)];
  const rgba = new Uint8ClampedArray(4 * width * height);
  const scale = high > low ? 255 / (high - low) : 0;
  for (let i = 0; i < values.length; ++i) {
    rgba[4 * i + 3] = 255;
    if (!known(values[i])) continue;
    const from = 3 * Math.round((values[i] - low) * scale);
    for (let k = 0; k < 3; ++k) rgba[4 * i + k] = TABLE[from + k];
  }
  return {rgba, low: low <= high ? low : null, high: low <= high ? high : null};
}

/** Texts of the metadata by their keys. */
function metadataOf(fields) {
  const decoder = new TextDecoder();
  return Object.fromEntries((Array.isArray(fields.metadata) ? fields.metadata : []).map((entry) => {
    const value = entry?.value ?? [];
    return [String(entry?.key), typeof value === 'string' ? value : decoder.decode(Uint8Array.from(value))];
  }));
}

/** Bytes of an array of numbers, which is short, or of bytes. */
export const bytesOf = (value) => (value instanceof Uint8Array ? value : Uint8Array.from(value ?? []));

/** Rows of raw pixels without the bytes between them. */
function packRows(data, row_bytes, stride, height) {
  if (data.length < stride * (height - 1) + row_bytes) throw new Error(`has only ${data.length} bytes of pixels`);
  if (stride === row_bytes) return data.slice(0, row_bytes * height);
  const packed = new Uint8Array(row_bytes * height);
  for (let y = 0; y < height; ++y) packed.set(data.subarray(y * stride, y * stride + row_bytes), y * row_bytes);
  return packed;
}

async function inflate(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

const paeth = (a, b, c) => {
  const pa = Math.abs(b - c), pb = Math.abs(a - c), pc = Math.abs(a + b - 2 * c);
  return pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
};

/** Undoes the filters of the rows of a PNG with two bytes a pixel. */
function unfilter(data, width, height) {
  const row_bytes = 2 * width, out = new Uint8Array(row_bytes * height);
  for (let y = 0; y < height; ++y) {
    const filter = data[y * (row_bytes + 1)], from = y * (row_bytes + 1) + 1, to = y * row_bytes;
    for (let x = 0; x < row_bytes; ++x) {
      const a = x >= 2 ? out[to + x - 2] : 0, b = y > 0 ? out[to + x - row_bytes] : 0;
      const c = x >= 2 && y > 0 ? out[to + x - row_bytes - 2] : 0;
      out[to + x] = data[from + x] + [0, a, b, (a + b) >> 1, paeth(a, b, c)][filter];
    }
  }
  return out;
}

/** Pixels of a PNG with 16 bits of grey, which browsers cut to 8; null: a PNG of another kind. */
export async function decodeGrey16(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const parts = [];
  let width = 0, height = 0;
  for (let at = 8; at + 12 <= bytes.length;) {
    const length = view.getUint32(at), name = String.fromCharCode(...bytes.subarray(at + 4, at + 8));
    if (at + 12 + length > bytes.length) break;
    if (name === 'IHDR') {
      [width, height] = [view.getUint32(at + 8), view.getUint32(at + 12)];
      // 16 bits, grey, not interlaced.
      if (bytes[at + 16] !== 16 || bytes[at + 17] !== 0 || bytes[at + 20] !== 0) return null;
      if (width * height > PIXELS_MAX) throw new Error(`has ${width} x ${height} pixels`);
    }
    if (name === 'IDAT') parts.push(bytes.subarray(at + 8, at + 8 + length));
    at += 12 + length;
  }
  if (parts.length === 0) return null;
  const data = await inflate(new Blob(parts));
  if (data.length < height * (2 * width + 1)) throw new Error('ends early');
  const rows = unfilter(data, width, height), values = new Uint16Array(width * height);
  for (let i = 0; i < values.length; ++i) values[i] = rows[2 * i] << 8 | rows[2 * i + 1];
  return {width, height, values};
}

function fromGrey(data, width, height) {
  const rgba = new Uint8ClampedArray(4 * width * height);
  for (let i = 0; i < width * height; ++i) rgba.set([data[i], data[i], data[i], 255], 4 * i);
  return {width, height, rgba};
}

function fromRgb(data, width, height) {
  const rgba = new Uint8ClampedArray(4 * width * height);
  for (let i = 0, to = 0; to < rgba.length; to += 4) {
    rgba[to] = data[i++], rgba[to + 1] = data[i++], rgba[to + 2] = data[i++];
    rgba[to + 3] = 255;
  }
  return {width, height, rgba};
}

function fromValues(values, width, height, unit, zeroIsNone) {
  return {width, height, values, unit, ...paintValues(values, width, height, zeroIsNone)};
}

/** Compressed pixels, by the browser. */
async function fromFile(data, type) {
  const bitmap =
      await createImageBitmap(new Blob([data], {type}), {colorSpaceConversion: 'none', premultiplyAlpha: 'none'});
  const {width, height} = bitmap;
  const context = new OffscreenCanvas(width, height).getContext('2d', {willReadFrequently: true});
  context.drawImage(bitmap, 0, 0);
  bitmap.close();
  return {width, height, rgba: context.getImageData(0, 0, width, height).data};
}

/**
 * Decodes the fields of an `image_t`: {width, height, rgba} and, of depths and labels, the values with their range and
 * unit.  Throws an Error that says what is wrong.
 */
export async function decodeImage(fields) {
  const {width, height, pixelformat} = fields, data = bytesOf(fields.data);
  const unit = metadataOf(fields).unit ?? '';
  const raw = (bytes_per_pixel) => {
    const fits = Number.isInteger(width) && Number.isInteger(height) && width > 0 && height > 0;
    if (!fits || width * height > PIXELS_MAX) throw new Error(`has ${width} x ${height} pixels`);
    return packRows(data, bytes_per_pixel * width, fields.row_stride || bytes_per_pixel * width, height);
  };
  switch (pixelformat) {
    case GREY:
      return fromGrey(raw(1), width, height);
    case RGB:
      return fromRgb(raw(3), width, height);
    case GREY16:
      return fromValues(new Uint16Array(raw(2).buffer), width, height, unit, true);
    case FLOAT32:
      return fromValues(new Float32Array(raw(4).buffer), width, height, unit, false);
    case MJPEG:
      return fromFile(data, 'image/jpeg');
    case PNG: {
      const deep = await decodeGrey16(data);
      return deep ? fromValues(deep.values, deep.width, deep.height, unit, true) : fromFile(data, 'image/png');
    }
    default:
      throw new Error(`has the pixel format ${pixelformat}, which this page does not know`);
  }
}
