// SPDX-License-Identifier: BSD-3-Clause
// The bar at the bottom: pause, step, speed; the time line of a log, or rewinding a run.
import {formatTime} from './panels.js';

const RUN_SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4, 8, 16, 32, 0];
const LOG_SPEEDS = [0.01, 0.1, 0.25, 0.5, 1, 2, 4, 8, 16, 64, 256, 1000];
const $ = (id) => document.getElementById(id);

/** Bar of the time; it sends requests through a Connection. */
export class TimeBar {
  constructor(connection, toast) {
    this.connection = connection;
    this.toast = toast;
    this.hello = {source: 'run', control: false};
    this.status = {paused: false, speed: 1};
    this.dragging = false;
    this.wanted_us = this.rewind_us = null;
    this.newest_us = this.shown_us = 0;
    this.requests = new Map();
    this.listen();
    this.setHello(this.hello);
  }

  listen() {
    $('play').addEventListener('click', () => this.togglePlay());
    $('step1').addEventListener('click', () => this.step(1));
    $('step10').addEventListener('click', () => this.step(10));
    $('speed').addEventListener('change', () => this.setSpeed(Number($('speed').value)));
    $('loop').addEventListener('change', () => this.play({}));
    $('seek').addEventListener('input', () => {
      this.dragTo(Number($('seek').value) * 1000);
    });
    $('seek').addEventListener('change', () => {
      if (this.isLog) this.dragging = false;
    });
    $('rewind').addEventListener('click', () => this.rewind());
    $('branch').addEventListener(
        'click', () => this.request('branch', 0, this.hello.may_launch ? $('branch-programs').value : ''));
    $('cancel').addEventListener('click', () => this.endRewind());
  }

  /** Takes a time picked on the line: a log goes there at once, a run offers to rewind. */
  dragTo(wanted_us) {
    this.wanted_us = wanted_us;
    if (this.hello.past) return this.past.look(wanted_us);
    this.dragging = this.isLog || wanted_us < this.shown_us;
    if (this.isLog) this.connection.send({op: 'seek', time_us: wanted_us});
    if (!this.isLog && this.dragging)
      this.offerRewind();
    else if (!this.isLog)
      this.endRewind();
    $('time').textContent = formatTime(wanted_us);
    return undefined;
  }

  /** Goes to a time that was picked elsewhere: in a plot, in a list. */
  goTo(wanted_us) {
    if (!this.hello.control) return;
    $('seek').value = Math.round(wanted_us / 1000);
    this.dragTo(wanted_us);
    if (this.isLog) this.dragging = false;
  }

  get isLog() { return this.hello.source === 'log'; }

  /** Takes what the server is and whether this page may steer it. */
  setHello(hello) {
    this.hello = hello;
    const may = hello.control === true;
    for (const id of ['play', 'speed', 'seek', 'loop']) $(id).disabled = !may;
    for (const id of ['step1', 'step10']) $(id).disabled = !may || this.isLog;
    for (const id of ['step1', 'step10']) $(id).hidden = this.isLog;
    $('loop-label').hidden = !this.isLog;
    const choices = this.isLog ? LOG_SPEEDS : RUN_SPEEDS;
    $('speed').replaceChildren(...choices.map((speed) => new Option(speed === 0 ? 'max' : `${speed}×`, speed)));
    this.showSpeed();  // a server that introduces itself again does not repeat an equal status
    if (hello.past) $('seek').disabled = false;  // whoever may read may look
    $('branch').hidden = !may || hello.record !== 'recorded';
    $('branch-programs').hidden = $('branch').hidden || hello.may_launch !== true;
    $('badge').hidden = may && !this.isLog;
    $('badge').textContent = may ? 'log' : 'read-only';
    $('badge').title =
        may ? String(hello.name ?? '') : 'To steer, open the whole address that shoal printed, with #t=... at its end';
    this.endRewind();
  }

  /** Takes the time of the newest state. */
  setNewest(time_us) { this.newest_us = time_us; }

  /** Takes a message `status`. */
  setStatus(status) {
    this.status = status;
    $('play').firstElementChild.textContent = status.paused ? '▶' : '❚❚';
    $('play').setAttribute('aria-label', status.paused ? 'Continue' : 'Pause');
    this.showSpeed();
    this.rewindIfPaused();
    this.describe();
  }

  showSpeed() {
    const speed = this.status.speed ?? 0;
    const known = [...$('speed').options].some((option) => Number(option.value) === speed);
    if (!known) $('speed').append(new Option(`${+ speed.toPrecision(3)}×`, speed));
    if (document.activeElement !== $('speed')) $('speed').value = String(speed);
  }

  describe() {
    const {status} = this;
    const parts = [];
    if (status.ended)
      parts.push(`ended: ${status.ended}`);
    else if (status.paused)
      parts.push('paused');
    else if (Number.isFinite(status.rate))
      parts.push(`runs at ${+ status.rate.toPrecision(2)}×`);
    if (this.hello.programs) parts.push(`programs: ${this.hello.programs}`);
    if (status.waits_for) parts.push(status.waits_for);
    if (status.branch) parts.push(`branch ${status.branch}`);
    if (Number.isFinite(status.step)) parts.push(`step ${status.step}`);
    const text = parts.join(' · ');
    if ($('status').textContent !== text) $('status').textContent = text;
    $('status').title = text;
  }

  /** Shows a time. */
  update(time_us) {
    if (this.dragging) return;
    this.shown_us = time_us;
    if (this.hello.past) this.offerRewindToPast(time_us);
    const text = formatTime(time_us);
    if ($('time').textContent !== text) $('time').textContent = text;
    // The line of a run ends now, that of a log at its end.
    const start_us = this.hello.start_us ?? 0, end_us = Math.max(this.hello.end_us ?? time_us, start_us + 1000);
    const seek = $('seek');
    seek.min = Math.floor(start_us / 1000);
    const last_us = this.isLog ? end_us : Math.max(end_us, time_us, this.newest_us);
    seek.max = Math.ceil(last_us / 1000);
    this.marks?.draw(start_us, last_us);
    seek.value = Math.round(time_us / 1000);
    seek.setAttribute('aria-valuetext', text);
  }

  request(command, value = 0, text = '') {
    if (!this.hello.control) {
      this.toast('read-only: open the address with the token to steer the run');
      return;
    }
    this.requests.set(this.connection.control(command, value, text), command);
  }

  /** Takes the answer to a request. */
  reply(message) {
    const command = this.requests.get(message.id);
    this.requests.delete(message.id);
    if (!message.ok) this.toast(`${command ?? 'request'}: ${message.text}`);
  }

  play(change) {
    const speed = Number($('speed').value) || 1;
    this.connection.send({op: 'play', speed, paused: this.status.paused, loop: $('loop').checked, ...change});
  }

  togglePlay() {
    if (this.isLog)
      this.play({paused: !this.status.paused});
    else
      this.request(this.status.paused ? 'resume' : 'pause');
  }

  step(count) {
    if (!this.isLog) this.request('step', count);
  }

  setSpeed(speed) {
    if (this.isLog)
      this.play({speed});
    else
      this.request('speed', speed);
  }

  /** Shows a time: of a log, or of the past of a run. */
  goTo(time_us) {
    if (this.isLog)
      this.connection.send({op: 'seek', time_us});
    else if (this.hello.past)
      this.past.look(time_us);
  }

  /** Moves a log, or the past of a run, by some seconds. */
  skip(seconds) {
    if (!this.isLog && this.past.active)
      this.past.look(Math.max(this.hello.start_us ?? 0, this.shown_us + seconds * 1e6));
    if (!this.isLog) return;
    const wanted_us = Math.max(this.hello.start_us ?? 0, Number($('seek').value) * 1000 + seconds * 1e6);
    this.connection.send({op: 'seek', time_us: Math.min(wanted_us, this.hello.end_us ?? wanted_us)});
  }

  /** Rewinds the run to the time picked.  A request gives the seconds back from the present: the run pauses first. */
  rewind() {
    this.rewind_us = this.hello.past ? this.shown_us : this.wanted_us;
    this.endRewind();
    this.past?.leave();
    if (!this.status.paused) this.request('pause');
    this.rewindIfPaused();
  }

  rewindIfPaused() {
    if (this.rewind_us === null || !this.status.paused) return;
    const back_us = Math.max(this.newest_us, this.status.time_us ?? 0) - this.rewind_us;
    this.rewind_us = null;
    if (back_us > 0) this.request('rewind', back_us / 1e6);
  }

  /** While the past of a run is shown, the run can be rewound to it. */
  offerRewindToPast(time_us) {
    const may = this.past.shown && this.hello.control === true;
    $('rewind').hidden = !may;
    const text = `Rewind to ${formatTime(time_us)}`;
    if (may && $('rewind').textContent !== text) $('rewind').textContent = text;
  }

  offerRewind() {
    $('rewind').hidden = $('cancel').hidden = false;
    $('rewind').textContent = `Rewind to ${formatTime(this.wanted_us)}`;
  }

  endRewind() {
    this.dragging = false;
    $('rewind').hidden = $('cancel').hidden = true;
  }
}
