// SPDX-License-Identifier: BSD-3-Clause
// A server for tests that speaks docs/develop/view_protocol.md: it serves viewer/page and plays scenes made by hand.
import {readFile} from 'node:fs/promises';
import {createServer} from 'node:http';
import {extname, join, normalize} from 'node:path';
import {fileURLToPath} from 'node:url';
import {WebSocketServer} from 'ws';

const PAGE = fileURLToPath(new URL('../../viewer/page/', import.meta.url));
const TYPES = {
  '.html': 'text/html; charset=utf-8',
  '.js': 'text/javascript',
  '.css': 'text/css',
  '.txt': 'text/plain'
};
const POLICY = 'default-src \'self\'; connect-src \'self\'; img-src \'self\' blob: data:; frame-ancestors \'none\'';

/** Encodes a state; poses: a list of [x, y, z, qw, qx, qy, qz]. */
export function encodeState(
    {sequence, time_us, revision = 1, branch = 0, paused = false, jump = false, past = false, speed = 1, poses}) {
  const buffer = Buffer.alloc(32 + 20 * poses.length);
  buffer.writeUInt8(1, 0);
  buffer.writeUInt8((paused ? 1 : 0) | (jump ? 2 : 0) | (past ? 4 : 0), 1);
  buffer.writeUInt32LE(sequence, 4);
  buffer.writeBigInt64LE(BigInt(Math.round(time_us)), 8);
  buffer.writeInt32LE(branch, 16);
  buffer.writeUInt32LE(revision, 20);
  buffer.writeUInt32LE(poses.length, 24);
  buffer.writeFloatLE(speed, 28);
  poses.forEach((pose, i) => {
    const at = 32 + 20 * i;
    for (let k = 0; k < 3; ++k) buffer.writeFloatLE(pose[k], at + 4 * k);
    for (let k = 0; k < 4; ++k) buffer.writeInt16LE(Math.round(pose[3 + k] * 32767), at + 12 + 2 * k);
  });
  return buffer;
}

const ARRAYS = {
  f32: [4, 'writeFloatLE'],
  f64: [8, 'writeDoubleLE'],
  u8: [1, 'writeUInt8'],
  i64: [8, 'writeBigInt64LE']
};

/** Kind of the numbers of a list: as the typed array says, else 64 bits. */
function kindOf(list) {
  if (list instanceof Float32Array) return 'f32';
  if (list instanceof Uint8Array) return 'u8';
  return list instanceof BigInt64Array ? 'i64' : 'f64';
}

/** Encodes a message of a channel; lists of more than 16 numbers go behind the header. */
export function encodeMessage({channel, type, time_us, fields}) {
  const blobs = [];
  let end = 0;
  const pack = (value) => {
    const numbers = ArrayBuffer.isView(value) || (Array.isArray(value) && value.every((x) => typeof x === 'number'));
    if (numbers && value.length > 16) {
      const kind = kindOf(value), [bytes, write] = ARRAYS[kind];
      const blob = Buffer.alloc(Math.ceil(value.length * bytes / 8) * 8), offset = end;
      value.forEach((x, i) => blob[write](x, i * bytes));
      blobs.push(blob);
      end += blob.length;
      return {array: kind, offset, count: value.length};
    }
    if (ArrayBuffer.isView(value)) return [...value].map((x) => (Number.isFinite(x) ? x : null));
    if (Array.isArray(value)) return value.map(pack);
    if (typeof value !== 'object' || value === null) return Number.isNaN(value) ? null : value;
    return Object.fromEntries(Object.entries(value).map(([name, each]) => [name, pack(each)]));
  };
  const text = Buffer.from(JSON.stringify({channel, type, fields: pack(fields)}));
  const header = Buffer.concat([text, Buffer.alloc((8 - text.length % 8) % 8, ' ')]), head = Buffer.alloc(32);
  head.writeUInt8(2, 0);
  head.writeUInt32LE(header.length, 4);
  head.writeBigInt64LE(BigInt(Math.round(time_us)), 8);
  return Buffer.concat([head, header, ...blobs]);
}

/** Server of one scene.  play(): sends states by the wall clock; show(time_us): sends one state, paused. */
export class MockServer {
  /** script: {scene, posesAt(t_s), hello, source, assets: Map}. */
  constructor(script, token = 'secret') {
    this.script = script;
    // The scene has the poses at its time, as that of a real server.
    script.posesAt(0).forEach((pose, i) => {
      script.scene.bodies[i].pose = pose;
    });
    this.token = token;
    this.clients = new Set();
    this.received = [];
    this.requests = [];
    this.sequence = 0;
    this.time_us = 0;
    this.paused = true;
    this.speed = 1;
    this.frozen = false;
    this.http = createServer((request, response) => this.answer(request, response));
    this.sockets = new WebSocketServer({
      server: this.http,
      handleProtocols: (names) => (names.has('shoal.view.v1') ? 'shoal.view.v1' : false),
    });
    this.sockets.on('connection', (socket) => this.join(socket));
  }

  async listen(port = 0) {
    await new Promise((resolve) => {
      this.http.listen(port, '127.0.0.1', resolve);
    });
    this.port = this.http.address().port;
    this.url = `http://127.0.0.1:${this.port}/`;
    this.heartbeat = setInterval(() => this.tick(), 33);
    return this;
  }

  async close() {
    clearInterval(this.heartbeat);
    for (const client of this.clients) client.socket.terminate();
    this.sockets.close();
    this.http.closeAllConnections();
    await new Promise((resolve) => {
      this.http.close(resolve);
    });
  }

  async answer(request, response) {
    const path = new URL(request.url, 'http://x').pathname;
    this.requests.push(path);
    const asset = this.script.assets?.get(path.replace('/asset/', ''));
    const file = join(PAGE, normalize(path === '/' ? '/index.html' : path));
    const headers = {
      'Content-Security-Policy': POLICY,
      'X-Content-Type-Options': 'nosniff',
      'Cache-Control': 'no-cache',
      'Cross-Origin-Resource-Policy': 'same-origin',
    };
    try {
      const body = asset ?? (file.startsWith(PAGE) ? await readFile(file) : null);
      response.writeHead(200, {...headers, 'Content-Type': asset ? 'application/octet-stream' : TYPES[extname(file)]});
      response.end(body);
    } catch {
      response.writeHead(404, headers);
      response.end('not found');
    }
  }

  join(socket) {
    const client = {socket, control: false, unacknowledged: 0, last: null, channels: new Set()};
    this.clients.add(client);
    socket.on('message', (data) => this.take(client, JSON.parse(data)));
    socket.on('close', () => this.clients.delete(client));
  }

  take(client, message) {
    this.received.push(message);
    if (message.op === 'ack') client.unacknowledged = Math.max(0, client.unacknowledged - 1);
    if (message.op === 'hello') {
      client.control = message.token === this.token;
      this.sendTo(client, {
        op: 'hello',
        version: 1,
        shoal: '0.2.0',
        source: 'run',
        world: this.script.scene.world,
        epoch_us: 0,
        start_us: 0,
        end_us: null,
        ...this.script.hello,
        control: client.control
      });
      this.sendTo(client, this.script.scene);
      if (this.script.forms) this.sendTo(client, this.script.forms);
      this.sendStatus(client);
      client.greeted = true;
      this.sendState(client, true);
    }
    if (message.op === 'subscribe') client.channels = new Set(message.channels.map((channel) => channel.name));
    if (message.op === 'series') this.answerSeries(client, message);
    if (message.op === 'control' && client.control) this.execute(client, message);
    if (message.op === 'look' && message.time_us !== null) this.answerLook(client, message);
    if (message.op === 'seek' && client.control) this.show(message.time_us);
    if (message.op === 'play' && client.control) [this.paused, this.speed] = [message.paused, message.speed];
  }

  /** Sends the state of ten per second at or before a time; another branch has its own poses. */
  answerLook(client, {time_us, branch = 0}) {
    if (this.deaf) return;
    const kept_us = Math.floor(time_us / 100000) * 100000;
    const posesAt = this.script.branches?.[branch] ?? this.script.posesAt;
    client.socket.send(encodeState({
      sequence: 0,
      time_us: kept_us,
      revision: this.script.scene.revision,
      branch,
      paused: true,
      past: true,
      poses: posesAt(kept_us / 1e6),
    }));
  }

  execute(client, {id, command, value}) {
    if (command === 'pause' || command === 'resume')
      this.paused = command === 'pause';
    else if (command === 'speed')
      this.speed = value;
    else if (command === 'step')
      this.show(this.time_us + value * 10000, false);
    else if (command === 'rewind')
      this.show(this.time_us - value * 1e6);
    else if (command !== 'do' && command !== 'spawn')
      return this.sendTo(client, {op: 'reply', id, ok: false, text: `unknown command '${command}'`});
    this.sendTo(client, {op: 'reply', id, ok: true, text: ''});
    for (const one of this.clients) this.sendStatus(one);
    return undefined;
  }

  sendTo(client, message) {
    if (!this.frozen) client.socket.send(JSON.stringify(message));
  }

  /** Sends a text message to all pages. */
  send(message) {
    for (const client of this.clients) this.sendTo(client, message);
  }

  /** Sends a message of a channel to the pages that want it; returns how many do. */
  publish(channel, type, time_us, fields) {
    const takers = [...this.clients].filter((client) => client.channels.has(channel));
    for (const client of takers) client.socket.send(encodeMessage({channel, type: `shoal.${type}`, time_us, fields}));
    return takers.length;
  }

  /** Waits until a page wants a channel, then publishes. */
  async publishOnceWanted(channel, ...rest) {
    for (const start_ms = performance.now(); performance.now() - start_ms < 60000;) {
      if (this.publish(channel, ...rest) > 0) return;
      await new Promise((resolve) => {
        setTimeout(resolve, 20);
      });
    }
    throw new Error(`no page wants ${channel}`);
  }

  /** Sends the list of channels: [name, type, vehicle, count, bytes] each. */
  sendChannels(time_us, rows) {
    const items = rows.map(([name, type, vehicle, count = 1, bytes = 100]) => ({name, type, vehicle, count, bytes}));
    this.send({op: 'channels', time_us, items});
  }

  /** Sends who received whom. */
  sendPairs(items, time_us = 0) { this.send({op: 'links', time_us, items}); }

  /** The samples of a log, by a function of the script of time in s. */
  answerSeries(client, {id, channel, field, from_us, to_us, points}) {
    const t_us = [...Array(points).keys()].map((i) => from_us + (to_us - from_us) * i / (points - 1));
    this.sendTo(
        client, {op: 'series', id, t_us, values: t_us.map((t) => this.script.seriesAt(channel, field, t / 1e6))});
  }

  /** Ends as a run that ends does: says why, then goodbye. */
  async end(ended, log) {
    this.ended = ended;
    this.log = log;
    for (const client of this.clients) {
      this.sendStatus(client);
      client.socket.close(1001, 'the server ends');
    }
    while (this.clients.size > 0)
      await new Promise((resolve) => {
        setTimeout(resolve, 10);
      });
    await this.close();
  }

  sendStatus(client) {
    this.sendTo(client, {
      op: 'status',
      time_us: this.time_us,
      step: Math.round(this.time_us / 10000),
      branch: 0,
      paused: this.paused,
      speed: this.speed,
      rate: this.paused ? 0 : this.speed,
      waits_for: this.waits_for ?? '',
      ended: this.ended ?? null,
      log: this.log
    });
  }

  sendState(client, jump = false) {
    if (this.frozen || !client.greeted || client.unacknowledged >= 2) return;
    ++client.unacknowledged;
    const poses = this.script.posesAt(this.time_us / 1e6);
    client.socket.send(encodeState({
      sequence: ++this.sequence,
      time_us: this.time_us,
      revision: this.script.scene.revision,
      paused: this.paused,
      jump,
      speed: this.speed,
      poses,
    }));
  }

  tick() {
    const now_ms = performance.now();
    const passed_ms = now_ms - (this.ticked_ms ?? now_ms);
    this.ticked_ms = now_ms;
    if (!this.paused) {
      this.time_us += 1000 * passed_ms * this.speed;
      for (const client of this.clients) this.sendState(client);
    }
    if (now_ms - (this.told_ms ?? 0) < 500) return;
    this.told_ms = now_ms;
    for (const client of this.clients)
      if (client.greeted) this.sendStatus(client);
  }

  /** Sets the time and sends this one state. */
  show(time_us, jump = true) {
    this.time_us = time_us;
    for (const client of this.clients) this.sendState(client, jump);
  }
}
