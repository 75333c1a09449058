// SPDX-License-Identifier: BSD-3-Clause
// Traffic: messages and bytes per second of each vehicle and channel, and who received whom.
import {fillTable, table} from './dock.js';
import {ModemBudget} from './modem_budget.js';
import {element, formatNumber} from './panels.js';
import {OUTCOMES} from './sounds.js';

const ROWS_MAX = 400;
const NAMES_MAX = 40;

/** Writes a rate with few digits; null: not known yet. */
function rate(value) { return value === null ? '–' : value < 10 ? value.toFixed(1) : value.toFixed(0); }

/** Writes a number of bytes. */
export function formatBytes(bytes) {
  if (bytes === null) return '–';
  for (const [size, unit] of [[1e9, 'GB'], [1e6, 'MB'], [1e3, 'kB']])
    if (bytes >= size) return `${(bytes / size).toFixed(1)} ${unit}`;
  return `${bytes.toFixed(0)} B`;
}

/** Sums of channels by vehicle, those of the simulator last. */
export function byVehicle(rows) {
  const sums = new Map();
  for (const row of rows) {
    const sum = sums.get(row.vehicle) ??
        {vehicle: row.vehicle, channels: 0, count: 0, bytes: 0, rate_hz: null, bytes_per_s: null};
    ++sum.channels;
    for (const key of ['count', 'bytes']) sum[key] += row[key];
    for (const key of ['rate_hz', 'bytes_per_s'])
      if (row[key] !== null) sum[key] = (sum[key] ?? 0) + row[key];
    sums.set(row.vehicle, sum);
  }
  return [...sums.values()].sort((a, b) => (a.vehicle === '') - (b.vehicle === '') || (a.vehicle < b.vehicle ? -1 : 1));
}

/** Outcomes of the losses of a pair, the most frequent first. */
function losses(item) {
  const all = Object.entries(item.lost ?? {}).filter(([, count]) => count > 0);
  return all.sort((a, b) => b[1] - a[1]).map(([outcome, count]) => ({
                                               sign: OUTCOMES[outcome]?.sign ?? '?',
                                               text: OUTCOMES[outcome]?.text ?? outcome,
                                               count,
                                             }));
}

/** Tables of the traffic. */
export class Traffic {
  constructor(app) {
    this.app = app;
    this.name = 'traffic';
    this.title = 'Traffic';
    this.root = element('div', '', 'columns');
    this.search = document.createElement('input');
    this.search.type = 'search';
    this.search.placeholder = 'Channels that contain …';
    this.search.setAttribute('aria-label', 'Search channels');
    this.search.addEventListener('input', () => this.changed());
    this.table = table('Traffic by vehicle and channel', ['', 'msg/s', 'bytes/s', 'msg', 'bytes']);
    this.table.className = 'grid';
    this.cells = document.createElement('table');
    this.cells.setAttribute('aria-label', 'Who received whom');
    this.cells.className = 'matrix';
    this.note = element('p', 'No vehicle has sent anything to another yet.', 'quiet');
    this.lostList = element('ul', '', 'losses');
    this.modems = new ModemBudget(app);
    const left = element('section'), right = element('section');
    left.append(this.search, this.table);
    right.append(
        element('h3', 'Who received whom: received / sent'), this.note, this.cells, this.lostList, this.modems.root);
    this.root.append(left, right);
    this.pairs = [];
    this.stale = true;
  }

  setOpen(open) { this.stale ||= open; }

  changed() { this.stale = true; }

  /** Takes the counts of all pairs of vehicles. */
  setReceptions({items}) {
    this.pairs = (Array.isArray(items) ? items : []).filter((item) => item && item.from && item.to);
    this.stale = true;
  }

  clear() {
    this.pairs = [];
    this.modems.clear();
    this.stale = true;
  }

  update() {
    this.modems.update();
    if (!this.stale) return;
    this.stale = false;
    this.fillChannels();
    this.fillMatrix();
  }

  fillChannels() {
    const desired = this.search.value.trim().toLowerCase();
    const all = [...this.app.channels.byName.values()];
    const shown = all.filter((row) => row.name.toLowerCase().includes(desired));
    const lines = [];
    for (const sum of byVehicle(shown)) {
      lines.push([element('strong', sum.vehicle || 'simulator and programs'), sum]);
      const own = shown.filter((row) => row.vehicle === sum.vehicle).sort((a, b) => (a.name < b.name ? -1 : 1));
      for (const row of own) lines.push([this.head(row), row]);
    }
    const cells =
        lines.slice(0, ROWS_MAX)
            .map(
                ([head, row]) =>
                    [head, rate(row.rate_hz), row.bytes_per_s === null ? '–' : `${formatBytes(row.bytes_per_s)}/s`,
                     formatNumber(row.count), formatBytes(row.bytes)]);
    if (lines.length > ROWS_MAX) cells.push([`… and ${lines.length - ROWS_MAX} more: search`, '', '', '', '']);
    fillTable(this.table, cells);
  }

  /** Name of a channel, without that of its vehicle. */
  head({name, vehicle}) {
    const made = element('span', vehicle && name.startsWith(`${vehicle}.`) ? name.slice(vehicle.length + 1) : name);
    made.className = 'indent';
    made.title = name;
    return made;
  }

  /** The matrix: rows sent, columns received; the losses below it. */
  fillMatrix() {
    const names = [...new Set(this.pairs.flatMap((item) => [item.from, item.to]))].sort().slice(0, NAMES_MAX);
    const pairs = new Map(this.pairs.map((item) => [JSON.stringify([item.from, item.to]), item]));
    this.note.hidden = names.length > 0;
    const lines = names.map((from) => {
      const line = document.createElement('tr');
      line.append(element('th', from));
      for (const to of names) line.append(this.cell(pairs.get(JSON.stringify([from, to])), from === to));
      return line;
    });
    const head = document.createElement('tr');
    head.append(element('th', names.length ? 'from ↓ to →' : ''), ...names.map((name) => element('th', name)));
    this.cells.replaceChildren(head, ...lines);
    this.lostList.replaceChildren(...this.pairs.filter((item) => losses(item).length).slice(0, ROWS_MAX).map((item) => {
      const text = losses(item).map((loss) => `${loss.sign} ${loss.text} ${loss.count}`).join(', ');
      return element('li', `${item.from} → ${item.to}: ${text}`);
    }));
  }

  /** A cell of the matrix: counts, a bar as long as the share received, and the most frequent cause of loss. */
  cell(item, same) {
    if (!item) return element('td', same ? '' : '·', 'quiet');
    const sent = Number(item.sent) || 0, received = Number(item.received) || 0, lost = losses(item);
    const made = element('td', `${received}/${sent}`);
    if (lost.length) made.append(element('span', ` ${lost[0].sign}`, 'fails'));
    const share = sent > 0 ? Math.min(1, received / sent) : 0;
    made.style.backgroundSize = `${(100 * share).toFixed(0)}% 3px`;
    made.title = [`${item.from} to ${item.to}: ${(100 * share).toFixed(0)} % received`]
                     .concat(lost.map((loss) => `${loss.text} ${loss.count}`))
                     .join(', ');
    return made;
  }
}
