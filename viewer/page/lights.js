// SPDX-License-Identifier: BSD-3-Clause
// Lights of vehicles: the colors of the parts that show them, as their devices report them.
const RATE_HZ = 25;
const CHANNELS_MAX = 64;

/** Colors of a report by the names of the parts, as VEHICLE/BODY/PART. */
export function colorsOf({fields}, vehicle) {
  const colors = [...fields.color ?? []], parts = fields.part ?? [];
  return parts.map((part, i) => [`${vehicle}/${part}`, Number(colors[i]) & 0xffffff]);
}

/** The lights of all vehicles. */
export class Lights {
  constructor(app, poses) {
    this.app = app;
    this.poses = poses;
    this.clear();
  }

  clear() {
    this.colors = new Map();
    this.changed = true;
  }

  /** Lights that were never switched have no report: the parts get their own colors back. */
  rewind() { this.clear(); }

  subscribe() {
    const names = this.poses.channelsOf(['led'], 'all', CHANNELS_MAX);
    this.app.channels.want('lights', names, RATE_HZ, (message) => this.take(message));
  }

  take(message) {
    const mounted = this.poses.byChannel.get(message.channel);
    if (!mounted || message.type !== 'led_t') return;
    for (const [part, color] of colorsOf(message, mounted.vehicle)) {
      if (this.colors.get(part) === color) continue;
      this.colors.set(part, color);
      this.changed = true;
    }
  }

  /** Paints the parts; returns true if anything changed. */
  update() {
    if (!this.changed) return false;
    this.changed = false;
    this.app.bodies.paint(this.colors);
    return true;
  }
}
