// SPDX-License-Identifier: BSD-3-Clause
// The panels: vehicles with search, details of the selected one with a plot, scores, events.  Text from the server
// enters the page by textContent only.
import {headingOf} from './cameras.js';
import {plotLibrary} from './plot_library.js';
import {OUTCOMES} from './sounds.js';

const EVENTS_MAX = 500;
const PLOT_SAMPLES = 300;
/** States that are this far apart belong to no common motion. */
const GAP_S = 5;
const $ = (id) => document.getElementById(id);

/** Makes an element with a text. */
export function element(name, text = '', classes = '') {
  const made = document.createElement(name);
  made.textContent = text;
  if (classes) made.className = classes;
  return made;
}

/** Writes a time: seconds up to a minute, then minutes and hours. */
export function formatTime(time_us) {
  const s = time_us / 1e6;
  if (s < 60) return `${s.toFixed(2)} s`;
  const whole = Math.floor(s / 60), rest = (s - 60 * whole).toFixed(1).padStart(4, '0');
  return whole < 60 ? `${whole}:${rest}` : `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, '0')}:${rest}`;
}

/** Writes a number with a fixed count of digits; zero has no sign. */
export function fixed(value, digits) {
  const text = value.toFixed(digits);
  return Number(text) === 0 ? text.replace('-', '') : text;
}

/** Writes a number with a sensible count of digits. */
export function formatNumber(value) {
  if (value === null || value === undefined) return '–';
  if (typeof value === 'boolean') return value ? 'yes' : 'no';
  if (typeof value !== 'number' || !Number.isFinite(value)) return String(value);
  const size = Math.abs(value);
  return size !== 0 && (size < 0.001 || size >= 1e6) ? value.toExponential(2) :
                                                       String(+value.toFixed(size < 10 ? 3 : 2));
}

/** The list of vehicles: one stop of the Tab key, arrows move in it. */
export class VehicleList {
  constructor(select, follow) {
    this.list = $('vehicles');
    this.items = [];
    this.list.addEventListener('click', (event) => {
      const item = event.target.closest('li');
      if (item) select(item.dataset.name);
    });
    this.list.addEventListener('dblclick', (event) => {
      const item = event.target.closest('li');
      if (item) follow(item.dataset.name);
    });
    this.list.addEventListener('keydown', (event) => {
      if (event.key === 'Enter' && this.selected !== null) follow(this.selected);
      const step = {ArrowDown: 1, ArrowUp: -1, PageDown: 10, PageUp: -10, Home: -1e9, End: 1e9}[event.key];
      if (!step) return;
      event.preventDefault();
      event.stopPropagation();
      const next = this.neighbor(step);
      if (next !== null) select(next);
    });
    $('search').addEventListener('input', () => this.filter());
    $('search').addEventListener('keydown', (event) => {
      if (event.key !== 'Enter') return;
      const first = this.shown()[0];
      if (first) select(first.dataset.name);
    });
    this.selected = null;
  }

  /** Takes names and colors. */
  setScene(vehicles) {
    this.items = vehicles.map(({name, color}, i) => {
      const item = document.createElement('li');
      item.setAttribute('role', 'option');
      item.id = `vehicle-${i}`;
      item.dataset.name = name;
      const chip = element('span', '', 'chip');
      chip.style.background = color;
      item.append(chip, element('span', name));
      item.title = name;
      return item;
    });
    this.list.replaceChildren(...this.items);
    this.filter();
  }

  filter() {
    const desired = $('search').value.trim().toLowerCase();
    for (const item of this.items) item.hidden = !item.dataset.name.toLowerCase().includes(desired);
    const shown = this.shown().length;
    $('count').textContent = desired ? `${shown} of ${this.items.length}` : `${this.items.length}`;
  }

  shown() { return this.items.filter((item) => !item.hidden); }

  /** Name of the vehicle some places after the selected one. */
  neighbor(step) {
    const shown = this.shown();
    if (shown.length === 0) return null;
    const now = shown.findIndex((item) => item.dataset.name === this.selected);
    const next = Math.abs(step) > 1 ? now + step : (now + step + shown.length) % shown.length;
    return shown[now < 0 ? 0 : Math.min(shown.length - 1, Math.max(0, next))].dataset.name;
  }

  /** Shows which vehicle is selected. */
  setSelected(name) {
    this.selected = name;
    this.list.removeAttribute('aria-activedescendant');
    for (const item of this.items) {
      const chosen = item.dataset.name === name;
      item.setAttribute('aria-selected', chosen);
      if (!chosen) continue;
      this.list.setAttribute('aria-activedescendant', item.id);
      item.scrollIntoView({block: 'nearest'});
    }
  }
}

/** Range of an axis: a constant gets some space. */
function plotRange(plot, low, high) {
  if (low === null || high === null) return [0, 1];
  const pad = Math.max(0.05 * (high - low), 0.05 * Math.abs(high), 0.01);
  return [low - pad, high + pad];
}

/** Details of the selected vehicle. */
export class Details {
  constructor(lookThrough) {
    this.lookThrough = lookThrough;
    this.rows = new Map();
    this.vehicle = null;
    this.history = [[], [], [], []];
    $('quantity').addEventListener('change', () => this.drawPlot());
  }

  /** Shows a vehicle of the scene; null: none. */
  setVehicle(vehicle) {
    this.vehicle = vehicle;
    $('nothing').hidden = vehicle !== null;
    $('details').hidden = vehicle === null;
    this.rows.clear();
    $('values').tBodies[0].replaceChildren();
    this.history = [[], [], [], []];
    this.before = null;
    this.speed_mps = null;
    if (!vehicle) return;
    $('name').textContent = vehicle.name;
    $('devices').replaceChildren(...vehicle.devices.map((device) => {
      const item = document.createElement('li');
      item.append(element('span', device.name), element('span', String(device.type ?? ''), 'quiet'));
      if (device.field_of_view?.kind === 'frustum') {
        const button = element('button', 'look');
        button.type = 'button';
        button.title = 'Look through this camera';
        button.addEventListener('click', () => this.lookThrough(device));
        item.append(button);
      }
      return item;
    }));
  }

  row(name, text) {
    if (!this.rows.has(name)) {
      const line = $('values').tBodies[0].insertRow();
      line.append(element('th', name), element('td'));
      this.rows.set(name, line.lastChild);
    }
    const cell = this.rows.get(name);
    if (cell.textContent !== text) cell.textContent = text;
  }

  /** Shows numbers at a time: true pose, speed from the poses, and the estimate. */
  update(time_us, X_WV, origin_m, estimate, water) {
    if (!this.vehicle) return;
    const e = X_WV.elements;
    const p = [e[12] + origin_m[0], e[13] + origin_m[1], e[14] + origin_m[2]];
    this.measureSpeed(time_us, p);
    const degrees = (angle) => `${fixed(angle * 180 / Math.PI, 1)}°`;
    this.row('x east, m', fixed(p[0], 2));
    this.row('y north, m', fixed(p[1], 2));
    this.row('z up, m', fixed(p[2], 2));
    if (water) this.row('depth, m', fixed(water.level_m - p[2], 2));
    this.row('speed, m/s', this.speed_mps === null ? '–' : this.speed_mps.toFixed(2));
    this.row('yaw', degrees(headingOf(X_WV)));
    this.row('pitch', degrees(Math.asin(Math.max(-1, Math.min(1, -e[2])))));
    this.row('roll', degrees(Math.atan2(e[6], e[10])));
    if (estimate?.estimate) {
      this.row('estimate error, m', estimate.error_m.toFixed(2));
      if (estimate.axes)
        this.row('1σ axes, m', [...estimate.axes.lengths_m].sort((a, b) => b - a).map((x) => x.toFixed(2)).join(' · '));
      this.row('estimate age, s', Math.max(0, (time_us - estimate.estimate.time_us) / 1e6).toFixed(1));
    }
    this.remember(time_us, p[2], estimate?.estimate ? estimate.error_m : null);
  }

  measureSpeed(time_us, p) {
    const before = this.before;
    const dt_s = before ? (time_us - before.time_us) / 1e6 : 0;
    if (before && dt_s > 0)
      this.speed_mps =
          dt_s < GAP_S ? Math.hypot(p[0] - before.p[0], p[1] - before.p[1], p[2] - before.p[2]) / dt_s : null;
    // Half a second apart at most, so that rounding does not matter.
    if (!before || dt_s < 0 || dt_s >= 0.2) this.before = {time_us, p};
  }

  remember(time_us, z, error_m) {
    const [times, speeds, heights, errors] = this.history;
    const t_s = time_us / 1e6;
    if (times.length && t_s < times[times.length - 1])
      this.history.forEach((column) => {
        column.length = 0;
      });
    if (times.length && t_s - times[times.length - 1] < 0.2) return;
    // No line across a time that was not seen, as after a jump in a log.
    if (times.length && t_s - times[times.length - 1] > GAP_S) {
      times.push(t_s - GAP_S / 2);
      [speeds, heights, errors].forEach((column) => column.push(null));
    }
    times.push(t_s), speeds.push(this.speed_mps), heights.push(z), errors.push(error_m);
    if (times.length > PLOT_SAMPLES) this.history.forEach((column) => column.shift());
    this.drawPlot();
  }

  drawPlot() {
    const place = $('plot');
    if (place.offsetParent === null || this.history[0].length < 2) return;
    const Plot = plotLibrary(() => this.drawPlot());
    if (!Plot) return;
    const column = {speed: 1, z: 2, error: 3}[$('quantity').value];
    const color = getComputedStyle(document.documentElement).getPropertyValue('--accent').trim();
    const quiet = getComputedStyle(document.documentElement).getPropertyValue('--quiet').trim();
    // Colors and width belong to the plot: make it again when they change.
    const look = color + place.clientWidth;
    if (this.look !== look) {
      this.plot?.destroy();
      this.look = look;
      const axis =
          {stroke: quiet, grid: {stroke: 'rgba(128,150,165,0.2)'}, ticks: {show: false}, font: '11px system-ui'};
      this.plot = new Plot(
          {
            width: place.clientWidth,
            height: 120,
            legend: {show: false},
            cursor: {show: false},
            scales: {x: {time: false}, y: {range: plotRange}},
            axes: [{...axis, size: 22}, {...axis, size: 44}],
            series: [{}, {stroke: color, width: 1.5, points: {show: false}}],
          },
          [[], []], place);
    }
    this.plot.setData([this.history[0], this.history[column]]);
  }
}

/** Figures that never fall while a run continues: counts, a path, largest values (docs/reference/metrics.md). */
export const GROWING = new Set([
  'bytes', 'bytes_sent', 'count',   'dropped',  'fixes',     'lost_s',      'maps',   'max_deg', 'max_gap_s', 'max_m',
  'poses', 'ranges',     'samples', 'segments', 'sightings', 'travelled_m', 'unsent', 'sent',    'received',  'lost',
]);
const CONSTANT = '[\\d.eE+\\-*/() ]+', FIGURE = '[\\w-]+\\.(\\w+)';
const MORE = [new RegExp(`^ *${FIGURE} *(?:>=?|==)${CONSTANT}$`), new RegExp(`^${CONSTANT}(?:<=?|==) *${FIGURE} *$`)];

/**
 * Is a rule that does not hold still undecided: has it no value yet, or does it want more of a figure that never falls,
 * so that more time can only help?
 */
export function isUndecided({rule, holds, value, bound}) {
  if (holds) return false;
  if (!Number.isFinite(value) || !Number.isFinite(bound)) return true;
  const figure = MORE.map((form) => form.exec(rule)?.[1]).find(Boolean)?.replace(/^lost_(?!s$).*/, 'lost');
  const less = MORE[0].test(rule) ? value <= bound : bound <= value;
  return GROWING.has(figure) && less;
}

/** Scores and rules; goTo(time_us) is called for a moment that the user picks. */
export class Scores {
  constructor(goTo) {
    this.goTo = goTo;
    this.clear();
  }

  clear() {
    this.moments = new Map();
    this.over = false;
    this.set({});
  }

  /** Takes whether the time shown is the end: then every rule is decided. */
  setOver(over) {
    if (over === this.over) return;
    this.over = over;
    this.set(this.message);
  }

  /** Button for the moment at which a rule failed, or a maximum rose last, as far as this page has seen it. */
  moment(key, holds, value, time_us) {
    const before = this.moments.get(key);
    const at_us = before && time_us < before.time_us ? null : before?.at_us ?? null;
    const happened = holds === undefined ? before && value > before.value : before?.holds === true && holds === false;
    this.moments.set(key, {holds, value, time_us, at_us: happened ? time_us : at_us});
    const found_us = this.moments.get(key).at_us;
    if (found_us === null) return '';
    const button = element('button', formatTime(found_us), 'moment');
    button.type = 'button';
    button.title = holds === undefined ? 'Go to where this rose last' : 'Go to where this rule failed';
    button.addEventListener('click', () => this.goTo(found_us));
    return button;
  }

  /** Takes a message `scores`. */
  set(message) {
    this.message = message;
    const rules = message.rules ?? [], metrics = message.metrics ?? [], time_us = message.time_us ?? 0;
    $('no-scores').hidden = rules.length + metrics.length > 0;
    $('rules').replaceChildren(...rules.map((rule) => {
      const item = document.createElement('li');
      const open = !this.over && isUndecided(rule);
      const [sign, look, meaning] = rule.holds ? ['✓', 'holds', 'holds'] :
          open                                 ? ['…', 'quiet', 'not yet decided'] :
                                                 ['✕', 'fails', 'does not hold'];
      const mark = element('span', sign, look);
      mark.setAttribute('aria-label', meaning);
      mark.title = meaning;
      const value = element('span', formatNumber(rule.value), 'quiet');
      value.title = `now ${formatNumber(rule.value)}, bound ${formatNumber(rule.bound)}`;
      const text = element('span', `${rule.rule} `);
      text.append(this.moment(`rule ${rule.rule}`, rule.holds === true, null, time_us));
      item.append(mark, text, value);
      return item;
    }));
    const lines = metrics.flatMap((metric) => Object.entries(metric.figures ?? {}).map(([name, value]) => {
      const line = document.createElement('tr');
      const head = element('th', `${metric.name} ${name} `);
      if (/max/.test(name)) head.append(this.moment(`${metric.name} ${name}`, undefined, value, time_us));
      line.append(head, element('td', formatNumber(value)));
      return line;
    }));
    $('metrics').tBodies[0].replaceChildren(...lines);
  }
}

/** Events of the run, and problems of the page itself. */
export class Events {
  /** goTo(time_us) is called for an event that the user picks: by a click, or by arrow keys and Enter. */
  constructor(goTo) {
    const pick = (line) => {
      if (line?.dataset.time) goTo(Number(line.dataset.time));
    };
    $('events').addEventListener('click', (event) => pick(event.target.closest('li')));
    $('events').addEventListener('keydown', (event) => {
      const now = $('events').querySelector('[aria-current]');
      if (event.key === 'Enter') pick(now);
      if (!['ArrowDown', 'ArrowUp'].includes(event.key)) return;
      const next = event.key === 'ArrowDown' ? (now ? now.nextSibling : $('events').firstChild) : now?.previousSibling;
      event.preventDefault();
      event.stopPropagation();
      if (!next) return;
      now?.removeAttribute('aria-current');
      next.setAttribute('aria-current', 'true');
      next.scrollIntoView({block: 'nearest'});
    });
  }

  /** Takes a message `events`; returns false if it repeats what is known.  `all`: in place of the events before. */
  take(items, {all = false, dropped = 0}) {
    const before = this.taken ?? [];
    if (all && JSON.stringify(items.slice(-EVENTS_MAX)) === JSON.stringify(before)) return false;
    this.taken = (all ? items : [...before, ...items]).slice(-EVENTS_MAX);
    if (all) {
      // Problems of this page stay, below.
      for (const line of [...$('events').querySelectorAll('[data-time], .dropped')]) line.remove();
      if (dropped > 0) {
        const line = element('li', `${dropped} earlier events were not kept`, 'dropped quiet');
        $('events').prepend(line);
      }
    }
    this.add(items);
    return true;
  }

  /** Adds events, the newest on top. */
  add(items) {
    $('no-events').hidden = true;
    for (const item of items) {
      const line = document.createElement('li');
      const time = element('time', Number.isFinite(item.time_us) ? formatTime(item.time_us) : '');
      const who = item.who ? `${item.who}: ` : '';
      if (Number.isFinite(item.time_us)) line.dataset.time = item.time_us;
      line.append(
          time, element('span', `${who}${item.text ?? item.kind ?? ''}`, item.kind === 'problem' ? 'problem' : ''));
      $('events').prepend(line);
    }
    while ($('events').children.length > EVENTS_MAX) $('events').lastChild.remove();
  }

  clear() {
    this.taken = [];
    $('events').replaceChildren();
    $('no-events').hidden = false;
  }

  /** Shows a text for some seconds. */
  static toast(text, good = false) {
    const note = element('div', text, good ? 'good' : '');
    $('toasts').append(note);
    while ($('toasts').children.length > 4) $('toasts').firstChild.remove();
    setTimeout(() => note.remove(), 6000);
  }
}

/** Fills the legend of sounds with the outcomes seen so far. */
export class Legend {
  constructor() {
    this.seen = new Set();
    this.slowness = 1;
  }

  clear() {
    this.seen.clear();
    this.slowness = 1;
    $('legend').hidden = true;
  }

  add(outcomes) {
    const before = this.seen.size;
    for (const outcome of outcomes)
      if (OUTCOMES[outcome]) this.seen.add(outcome);
    if (this.seen.size !== before) this.write();
  }

  /** Says how many times slower than in the run sounds are drawn; 1: says nothing, and keeps what it has said. */
  setSlowness(slowness) {
    const rounded = Math.round(slowness);
    if (rounded <= 1 || rounded === this.slowness) return;
    this.slowness = rounded;
    this.write();
  }

  write() {
    $('legend').hidden = false;
    const lines = Object.keys(OUTCOMES).filter((name) => this.seen.has(name)).map((name) => {
      const line = document.createElement('div'), sign = element('i', OUTCOMES[name].sign);
      sign.style.background = OUTCOMES[name].color;
      line.append(sign, element('span', OUTCOMES[name].text));
      return line;
    });
    if (this.slowness > 1) lines.push(element('div', `sound is drawn ${this.slowness} times slower`));
    $('legend').replaceChildren(...lines);
  }
}
