// SPDX-License-Identifier: BSD-3-Clause
// The states received last, and the poses drawn from them: 100 ms behind, interpolated, so that motion is smooth.

const DELAY_MS = 100;
const KEPT = 32;
/** Above this speed, and while paused, the newest state is drawn as it is. */
const SPEED_MAX = 4;

/** Buffer of states; sample() gives the poses for a wall time. */
export class Playback {
  constructor() { this.clear(); }

  /** Forgets all states: another scene. */
  clear() {
    this.states = [];
    this.time_us = 0;
    this.poses = new Float32Array(0);
    this.version = 0;
    this.drawn = null;
  }

  /** Adds a state that arrived at a wall time. */
  push(state, wall_ms) {
    const last = this.newest;
    if (last && (state.jump || state.time_us < last.time_us || state.poses.length !== last.poses.length))
      this.states.length = 0;
    this.states.push({...state, wall_ms});
    if (this.states.length > KEPT) this.states.shift();
  }

  get newest() { return this.states[this.states.length - 1] ?? null; }

  /** Computes time_us and poses for a wall time; returns true if they changed. */
  sample(wall_ms) {
    const newest = this.newest;
    if (!newest) return false;
    const last = this.states.length - 1;
    let i = last;
    // Speed by the states themselves: the chosen speed may be unlimited.
    const before = this.states[Math.max(0, last - 5)];
    const rate = (newest.time_us - before.time_us) / 1000 / Math.max(1, newest.wall_ms - before.wall_ms);
    const smooth = !newest.paused && !newest.jump && rate <= SPEED_MAX;
    const wanted_ms = wall_ms - DELAY_MS;
    if (smooth)
      while (i > 0 && this.states[i].wall_ms > wanted_ms) --i;
    const a = this.states[i], b = this.states[Math.min(i + 1, last)];
    const span_ms = b.wall_ms - a.wall_ms;
    const share = smooth && span_ms > 0 ? Math.min(1, Math.max(0, (wanted_ms - a.wall_ms) / span_ms)) : 0;
    // Skip the work if the same state is drawn again.
    const drawn = share === 0 ? a : share === 1 ? b : null;
    if (drawn && drawn === this.drawn) return false;
    this.drawn = drawn;
    this.time_us = a.time_us + share * (b.time_us - a.time_us);
    this.interpolate(a.poses, b.poses, share);
    ++this.version;
    return true;
  }

  /** Pose x, y, z, qx, qy, qz, qw of a movable body at a time within the buffer; null outside of it. */
  poseAt(body, time_us) {
    const next = this.states.findIndex((state) => state.time_us >= time_us);
    if (next < 0 || (next === 0 && this.states[0].time_us > time_us)) return null;
    const b = this.states[next], a = this.states[Math.max(0, next - 1)];
    const share = b.time_us > a.time_us ? (time_us - a.time_us) / (b.time_us - a.time_us) : 1;
    const pose = b.poses.slice(7 * body, 7 * body + 7);
    const from = a.poses.subarray(7 * body, 7 * body + 7);
    let dot = 0;
    for (let k = 3; k < 7; ++k) dot += from[k] * pose[k];
    let sum = 0;
    for (let k = 0; k < 7; ++k) {
      pose[k] = (1 - share) * from[k] + (k > 2 && dot < 0 ? -share : share) * pose[k];
      if (k > 2) sum += pose[k] * pose[k];
    }
    for (let k = 3; k < 7; ++k) pose[k] /= Math.sqrt(sum || 1);
    return pose;
  }

  interpolate(a, b, share) {
    if (this.poses.length !== a.length) this.poses = new Float32Array(a.length);
    mix(a, b, share, this.poses);
  }
}

/** Writes poses between two into `to`; share: 0 is a, 1 is b. */
export function mix(a, b, share, to) {
  if (share === 0 || share === 1) {
    to.set(share === 0 ? a : b);
    return;
  }
  const rest = 1 - share;
  for (let i = 0; i < to.length; i += 7) {
    for (let k = i; k < i + 3; ++k) to[k] = rest * a[k] + share * b[k];
    // Quaternion: linear, on the shorter arc, then normalized; states are close together.
    const dot = a[i + 3] * b[i + 3] + a[i + 4] * b[i + 4] + a[i + 5] * b[i + 5] + a[i + 6] * b[i + 6];
    const other = dot < 0 ? -share : share;
    let sum = 0;
    for (let k = i + 3; k < i + 7; ++k) {
      to[k] = rest * a[k] + other * b[k];
      sum += to[k] * to[k];
    }
    const scale = 1 / Math.sqrt(sum || 1);
    for (let k = i + 3; k < i + 7; ++k) to[k] *= scale;
  }
}
