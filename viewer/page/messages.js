// SPDX-License-Identifier: BSD-3-Clause
// Messages of channels (binary, kind 2): decoding, numeric fields, and who on the page wants which channel.
import {ProtocolError} from './protocol.js';

const HEAD_BYTES = 32;
const RATE_MAX_HZ = 30;
const CHANNELS_MAX = 2000;
const FIELDS_MAX = 2000;
const NESTED_MAX = 32;
const ARRAYS = {
  f32: Float32Array,
  f64: Float64Array,
  u8: Uint8Array,
  i64: BigInt64Array
};

/** Units of fields by the ends of their names. */
const UNITS = {
  m: 'm',
  mm: 'mm',
  km: 'km',
  s: 's',
  us: 'µs',
  ms: 'ms',
  mps: 'm/s',
  mps2: 'm/s²',
  rad: 'rad',
  deg: '°',
  radps: 'rad/s',
  rpm: 'rpm',
  Hz: 'Hz',
  dB: 'dB',
  db: 'dB',
  N: 'N',
  Nm: 'N m',
  V: 'V',
  A: 'A',
  W: 'W',
  J: 'J',
  Wh: 'W h',
  C: '°C',
  Pa: 'Pa',
  kPa: 'kPa',
  dbar: 'dbar',
  psu: 'psu',
  kg: 'kg',
  ppm: '1e-6',
};

function require(holds, rule, value) {
  if (!holds) throw new ProtocolError(`message: ${rule}, got ${String(JSON.stringify(value)).slice(0, 60)}`);
}

/** Returns the array that a header describes, as a view or a copy of the bytes that follow the header. */
function readArray({array, offset, count}, bytes) {
  const Kind = Object.hasOwn(ARRAYS, array) ? ARRAYS[array] : null;
  require(Kind !== null, `'array' must be one of ${Object.keys(ARRAYS).join(', ')}`, array);
  require(Number.isInteger(offset) && offset >= 0 && offset % 8 === 0, '\'offset\' must be a multiple of 8', offset);
  const room = (bytes.length - offset) / Kind.BYTES_PER_ELEMENT;
  require(Number.isInteger(count) && count >= 0 && count <= room, '\'count\' must fit into the message', count);
  const part = bytes.slice(offset, offset + count * Kind.BYTES_PER_ELEMENT);
  const values = new Kind(part.buffer, 0, count);
  return Kind === BigInt64Array ? Float64Array.from(values, Number) : values;
}

function readValue(value, bytes, depth) {
  require(depth < NESTED_MAX, `must be nested less than ${NESTED_MAX} deep`, depth);
  if (Array.isArray(value)) return value.map((each) => readValue(each, bytes, depth + 1));
  if (typeof value !== 'object' || value === null) return value;
  if (typeof value.array === 'string' && 'offset' in value && 'count' in value) return readArray(value, bytes);
  return Object.fromEntries(Object.entries(value).map(([name, each]) => [name, readValue(each, bytes, depth + 1)]));
}

/** Decodes a message {channel, type, time_us, fields, bytes}; long arrays become typed arrays. */
export function decodeMessage(buffer) {
  require(buffer.byteLength >= HEAD_BYTES, 'must have a head of 32 bytes', buffer.byteLength);
  const view = new DataView(buffer);
  const length = view.getUint32(4, true);
  require(length <= buffer.byteLength - HEAD_BYTES, 'header must fit into the message', length);
  let header;
  try {
    header = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, HEAD_BYTES, length)));
  } catch (error) {
    throw new ProtocolError(`message: header: ${error.message}`);
  }
  require(typeof header?.channel === 'string', '\'channel\' must be a text', header?.channel);
  require(
      typeof header.fields === 'object' && header.fields !== null && !Array.isArray(header.fields),
      '\'fields\' must be a map', header.fields);
  return {
    channel: header.channel,
    type: shortType(header.type),
    time_us: Number(view.getBigInt64(8, true)),
    fields: readValue(header.fields, new Uint8Array(buffer, HEAD_BYTES + length), 0),
    bytes: buffer.byteLength,
  };
}

/** Name of a type without its package. */
export const shortType = (type) => String(type ?? '').split('.').pop();

const isList = (value) => Array.isArray(value) || ArrayBuffer.isView(value);
const isNumeric = (value) => typeof value === 'number' || typeof value === 'boolean';

/** Paths of all numeric fields, written as in `shoal log csv`: pos[0], items[2].range_m. */
export function numericFields(fields) {
  const paths = [];
  const visit = (value, path) => {
    if (paths.length >= FIELDS_MAX) return;
    // A null is a number that is not finite.
    if (isNumeric(value) || value === null) paths.push(path);
    if (isList(value)) value.forEach((each, i) => visit(each, `${path}[${i}]`));
    if (typeof value === 'object' && value !== null && !isList(value))
      for (const [name, each] of Object.entries(value)) visit(each, path ? `${path}.${name}` : name);
  };
  visit(fields, '');
  return paths;
}

/** Number at a path; NaN where there is none. */
export function numberAt(fields, path) {
  let value = fields;
  for (const step of path.split(/[.[\]]+/)) {
    if (step === '') continue;
    if (typeof value !== 'object' || value === null || !Object.hasOwn(value, step)) return NaN;
    value = value[step];
  }
  return isNumeric(value) ? Number(value) : NaN;
}

/** Unit of a field by its name; empty: none. */
export function unitOf(path) {
  const end = path.replace(/(\[\d+\])+$/, '').split('_').pop();
  return path.includes('_') && Object.hasOwn(UNITS, end) ? UNITS[end] : '';
}

/** The channels of a run, and their newest messages. */
export class Channels {
  constructor(connection, changed) {
    this.connection = connection;
    this.changed = changed;
    this.wishes = new Map();
    this.takers = new Map();
    this.clear();
  }

  /** Forgets the channels of a run. */
  clear() {
    this.byName = new Map();
    this.newest = new Map();
  }

  /** Forgets the messages after a time that was set. */
  rewind(time_us) {
    for (const [name, message] of this.newest)
      if (message.time_us > time_us) this.newest.delete(name);
  }

  /** Takes a message `channels`: cumulative counts, from which the rates follow. */
  setItems({time_us, items}) {
    const before = this.byName;
    const rows = (Array.isArray(items) ? items : []).filter((item) => typeof item?.name === 'string');
    this.byName = new Map(rows.slice(0, CHANNELS_MAX).map((item) => {
      const row = {
        name: item.name,
        type: shortType(item.type),
        vehicle: String(item.vehicle ?? ''),
        count: Number(item.count) || 0,
        bytes: Number(item.bytes) || 0,
        marks: before.get(item.name)?.marks ?? [],
      };
      this.measure(row, Number(time_us) || 0);
      return [row.name, row];
    }));
    this.changed();
  }

  /** Rates over the last five simulated seconds; null before there are two counts. */
  measure(row, time_us) {
    const last = row.marks[row.marks.length - 1];
    if (last && (time_us < last.time_us || row.count < last.count)) row.marks = [];
    if (!last || time_us !== last.time_us) row.marks.push({time_us, count: row.count, bytes: row.bytes});
    while (row.marks.length > 2 && row.marks[1].time_us <= time_us - 5e6) row.marks.shift();
    const first = row.marks[0], passed_s = (time_us - first.time_us) * 1e-6;
    row.rate_hz = passed_s > 0 ? (row.count - first.count) / passed_s : null;
    row.bytes_per_s = passed_s > 0 ? (row.bytes - first.bytes) / passed_s : null;
  }

  /** Channels whose type is one of some, in the order of their names. */
  ofTypes(types) {
    const found = [...this.byName.values()].filter((row) => types.includes(row.type));
    return found.sort((a, b) => (a.name < b.name ? -1 : 1));
  }

  /** Sets which channels a part of the page wants, and at which rate; take(message) gets them. */
  want(owner, names, rate_hz, take) {
    const wish = new Map([...names].map((name) => [name, Math.min(RATE_MAX_HZ, rate_hz)]));
    this.takers.set(owner, take);
    if (JSON.stringify([...this.wishes.get(owner) ?? []]) === JSON.stringify([...wish])) return;
    this.wishes.set(owner, wish);
    this.subscribe();
  }

  /** Tells the server what all parts together want, if that is news to it; `again`: in any case. */
  subscribe(again = false) {
    const rates = new Map();
    for (const wish of this.wishes.values())
      for (const [name, rate_hz] of wish) rates.set(name, Math.max(rate_hz, rates.get(name) ?? 0));
    const channels = [...rates].map(([name, rate_hz]) => ({name, rate_hz}));
    const text = JSON.stringify(channels);
    if (text === this.sent && !again) return;
    if (again && channels.length === 0) return;
    this.sent = text;
    this.connection.send({op: 'subscribe', channels});
    for (const name of this.newest.keys())
      if (!rates.has(name)) this.newest.delete(name);
  }

  /** Takes a message and hands it to those who want its channel. */
  take(message) {
    this.newest.set(message.channel, message);
    for (const [owner, wish] of this.wishes)
      if (wish.has(message.channel)) this.takers.get(owner)(message);
  }
}
