// SPDX-License-Identifier: BSD-3-Clause
// The clocks of vehicles: error, drift, whether something disciplines them, and the range error that they cause.
import {fillTable, table} from './dock.js';
import {element, formatNumber} from './panels.js';

const RATE_HZ = 2;
const SOUND_SPEED_MPS = 1500;
const NAMES_MAX = 12;
const HEADS =
    ['Clock', 'Offset, ms', 'Drift, ppm', 'Disciplined', 'Since fix, s', 'Estimated σ, ms', 'Range error c·Δt, m'];

/** Sound speed of a profile at a height: linear between its rows. */
export function soundSpeedAt(profile, z_m) {
  if (!profile?.length) return SOUND_SPEED_MPS;
  const rows = [...profile].sort((a, b) => b[0] - a[0]);
  if (z_m >= rows[0][0]) return rows[0][1];
  const next = rows.findIndex(([z]) => z <= z_m);
  if (next < 0) return rows[rows.length - 1][1];
  const [[z0, c0], [z1, c1]] = [rows[next - 1], rows[next]];
  return c0 + (c1 - c0) * (z_m - z0) / (z1 - z0);
}

const finite = (value) => (Number.isFinite(value) ? value : null);

/** Figures of the newest status of a clock; numbers that are not known are null. */
export function clockFigures({fields}, sound_speed_mps) {
  const error_s = finite(fields.error_s), std_s = finite(fields.estimated_std_s);
  // Without the truth channel the error is the one that the clock itself estimates.
  const used_s = error_s ?? std_s;
  return {
    offset_ms: error_s === null ? null : 1000 * error_s,
    drift_ppm: error_s === null || finite(fields.rate_error) === null ? null : 1e6 * fields.rate_error,
    disciplined: Boolean(fields.disciplined),
    since_fix_s: fields.since_fix_s >= 0 ? fields.since_fix_s : null,
    std_ms: std_s === null ? null : 1000 * std_s,
    range_error_m: used_s === null ? null : used_s * sound_speed_mps,
    estimated: error_s === null,
  };
}

/** The table of clocks. */
export class Clocks {
  constructor(app) {
    this.app = app;
    this.name = 'clocks';
    this.title = 'Clocks';
    this.root = element('div');
    this.empty = element('p', '', 'quiet');
    this.table = table('Clocks of vehicles', HEADS);
    this.table.className = 'grid';
    this.note = element(
        'p',
        '± : from the standard deviation that the clock itself estimates; its true error needs the truth channel of the clock.',
        'quiet');
    this.hidden = element('p', '', 'quiet');
    this.root.append(this.empty, this.table, this.hidden, this.note);
    this.open = false;
  }

  setOpen(open) {
    this.open = open;
    this.changed();
  }

  /** One channel for each clock: that with the true error where there is one. */
  changed() {
    const rows = this.open ? this.app.channels.ofTypes(['clock_status_t']) : [];
    const names = rows.map((row) => row.name);
    this.names = names.filter((name) => !names.includes(`${name}.truth`));
    this.app.channels.want('clocks', this.names, RATE_HZ, () => {
      this.stale = true;
    });
    this.stale = true;
  }

  /** Sound speed at a vehicle. */
  soundSpeed(channel) {
    const {data, byName, channels} = this.app;
    const vehicle = byName?.get(channels.byName.get(channel)?.vehicle);
    return soundSpeedAt(data?.water?.sound_speed, vehicle ? vehicle.at.z + data.origin_m[2] : 0);
  }

  /** What to say of vehicles with a clock that no device reports. */
  hiddenText() {
    const {data, channels} = this.app;
    const reported = new Set(this.names.map((name) => channels.byName.get(name)?.vehicle));
    const names =
        (data?.vehicles ?? []).filter((one) => one.own_clock && !reported.has(one.name)).map(({name}) => name);
    if (names.length === 0) return '';
    const shown = names.slice(0, NAMES_MAX).join(', ') + (names.length > NAMES_MAX ? ', …' : '');
    const have = names.length === 1 ? '1 vehicle has its own clock' : `${names.length} vehicles have their own clocks`;
    return `${have} without a device that reports it (${
        shown}); add {name: clock, type: clock, truth: true} to 'devices' of the vehicle to see it here.`;
  }

  update() {
    if (!this.stale) return;
    this.stale = false;
    this.hidden.textContent = this.hiddenText();
    this.hidden.hidden = this.hidden.textContent === '';
    this.empty.hidden = this.names.length > 0 || !this.hidden.hidden;
    // Logs of versions before own_clock do not say which clocks there are.
    const isKnown = this.app.data?.vehicles.every((one) => one.own_clock === false);
    this.empty.textContent = isKnown ? 'No vehicle of this run has its own clock: all keep true time.' :
                                       'No device of this run reports the clock of its vehicle.';
    this.table.hidden = this.names.length === 0;
    let estimated = false;
    fillTable(this.table, this.names.map((name) => {
      const message = this.app.channels.newest.get(name), title = name.replace(/\.truth$/, '');
      if (!message) return [title, ...HEADS.slice(1).map(() => '…')];
      const figures = clockFigures(message, this.soundSpeed(name));
      estimated ||= figures.estimated;
      const sign = element('span', figures.disciplined ? '✓ yes' : '✕ no', figures.disciplined ? 'holds' : 'fails');
      const error = figures.range_error_m === null ? '–' : formatNumber(figures.range_error_m);
      return [
        title, formatNumber(figures.offset_ms), formatNumber(figures.drift_ppm), sign,
        formatNumber(figures.since_fix_s), formatNumber(figures.std_ms),
        figures.estimated && error !== '–' ? `± ${error}` : error
      ];
    }));
    this.note.hidden = !estimated;
  }
}
