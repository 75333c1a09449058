// SPDX-License-Identifier: BSD-3-Clause
// A run inside of the page (shoal report), in place of a server: plays and seeks like a log.
import {mix} from './playback.js';
import {decodeState, parseMessage, ProtocolError} from './protocol.js';

const HEAD_BYTES = 24;
const TEXT = 1, STATE = 2, ASSET = 3, ESTIMATES = 4;
/** After a jump, what happened in this time before is still visible. */
const BEFORE_US = 3e6;
/** A page that drew no frame for longer, such as a hidden one, continues where it was. */
const FRAME_MAX_MS = 1000;

/** Reads the entries: kind, time_us, bytes; in the order of their times. */
function readEntries(buffer) {
  const view = new DataView(buffer), entries = [], assets = new Map();
  for (let at = 0; at < buffer.byteLength;) {
    if (at + HEAD_BYTES > buffer.byteLength) throw new ProtocolError('recording: ends within an entry');
    const kind = view.getUint32(at, true), size = view.getUint32(at + 4, true);
    const time_us = Number(view.getBigInt64(at + 8, true));
    const hash = view.getBigUint64(at + 16, true).toString(16).padStart(16, '0');
    const from = at + HEAD_BYTES, to = from + size;
    if (to > buffer.byteLength) throw new ProtocolError('recording: ends within an entry');
    if (kind === ASSET)
      assets.set(hash, [from, to]);
    else
      entries.push({kind, time_us, from, to});
    at = to;
  }
  return {entries, assets};
}

/** Number of entries of which the time is at most `time_us`. */
function countUntil(entries, time_us) {
  let low = 0, high = entries.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (entries[middle].time_us <= time_us)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

/** Has the interface of a Connection, without a server. */
export class Recording {
  constructor(buffer) {
    this.buffer = buffer;
    const {entries, assets} = readEntries(buffer);
    this.assets = assets;
    this.states = entries.filter((entry) => entry.kind === STATE);
    this.texts = entries.filter((entry) => entry.kind !== STATE);
    for (const entry of this.texts) entry.op = entry.kind === ESTIMATES ? 'estimates' : this.message(entry).op;
    this.decoded = new Map();
    this.speed = 1;
    this.paused = false;
    this.loop = false;
    this.isOpen = true;
  }

  message(entry) {
    return parseMessage(new TextDecoder().decode(new Uint8Array(this.buffer, entry.from, entry.to - entry.from)));
  }

  /** Bytes of an asset. */
  asset(hash) {
    const place = this.assets.get(hash);
    return place ? this.buffer.slice(...place) : null;
  }

  /** Shows the start.  Events: as those of a Connection. */
  start(handlers) {
    this.handlers = handlers;
    const hello = this.texts.find((entry) => entry.op === 'hello');
    if (!hello || this.states.length === 0) throw new ProtocolError('recording: has nothing to show');
    this.hello = this.message(hello);
    this.now_us = this.hello.start_us;
    this.deliver(hello);
    this.texts.filter((entry) => entry.op === 'events').forEach((entry) => this.deliver(entry));
    this.texts = this.texts.filter((entry) => !['hello', 'events'].includes(entry.op));
    this.seek(this.now_us);
  }

  deliver(entry) {
    if (entry.op === 'scene') this.scene = entry;
    try {
      this.handlers.message(this.message(entry));
    } catch (error) {
      if (!(error instanceof ProtocolError)) throw error;
      this.handlers.problem(error.message);
    }
  }

  /** Called once in a frame: advances its time. */
  acknowledge(wall_ms = performance.now()) {
    const dt_ms = Math.min(FRAME_MAX_MS, wall_ms - (this.wall_ms ?? wall_ms));
    this.wall_ms = wall_ms;
    if (!this.handlers || this.paused || dt_ms <= 0) return;
    const before_us = this.now_us;
    if (before_us >= this.hello.end_us) {
      if (this.loop) this.seek(this.hello.start_us);
      return;
    }
    this.now_us = Math.min(this.hello.end_us, before_us + 1000 * dt_ms * this.speed);
    for (let i = countUntil(this.texts, before_us); i < countUntil(this.texts, this.now_us); ++i)
      this.deliver(this.texts[i]);
    this.sendState(false);
    if (this.now_us >= this.hello.end_us || wall_ms - (this.status_ms ?? 0) > 500) this.sendStatus();
  }

  /** Goes to a time: what holds then, and what happened shortly before. */
  seek(time_us) {
    this.now_us = Math.min(this.hello.end_us, Math.max(this.hello.start_us, time_us));
    const count = countUntil(this.texts, this.now_us);
    for (const op of ['scene', 'scores', 'paths']) {
      const last = this.texts.slice(0, count).findLast((entry) => entry.op === op);
      if (last && last !== this.scene) this.deliver(last);
    }
    this.sendState(true);
    for (let i = countUntil(this.texts, this.now_us - BEFORE_US); i < count; ++i)
      if (!['scene', 'scores', 'paths'].includes(this.texts[i].op)) this.deliver(this.texts[i]);
    this.sendStatus();
  }

  state(i) {
    const entry = this.states[i];
    if (!this.decoded.has(entry)) {
      if (this.decoded.size > 4) this.decoded.delete(this.decoded.keys().next().value);
      this.decoded.set(entry, decodeState(this.buffer.slice(entry.from, entry.to)));
    }
    return this.decoded.get(entry);
  }

  /** Gives the state of the present time, between those of the recording. */
  sendState(jump) {
    const i = Math.max(0, countUntil(this.states, this.now_us) - 1);
    const a = this.state(i), b = this.state(Math.min(i + 1, this.states.length - 1));
    const span_us = b.time_us - a.time_us;
    const fits = span_us > 0 && a.revision === b.revision && a.poses.length === b.poses.length && !b.jump;
    const share = fits ? Math.min(1, Math.max(0, (this.now_us - a.time_us) / span_us)) : 0;
    const poses = new Float32Array(a.poses.length);
    mix(a.poses, b.poses, share, poses);
    this.handlers.state({...a, poses, jump, time_us: this.now_us, paused: this.paused, speed: this.speed});
  }

  sendStatus() {
    this.status_ms = this.wall_ms;
    const stands = this.paused || this.now_us >= this.hello.end_us;
    this.handlers.message({
      op: 'status',
      time_us: this.now_us,
      branch: 0,
      paused: stands,
      speed: this.speed,
      rate: stands ? 0 : this.speed,
    });
  }

  /** Takes what the page asks of a server; what only a server can do has no effect. */
  send(message) {
    if (message.op === 'seek' && Number.isFinite(message.time_us)) this.seek(message.time_us);
    if (message.op !== 'play') return;
    this.speed = Math.min(1000, Math.max(0.01, message.speed || this.speed));
    this.paused = message.paused === true;
    this.loop = message.loop === true;
    if (!this.paused && this.now_us >= this.hello.end_us)
      this.seek(this.hello.start_us);
    else
      this.sendStatus();
  }

  control() {
    this.handlers.problem('this is a recording, which cannot be steered');
    return 0;
  }

  setStatus() {}
  staleFor_s() { return 0; }
  get isOver() { return false; }
  banner() { return ''; }
}
