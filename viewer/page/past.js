// SPDX-License-Identifier: BSD-3-Clause
// The past of a run that continues: poses that the server kept, requested one at a time, and played back at a speed.
import {formatTime} from './panels.js';
import {Playback} from './playback.js';

/** A request that was not answered in this time is sent again. */
const PATIENCE_MS = 700;
/** Shortest time between two requests. */
const INTERVAL_MS = 30;
const $ = (id) => document.getElementById(id);

/** Sends requests `look`, one at a time, always the newest one. */
export class Looker {
  constructor(connection) {
    this.connection = connection;
    this.reset();
  }

  reset() {
    this.desired = this.requested = null;
    this.pending = false;
    this.requested_ms = -1e9;
  }

  /** Asks for a time of a branch; null: the present one. */
  request(time_us, branch = null) {
    this.desired = {time_us: Math.round(time_us), branch};
    this.send();
  }

  /** Takes note that an answer has come. */
  answered() {
    this.pending = false;
    this.send();
  }

  /** Sends what is desired, if the answer to the request before has come. */
  send(now_ms = performance.now()) {
    if (!this.desired || (this.pending && now_ms - this.requested_ms < PATIENCE_MS)) return;
    if (now_ms - this.requested_ms < INTERVAL_MS) return;
    const {time_us, branch} = this.desired;
    if (!this.pending && this.requested && this.requested.time_us === time_us && this.requested.branch === branch)
      return;
    this.connection.send({op: 'look', time_us, ...(branch === null ? {} : {branch})});
    this.requested = this.desired;
    this.requested_ms = now_ms;
    this.pending = true;
  }
}

/** What the page shows instead of the present while it looks back. */
export class Past {
  /** changed(): the page shows another time; newest_us(): time of the run. */
  constructor(connection, changed, newest_us) {
    this.connection = connection;
    this.changed = changed;
    this.newest_us = newest_us;
    this.looker = new Looker(connection);
    this.playback = new Playback();
    this.active = this.playing = false;
    this.time_us = 0;
    $('live').addEventListener('click', () => this.leave());
    $('replay').addEventListener('click', () => this.play(!this.playing));
  }

  /** Does the page show the past? */
  get shown() { return this.active && this.playback.newest !== null; }

  get speed() { return Number($('replay-speed').value) || 1; }

  /** Shows a time of the present branch, without touching the run. */
  look(time_us) {
    if (time_us >= this.newest_us()) return this.leave();
    this.time_us = time_us;
    if (!this.active) {
      this.active = true;
      this.playback.clear();
    }
    this.looker.request(time_us);
    this.show();
    return undefined;
  }

  /** Plays on from the time shown, or stops. */
  play(on) {
    this.playing = on && this.active;
    this.ticked_ms = performance.now();
    this.show();
  }

  /** Shows the present again. */
  leave() {
    if (!this.active) return;
    this.active = this.playing = false;
    this.looker.reset();
    this.connection.send({op: 'look', time_us: null});
    this.show();
    this.changed();
  }

  show() {
    for (const id of ['live', 'replay', 'replay-speed', 'past']) $(id).hidden = !this.active;
    $('status').hidden = this.active;  // room for the time line
    $('replay').textContent = this.playing ? 'Stop' : 'Play back';
  }

  /** Takes a state of the past; returns false if it was not requested. */
  take(state, now_ms) {
    if (!this.active) return false;
    const before = this.playback.newest;
    if (!before || before.time_us !== state.time_us) {
      const jump = !this.playing || !before || state.time_us < before.time_us;
      this.playback.push({...state, paused: !this.playing, jump}, now_ms);
      if (jump) this.changed();
    }
    this.looker.answered();
    return true;
  }

  /** Plays on, and asks again for what did not come; once per frame. */
  tick(now_ms) {
    if (!this.active) return;
    if (this.playing) {
      this.time_us += 1000 * this.speed * Math.max(0, now_ms - this.ticked_ms);
      this.ticked_ms = now_ms;
      if (this.time_us >= this.newest_us()) return this.leave();
      this.looker.request(this.time_us);
    }
    this.looker.send(now_ms);
    const text = `past; run at ${formatTime(this.newest_us())}`;
    if ($('past').textContent !== text) $('past').textContent = text;
    return undefined;
  }

  /** Asks again for the time shown: the scene has other bodies. */
  renew() {
    this.playback.clear();
    this.looker.requested = null;
    this.looker.pending = false;
  }

  /** Forgets everything: another run. */
  clear() {
    this.active = this.playing = false;
    this.playback.clear();
    this.looker.reset();
    this.show();
  }
}
