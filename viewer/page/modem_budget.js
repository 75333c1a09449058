// SPDX-License-Identifier: BSD-3-Clause
// Budget of the acoustic modems: the share of the time in which each sends, and its bytes against its data rate.
import {fillTable, table} from './dock.js';
import {element, formatNumber} from './panels.js';

/** Rates are those of this simulated time. */
const WINDOW_US = 60e6;
const ROWS_MAX = 100;

/** Figures of a modem between two counts {time_us, count, bytes, sending_us}. */
export function budgetOf(from, to, data_rate_bps) {
  const passed_us = to.time_us - from.time_us;
  if (!(passed_us > 0)) return null;
  const bytes_per_min = (to.bytes - from.bytes) / passed_us * 60e6;
  return {
    share: (to.sending_us - from.sending_us) / passed_us,
    bytes_per_min,
    // Share of what the modem could carry if it sent data all the time.
    of_rate: data_rate_bps > 0 ? bytes_per_min * 8 / 60 / data_rate_bps : null,
  };
}

const percent = (share) => (share === null ? '–' : `${(100 * share).toFixed(share < 0.1 ? 1 : 0)} %`);

/** The table. */
export class ModemBudget {
  constructor(app) {
    this.app = app;
    this.root = element('section');
    this.table = table(
        'Budget of the modems',
        ['Modem', 'sending', 'bytes/min', 'of data rate', 'data rate, bit/s', 'messages', 'bytes', 'sent, s']);
    this.table.className = 'grid';
    this.root.append(element('h3', 'Modems: last minute, and sums'), this.table);
    this.clear();
  }

  clear() {
    this.modems = new Map();
    this.stale = true;
  }

  /** Takes a message `modems`: sums since the start. */
  set({time_us, items}) {
    if (!Number.isFinite(time_us)) return;
    const before = this.modems;
    this.modems = new Map();
    for (const item of (Array.isArray(items) ? items : []).slice(0, ROWS_MAX)) {
      if (typeof item?.name !== 'string') continue;
      const [count, bytes, sending_us] = [item.count, item.bytes, item.sending_us].map((one) => Number(one) || 0);
      const now = {time_us, count, bytes, sending_us};
      // A time that was set: the counts begin again.  A modem without counts has sent nothing.
      const marks = (before.get(item.name) ?? []).filter((mark) => mark.time_us < time_us && mark.count <= count);
      if (marks.length === 0) marks.push({time_us: this.start_us, count: 0, bytes: 0, sending_us: 0});
      marks.push(now);
      while (marks.length > 2 && marks[1].time_us <= time_us - WINDOW_US) marks.shift();
      this.modems.set(item.name, marks);
    }
    this.stale = true;
  }

  get start_us() { return Number(this.app.timeBar.hello.start_us) || 0; }

  /** Data rate of a modem by the scene; null: not known. */
  dataRate(name) {
    const rate = this.app.instruments.poses.byName.get(name)?.device.data_rate_bps;
    return Number.isFinite(rate) ? rate : null;
  }

  /** Figures of all modems, for the table and for tests. */
  rows() {
    return [...this.modems].sort((a, b) => (a[0] < b[0] ? -1 : 1)).map(([name, marks]) => {
      const data_rate_bps = this.dataRate(name), last = marks[marks.length - 1];
      return {name, data_rate_bps, ...last, budget: budgetOf(marks[0], last, data_rate_bps)};
    });
  }

  update() {
    if (!this.stale) return;
    this.stale = false;
    const rows = this.rows();
    this.root.hidden = rows.length === 0;
    fillTable(
        this.table,
        rows.map(
            ({name, budget, data_rate_bps, count, bytes, sending_us}) =>
                [name, percent(budget?.share ?? null), budget ? budget.bytes_per_min.toFixed(1) : '–',
                 percent(budget?.of_rate ?? null), data_rate_bps === null ? '–' : formatNumber(data_rate_bps),
                 formatNumber(count), formatNumber(bytes), (sending_us / 1e6).toFixed(1)]));
  }
}
