// SPDX-License-Identifier: BSD-3-Clause
// The WebSocket to the server: opens it again after 1, 2, 4, 8 s, and tells how fresh its data are.
import {decodeMessage} from './messages.js';
import {decodeState, parseMessage, ProtocolError} from './protocol.js';

const PROTOCOL = 'shoal.view.v1';
const RETRY_S = [1, 2, 4, 8];
/** A server sends a status every second; after this time without any message it is said not to answer. */
const SILENCE_MS = 3000;
/** Close code of a server that ends (RFC 6455, 7.4.1). */
const GOING_AWAY = 1001;

/**
 * Connection to the server.  Events: handlers.state(state), handlers.message(object), handlers.data(message of a
 * channel), handlers.problem(text).
 */
export class Connection {
  constructor(url, token, handlers) {
    this.url = url;
    this.token = token;
    this.handlers = handlers;
    this.socket = null;
    this.everOpened = false;
    this.lostAt_ms = null;
    this.heardAt_ms = performance.now();
    this.attempts = 0;
    this.unacknowledged = [];
    this.nextId = 1;
    this.ended = null;  // why the run has ended, as its status says
    this.log = '';
    this.closed = false;  // by a server that said goodbye
    document.addEventListener('visibilitychange', () => {
      this.heardAt_ms = performance.now();
    });
    this.open();
  }

  /** Tries to connect now. */
  open() {
    clearTimeout(this.timer);
    const socket = new WebSocket(this.url, PROTOCOL);
    socket.binaryType = 'arraybuffer';
    socket.onopen = () => {
      this.everOpened = true;
      this.lostAt_ms = this.ended = null;
      this.closed = false;
      this.attempts = 0;
      this.heardAt_ms = performance.now();
      this.unacknowledged = [];
      this.send({op: 'hello', token: this.token});
    };
    socket.onmessage = (event) => this.receive(event.data);
    socket.onclose = (event) => {
      this.closed ||= event.code === GOING_AWAY;
      this.lost();
    };
    this.socket = socket;
  }

  lost() {
    this.lostAt_ms ??= performance.now();
    const wait_s = RETRY_S[Math.min(this.attempts++, RETRY_S.length - 1)];
    this.retryAt_ms = performance.now() + 1000 * wait_s;
    this.timer = setTimeout(() => this.open(), 1000 * wait_s);
  }

  receive(data) {
    this.heardAt_ms = performance.now();
    try {
      if (data instanceof ArrayBuffer && data.byteLength > 0 && new Uint8Array(data)[0] === 2) {
        this.handlers.data(decodeMessage(data));
      } else if (data instanceof ArrayBuffer) {
        const state = decodeState(data);
        if (!state.past) this.unacknowledged.push(state.sequence);
        if (!document.hidden) this.acknowledge();
        this.handlers.state(state);
      } else {
        this.handlers.message(parseMessage(data));
      }
    } catch (error) {
      if (!(error instanceof ProtocolError)) throw error;
      this.handlers.problem(error.message);
    }
  }

  /**
   * Acknowledges the states received since the last call: at once, even where frames take longer than states.  A hidden
   * page draws no frame and asks for no more.
   */
  acknowledge() {
    for (const sequence of this.unacknowledged) this.send({op: 'ack', sequence});
    this.unacknowledged.length = 0;
  }

  /** Sends a message; without a connection it is dropped. */
  send(message) {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }

  /** Sends a request to steer the run; returns its id. */
  control(command, value = 0, text = '') {
    const id = this.nextId++;
    this.send({op: 'control', id, command, value, text});
    return id;
  }

  get isOpen() { return this.socket?.readyState === WebSocket.OPEN; }

  /** Seconds since the last message, or since the connection was lost; 0 while data arrive. */
  staleFor_s(now_ms = performance.now()) {
    if (this.lostAt_ms !== null) return (now_ms - this.lostAt_ms) / 1000;
    const silent_ms = now_ms - this.heardAt_ms;
    return this.everOpened && !document.hidden && silent_ms > SILENCE_MS ? silent_ms / 1000 : 0;
  }

  /** Takes a message `status`. */
  setStatus({ended, log}) {
    this.ended = ended ?? null;
    this.log = String(log ?? '');
  }

  /** Has the server ended in an orderly way, so that nothing is wrong? */
  get isOver() { return this.lostAt_ms !== null && (this.ended !== null || this.closed); }

  /** Text of the banner; empty while all is well. */
  banner(time_text, now_ms = performance.now()) {
    const stale_s = this.staleFor_s(now_ms);
    if (stale_s === 0) return '';
    const shown = this.everOpened ? `, showing t = ${time_text}` : '';
    if (this.isOver && this.ended !== null)
      return `the run has ended (${this.ended})${shown}${this.log ? `; its log: ${this.log}` : ''}`;
    if (this.isOver) return `the server has ended${shown}`;
    if (this.lostAt_ms === null) return `no data for ${stale_s.toFixed(0)} s: the server does not answer${shown}`;
    return this.everOpened ? `disconnected since ${stale_s.toFixed(0)} s${shown}` : 'no server answers; trying again';
  }
}
