// SPDX-License-Identifier: BSD-3-Clause
// Measured ranges: a sphere about the receiver with the range as its radius, and the true distance as a dashed line.
import {soundSpeedAt} from './clocks.js';
import {Vector3} from './vendor/three.js';

const TYPES = ['usbl_t', 'lbl_t', 'range_beacon_t', 'acoustic_received_t'];
const RATE_HZ = 20;
const CHANNELS_MAX = 64;
const WAIT_MS = 500;
/** Ranges fade within this simulated time, or wall time where the run is faster. */
const SHOWN_US = 10e6;
const RANGES_MAX = 60;
const STEPS = 72;
const MEASURED = '#ff8c42', TRUE = '#2fd6a3';

/** Ranges of a message: [{to, range_m, at (measured position in the frame of the sensor, or null)}]. */
export function rangesOf({type, fields}, sound_speed_mps) {
  if (type === 'usbl_t') return [{to: fields.target, range_m: fields.range_m, at: fields.position_m ?? null}];
  if (type === 'acoustic_received_t')
    return [{to: fields.source, range_m: fields.travel_time_s * sound_speed_mps, at: null}];
  const names = fields.transponder ?? fields.beacon ?? [];
  return names.map((to, i) => ({to, range_m: fields.range_m?.[i], at: null}));
}

/** The ranges of the receivers of the selected vehicle, or of all. */
export class Ranges {
  constructor(app, poses) {
    this.app = app;
    this.poses = poses;
    this.clear();
  }

  clear() {
    this.ranges = new Map();
    this.pending = [];
  }

  rewind(time_us) {
    for (const [key, range] of this.ranges)
      if (range.time_us > time_us || range.time_us < time_us - SHOWN_US) this.ranges.delete(key);
  }

  /** Wants the channels of the devices that measure ranges. */
  subscribe(which, devices) {
    this.names = this.poses.channelsOf(devices, which, CHANNELS_MAX);
    this.app.channels.want('ranges', this.names, RATE_HZ, (message) => this.take(message));
    for (const [key, range] of this.ranges)
      if (!this.names.has(range.channel)) this.ranges.delete(key);
  }

  take(message) {
    if (!TYPES.includes(message.type)) return;
    this.pending.push({message, at_ms: performance.now()});
    if (this.pending.length > RANGES_MAX) this.pending.shift();
  }

  /** Places messages whose poses are known by now; returns true if anything changed. */
  update(now_ms) {
    const ready = ({message, at_ms}) => this.poses.reached(message.time_us) || now_ms - at_ms >= WAIT_MS;
    const due = this.pending.filter(ready);
    this.pending = this.pending.filter((one) => !due.includes(one));
    for (const {message} of due) this.add(message);
    return due.length > 0;
  }

  add(message) {
    const mounted = this.poses.byChannel.get(message.channel);
    if (!mounted || !this.names.has(message.channel) || this.poses.isFuture(message.time_us)) return;
    const time_us = this.poses.sampleTime(message, mounted);
    const X_WS = this.poses.sensorAt(mounted, time_us), center = new Vector3().setFromMatrixPosition(X_WS);
    const origin_m = this.app.data.origin_m;
    const c_mps = soundSpeedAt(this.app.data.water?.sound_speed, center.z + origin_m[2]);
    for (const {to, range_m, at} of rangesOf(message, c_mps)) {
      if (!(range_m > 0) || !Number.isFinite(range_m) || typeof to !== 'string') continue;
      // The signal left, or was answered, at the target before; light and radio need no time that matters.
      const travel_us = message.type === 'range_beacon_t' ? 0 : range_m / c_mps * 1e6;
      const target = this.poses.targetAt(to, time_us - travel_us);
      const true_m = target ? center.distanceTo(target) : null;
      const fix = at && at.every(Number.isFinite) ? new Vector3(...at).applyMatrix4(X_WS) : null;
      const name = `${mounted.vehicle} → ${to}`;
      this.ranges.delete(`${message.channel} ${to}`);
      this.ranges.set(
          `${message.channel} ${to}`,
          {channel: message.channel, name, time_us: message.time_us, center, range_m, target, true_m, fix});
    }
    while (this.ranges.size > RANGES_MAX) this.ranges.delete(this.ranges.keys().next().value);
  }

  /** Ranges not too old for a time, each with how fresh it is, 0 to 1. */
  shown(time_us) {
    const lasting_us = SHOWN_US * Math.max(1, Math.min(100, this.app.playback.newest?.speed ?? 1));
    const all =
        [...this.ranges.values()].map((range) => ({...range, fresh: 1 - (time_us - range.time_us) / lasting_us}));
    return all.filter((range) => range.fresh > 0 && range.fresh <= 1.05);
  }

  /** Draws on the canvas of the labels. */
  draw(labels, time_us) {
    for (const range of this.shown(time_us)) {
      const {center, range_m, target, true_m, fix} = range;
      labels.inked = true;
      labels.context.globalAlpha = 0.3 + 0.7 * Math.min(1, range.fresh);
      // The sphere: its circle in the level of the receiver, and two that stand on it.
      circle(labels, center, range_m, [1, 0, 0], [0, 1, 0], 2);
      circle(labels, center, range_m, [1, 0, 0], [0, 0, 1], 0.8);
      circle(labels, center, range_m, [0, 1, 0], [0, 0, 1], 0.8);
      labels.context.globalAlpha = 1;
      if (fix) {
        polyline(labels, [center, fix], MEASURED, 1.5, []);
        labels.text(fix, '✛ measured', {color: MEASURED, dy: 14});
      }
      if (!target) {
        labels.text(center, `○ ${range.name}: ${range_m.toFixed(2)} m`, {color: MEASURED, dy: 16});
        continue;
      }
      polyline(labels, [center, target], TRUE, 2, [6, 5]);
      const middle = center.clone().lerp(target, 0.5), error_m = range_m - true_m;
      const sign = error_m < 0 ? '−' : '+';
      labels.text(
          middle, `○ ${range_m.toFixed(2)} m ┄ true ${true_m.toFixed(2)} m  ${sign}${Math.abs(error_m).toFixed(2)}`,
          {color: MEASURED, dx: -40, dy: 14});
      // The end of the measured range towards the target.
      const end = target.clone().sub(center).setLength(range_m).add(center);
      dot(labels, end);
    }
  }
}

function polyline(labels, points, color, width_px, dash) {
  const c = labels.context;
  c.beginPath();
  let drawing = false;
  for (const point of points) {
    const at = labels.project(point, labels.camera);
    if (at) c[drawing ? 'lineTo' : 'moveTo'](at[0], at[1]);
    drawing = at !== null;
  }
  c.setLineDash(dash);
  c.strokeStyle = color;
  c.lineWidth = width_px;
  c.stroke();
  c.setLineDash([]);
}

/** A circle about a center in the plane of two unit vectors. */
function circle(labels, center, radius_m, u, v, width_px) {
  const points = [...Array(STEPS + 1).keys()].map((i) => {
    const angle = 2 * Math.PI * i / STEPS, cos = radius_m * Math.cos(angle), sin = radius_m * Math.sin(angle);
    return new Vector3(
        center.x + u[0] * cos + v[0] * sin, center.y + u[1] * cos + v[1] * sin, center.z + u[2] * cos + v[2] * sin);
  });
  polyline(labels, points, MEASURED, width_px, []);
}

function dot(labels, point) {
  const at = labels.project(point, labels.camera);
  if (!at) return;
  const c = labels.context;
  c.beginPath();
  c.arc(at[0], at[1], 4, 0, 2 * Math.PI);
  c.fillStyle = MEASURED;
  c.fill();
  c.lineWidth = 1;
  c.strokeStyle = '#ffffff';
  c.stroke();
}
