// SPDX-License-Identifier: BSD-3-Clause
// Client of Foxglove's WebSocket protocol, by its reference library: subscribes to every topic and decodes each message
// by the schema that was advertised with it.
import protocol from "@foxglove/ws-protocol";
import { request } from "node:http";
import { spawn } from "node:child_process";
import WebSocket from "ws";

import { decoderOf } from "./decoder.mjs";

export const sdk = "foxglove.sdk.v1";
export const older = "foxglove.websocket.v1";

export function check(condition, text) {
  if (!condition) throw new Error(text);
}

/** Waits for a condition, no longer than `seconds`. */
export async function until(condition, what, seconds = 30) {
  const end = Date.now() + 1000 * seconds;
  for (;;) {
    const value = condition();
    if (value) return value;
    if (Date.now() > end) throw new Error(`${what}: not within ${seconds} s`);
    await new Promise((resolve) => setTimeout(resolve, 10));
  }
}

/** Runs shoal until end(); `port` is that of its page. */
export class Server {
  constructor(shoal, args) {
    this.name = args.join(" ");
    this.output = "";
    this.child = spawn(shoal, args, { stdio: ["ignore", "pipe", "pipe"] });
    for (const stream of [this.child.stdout, this.child.stderr]) {
      stream.setEncoding("utf8");
      stream.on("data", (text) => (this.output += text));
    }
    this.exit = new Promise((resolve) => this.child.on("close", (code) => resolve((this.code = code ?? -1))));
  }
  async open() {
    const found = await until(() => {
      check(this.code === undefined, `${this.name}: exit ${this.code}\n${this.output}`);
      return /live page: http:\/\/127\.0\.0\.1:(\d+)\/#t=(\S+)/.exec(this.output);
    }, `${this.name}: the address of the page`, 60);
    this.port = Number(found[1]);
    this.token = found[2];
    return this;
  }
  async end() {
    if (this.code === undefined) this.child.kill("SIGINT");
    return this.exit;
  }
}

/** Status of an upgrade that is refused, or 101. */
export function upgradeStatus(port, protocols, origin) {
  return new Promise((resolve, reject) => {
    const headers = {
      Connection: "Upgrade",
      Upgrade: "websocket",
      "Sec-WebSocket-Version": "13",
      "Sec-WebSocket-Key": "dGhlIHNhbXBsZSBub25jZQ==",
    };
    if (protocols !== undefined) headers["Sec-WebSocket-Protocol"] = protocols;
    if (origin !== undefined) headers.Origin = origin;
    const made = request({ host: "127.0.0.1", port, path: "/", headers });
    made.on("response", (response) => resolve({ status: response.statusCode, response: response.resume() }));
    made.on("upgrade", (response, socket) => {
      socket.destroy();
      resolve({ status: 101, protocol: response.headers["sec-websocket-protocol"] });
    });
    made.on("error", reject);
    made.end();
  });
}

export class Viewer {
  constructor(port, protocols = [sdk, older]) {
    this.socket = new WebSocket(`ws://127.0.0.1:${port}`, protocols);
    this.client = new protocol.FoxgloveClient({ ws: this.socket });
    this.topics = new Map(); // by name: {channel, messages, last, lastTime}
    this.bySubscription = new Map();
    this.services = new Map();
    this.statuses = [];
    this.parameters = [];
    this.times = [];
    this.errors = [];
    this.playback = [];
    this.messages = 0;
    this.selects = () => true;
    this.client.on("error", (error) => this.errors.push(error.message));
    this.client.on("serverInfo", (info) => (this.info = info));
    this.client.on("status", (status) => this.statuses.push(status));
    this.client.on("time", ({ timestamp }) => this.times.push(timestamp));
    this.client.on("advertise", (channels) => channels.forEach((channel) => this.add(channel)));
    this.client.on("advertiseServices", (services) => services.forEach((each) => this.services.set(each.name, each)));
    this.client.on("parameterValues", (values) => this.parameters.push(values));
    this.client.on("message", (event) => this.take(event));
    this.socket.on("message", (data, isBinary) => {
      // A playback state, which the library does not know.
      const bytes = Buffer.from(data);
      if (isBinary && bytes[0] === 5) this.playback.push(bytes);
    });
    this.closed = new Promise((resolve) => this.socket.on("close", (code) => resolve((this.closeCode = code))));
  }
  async open() {
    await until(() => {
      check(this.closeCode === undefined, `closed: ${this.closeCode}: ${this.errors.join("; ")}`);
      return this.info;
    }, "serverInfo");
    check(Array.isArray(this.info.capabilities) && this.info.capabilities.includes("time"), "capability time");
    return this;
  }
  /** The rules of PlotJuggler, which takes nothing else: CDR, ros2msg, a schema; and of Lichtblick: no topic twice. */
  add(channel) {
    try {
      check(channel.encoding === "cdr" && channel.schemaEncoding === "ros2msg", `${channel.topic}: encoding`);
      check(channel.schema.length > 0 && /^\w+\/msg\/\w+$/.test(channel.schemaName), `${channel.topic}: schema`);
      check(!this.topics.has(channel.topic), `${channel.topic}: advertised twice`);
      const decode = decoderOf({ name: channel.schemaName, data: new TextEncoder().encode(channel.schema) });
      const topic = { channel, decode, messages: 0, kept: [] };
      this.topics.set(channel.topic, topic);
      if (this.selects(channel.topic)) this.subscribe(topic);
    } catch (error) {
      this.errors.push(`${channel.topic}: ${error.message}`);
    }
  }
  subscribe(topic) {
    this.bySubscription.set(this.client.subscribe(topic.channel.id), topic);
  }
  take({ subscriptionId, timestamp, data }) {
    const topic = this.bySubscription.get(subscriptionId);
    try {
      check(topic !== undefined, `message of an unknown subscription ${subscriptionId}`);
      topic.last = topic.decode(new Uint8Array(data.buffer, data.byteOffset, data.byteLength));
      topic.lastTime = timestamp;
      if (topic.kept.length < 100) topic.kept.push({ timestamp, message: topic.last });
      ++topic.messages;
      ++this.messages;
    } catch (error) {
      this.errors.push(`${topic?.channel.topic}: ${error.message}`);
    }
  }
  /** Waits for a topic with a message. */
  async topic(name, messages = 1) {
    return until(() => {
      this.checkErrors();
      const topic = this.topics.get(name);
      return topic?.messages >= messages && topic;
    }, `topic ${name}`);
  }
  checkErrors() {
    check(this.errors.length === 0, this.errors.slice(0, 5).join("; "));
    check(this.closeCode === undefined, `closed with ${this.closeCode}`);
  }
  /** Calls a service; its response, or an error. */
  async call(name, encoding, payload) {
    const service = this.services.get(name) ?? { id: 99 };
    const callId = (this.calls = (this.calls ?? 0) + 1);
    return new Promise((resolve, reject) => {
      const timer = setTimeout(() => reject(new Error(`${name}: no answer`)), 20_000);
      const done = (answer) => {
        if (answer.callId !== callId) return;
        clearTimeout(timer);
        this.client.off("serviceCallResponse", done);
        this.client.off("serviceCallFailure", done);
        resolve(answer);
      };
      this.client.on("serviceCallResponse", done);
      this.client.on("serviceCallFailure", done);
      this.client.sendServiceCallRequest({
        serviceId: service.id,
        callId,
        encoding,
        data: new DataView(payload.buffer, payload.byteOffset, payload.byteLength),
      });
    });
  }
  /** Sends a playback request; the state that answers it. */
  async play({ plays, speed = 1, seek, id }) {
    const name = Buffer.from(id);
    const bytes = Buffer.alloc(19 + name.length);
    bytes.writeUInt8(3, 0);
    bytes.writeUInt8(plays ? 0 : 1, 1);
    bytes.writeFloatLE(speed, 2);
    bytes.writeUInt8(seek === undefined ? 0 : 1, 6);
    bytes.writeBigUInt64LE(seek ?? 0n, 7);
    bytes.writeUInt32LE(name.length, 15);
    name.copy(bytes, 19);
    this.socket.send(bytes);
    const found = await until(
      () => this.playback.find((each) => each.subarray(19).toString() === id),
      `playback state ${id}`,
    );
    return {
      status: found.readUInt8(1),
      now: found.readBigUInt64LE(2),
      speed: found.readFloatLE(10),
      didSeek: found.readUInt8(14) === 1,
    };
  }
  close() {
    this.socket.close();
    return this.closed;
  }
}
