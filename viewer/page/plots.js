// SPDX-License-Identifier: BSD-3-Clause
// Plots of numeric fields of channels: of a run from the messages that arrive, of a log from the whole log.
import {button, choice, setChoices} from './dock.js';
import {numberAt, numericFields, unitOf} from './messages.js';
import {element, formatNumber} from './panels.js';
import {plotLibrary} from './plot_library.js';

const PLOTS_MAX = 4;
const FIELDS_MAX = 6;
const SAMPLES_MAX = 4000;
const RATE_HZ = 20;
const DRAW_MS = 200;
const CLICK_PX = 4;
const FIELDS_LISTED = 400;
/** Lines differ in color (Okabe and Ito 2008), dashes and sign. */
const LOOKS = [
  {color: '#2b8cc4', dash: [], sign: '━━'},
  {color: '#d55e00', dash: [9, 4], sign: '━ ━'},
  {color: '#009e73', dash: [2, 3], sign: '····'},
  {color: '#cc79a7', dash: [10, 3, 2, 3], sign: '━·━'},
  {color: '#c98a00', dash: [5, 5], sign: '╍╍'},
  {color: '#8c6bb1', dash: [1, 5], sign: '· ·'},
];

/** Range of an axis: a constant gets some space. */
function padded(plot, low, high) {
  if (low === null || high === null) return [0, 1];
  const pad = Math.max(0.06 * (high - low), 1e-9 + 0.01 * Math.abs(high));
  return [low - pad, high + pad];
}

/** One field of a plot and its samples. */
class Trace {
  constructor(channel, path, look) {
    Object.assign(this, {channel, path, look, unit: unitOf(path)});
    this.clear();
  }

  clear() {
    this.t_s = [];
    this.values = [];
  }

  /** Adds a sample; when there are too many the older half gets coarser. */
  add(t_s, value) {
    const last_s = this.t_s[this.t_s.length - 1];
    if (t_s === last_s) return;
    if (t_s < last_s) this.rewind(t_s);
    this.t_s.push(t_s);
    this.values.push(Number.isFinite(value) ? value : null);
    if (this.t_s.length <= SAMPLES_MAX) return;
    const kept = (_, i) => i >= SAMPLES_MAX / 2 || i % 2 === 0;
    this.t_s = this.t_s.filter(kept);
    this.values = this.values.filter(kept);
  }

  /** Forgets what is later than a time. */
  rewind(t_s) {
    const end = this.t_s.findIndex((one) => one > t_s);
    if (end >= 0) this.t_s.length = this.values.length = end;
  }

  set(t_us, values) {
    this.t_s = t_us.map((t) => t / 1e6);
    this.values = values.map((value) => (Number.isFinite(value) ? value : null));
  }

  /** Newest value up to a time. */
  valueAt(t_s) {
    const next = this.t_s.findIndex((one) => one > t_s + 1e-6);
    return this.values[(next < 0 ? this.t_s.length : next) - 1];
  }
}

/** One plot with its legend. */
class Plot {
  constructor(owner) {
    this.owner = owner;
    this.traces = [];
    this.root = element('section', '', 'plot');
    this.root.setAttribute('aria-label', 'Plot');
    this.legend = element('ul', '', 'plot-legend');
    this.place = element('div', '', 'plot-place');
    this.root.append(this.legend, this.place);
  }

  add(channel, path) {
    const look = LOOKS.find((one) => this.traces.every((trace) => trace.look !== one));
    if (!look || this.traces.some((trace) => trace.channel === channel && trace.path === path)) return;
    this.traces.push(new Trace(channel, path, look));
    this.fillLegend();
  }

  fillLegend() {
    this.legend.replaceChildren(...this.traces.map((trace) => {
      const item = element('li'), sign = element('span', trace.look.sign, 'sign');
      sign.style.color = trace.look.color;
      trace.output = element('output', '–');
      const name = `${trace.channel} ${trace.path}`;
      const remove = button('✕', `Remove ${name}`, () => this.owner.remove(this, trace));
      remove.setAttribute('aria-label', `Remove ${name}`);
      const title = element('span', name, 'name');
      title.title = name;
      item.append(sign, title, trace.output, element('span', trace.unit, 'quiet'), remove);
      return item;
    }));
  }

  /** Makes the plot again when its fields, size or colors changed, then draws its samples. */
  draw(quiet) {
    const width = this.place.clientWidth, height = Math.max(90, this.place.clientHeight);
    if (width === 0) return;
    const Library = plotLibrary(() => this.draw(quiet));
    if (!Library) return;
    const key = JSON.stringify([width, height, quiet, this.traces.map((trace) => [trace.channel, trace.path])]);
    if (key !== this.key) this.make(Library, width, height, quiet);
    this.key = key;
    const data = this.traces.length ? Library.join(this.traces.map((trace) => [trace.t_s, trace.values])) : [[]];
    this.plot.setData(data);
  }

  make(Library, width, height, quiet) {
    this.plot?.destroy();
    const units = [...new Set(this.traces.map((trace) => trace.unit))];
    const axis = {stroke: quiet, ticks: {show: false}, font: '11px system-ui'};
    const grid = {stroke: 'rgba(128,150,165,0.2)'};
    const scales = Object.fromEntries(units.map((unit) => [`y ${unit}`, {range: padded}]));
    this.plot =
        new Library(
            {
              width,
              height,
              legend: {show: false},
              cursor: {y: false, points: {show: false}, drag: {setScale: false, x: true, y: false}},
              scales:
                  {x: {time: false, range: (plot, low, high) => this.owner.zoom ?? [low ?? 0, high ?? 1]}, ...scales},
              axes:
                  [
                    {...axis, grid, size: 24, values: (plot, ticks) => ticks.map((t) => `${t} s`)},
                    ...units.map((unit, i) => ({
                                   ...axis,
                                   scale: `y ${unit}`,
                                   side: i % 2 ? 1 : 3,
                                   size: 38,
                                   grid: i === 0 ? grid : {show: false},
                                   label: unit || undefined,
                                   labelSize: 14,
                                   labelFont: '11px system-ui',
                                   labelGap: 0,
                                 }))
                  ],
              series: [
                {}, ...this.traces.map((trace) => ({
                                         scale: `y ${trace.unit}`,
                                         stroke: trace.look.color,
                                         dash: trace.look.dash,
                                         width: 1.6,
                                         spanGaps: true,
                                         points: {show: false},
                                       }))
              ],
              hooks: {setSelect: [(plot) => this.select(plot)]},
            },
            [[], ...this.traces.map(() => [])], this.place);
    this.listen();
  }

  /** A click goes to its time, a drag zooms, a double click shows all. */
  listen() {
    const {over} = this.plot;
    this.marker = element('div', '', 'now');
    over.append(this.marker);
    let down = null;
    over.addEventListener('mousedown', (event) => {
      down = event.clientX;
    });
    over.addEventListener('click', (event) => {
      if (down === null || Math.abs(event.clientX - down) >= CLICK_PX) return;
      this.owner.seek(this.plot.posToVal(event.clientX - over.getBoundingClientRect().left, 'x'));
    });
    over.addEventListener('dblclick', () => this.owner.setZoom(null));
  }

  select(plot) {
    const {left, width} = plot.select;
    if (width < CLICK_PX) return;
    this.owner.setZoom([plot.posToVal(left, 'x'), plot.posToVal(left + width, 'x')]);
    plot.setSelect({left: 0, width: 0}, false);
  }

  /** Moves the mark of the time shown and writes the values at this time. */
  showTime(t_s) {
    for (const trace of this.traces) {
      const text = formatNumber(trace.valueAt(t_s) ?? null);
      if (trace.output.textContent !== text) trace.output.textContent = text;
    }
    if (!this.plot) return;
    const x = this.plot.valToPos(t_s, 'x');
    const inside = Number.isFinite(x) && x >= 0 && x <= this.plot.over.clientWidth;
    this.marker.hidden = !inside;
    if (inside) this.marker.style.transform = `translateX(${x.toFixed(1)}px)`;
  }
}

/** The view of plots. */
export class Plots {
  constructor(app) {
    this.app = app;
    this.name = 'plots';
    this.title = 'Plots';
    this.plots = [];
    this.zoom = null;
    this.fields = new Map();
    this.requests = new Map();
    this.nextId = 1;
    this.drawn_ms = 0;
    this.root = element('div');
    this.channel = choice('Channel', () => this.chooseChannel());
    this.field = choice('Field', () => this.showButtons());
    this.place = choice('Plot', () => {});
    this.addButton = button('Add', 'Add this field to a plot', () => this.addChosen());
    this.all = button('Whole time', 'Show the whole time (double click in a plot)', () => this.setZoom(null));
    this.hint =
        element('p', 'Choose a channel and a field. A click in a plot goes to its time, a drag zooms.', 'quiet');
    const form = element('div', '', 'form');
    form.append(this.channel, this.field, this.place, this.addButton, this.all);
    this.grid = element('div', '', 'plots');
    this.root.append(form, this.hint, this.grid);
    this.changed();
  }

  get isLog() { return this.app.timeBar.isLog; }

  setOpen(open) {
    this.open = open;
    this.stale = true;
    this.changed();
    this.subscribe();
  }

  /** Takes the list of channels. */
  changed() {
    const rows = [...this.app.channels.byName.values()].sort((a, b) => (a.name < b.name ? -1 : 1));
    setChoices(this.channel, [['', 'channel …'], ...rows.map((row) => [row.name, row.name])]);
    this.showButtons();
  }

  chooseChannel() {
    this.listFields();
    this.subscribe();
  }

  listFields() {
    const known = this.fields.get(this.channel.value);
    const waiting = this.channel.value ? 'waiting for a message …' : 'field …';
    setChoices(this.field, known ? known.map((path) => [path, path]) : [['', waiting]]);
    this.showButtons();
  }

  showButtons() {
    const open = this.plots.map((plot, i) => [String(i), `in plot ${i + 1}`]);
    const places = this.plots.length < PLOTS_MAX ? [['new', 'in a new plot'], ...open] : open;
    setChoices(this.place, places);
    this.addButton.disabled = this.field.value === '';
    this.hint.hidden = this.plots.length > 0;
    this.all.hidden = this.zoom === null;
  }

  addChosen() {
    const {value: place} = this.place;
    this.add(this.channel.value, this.field.value, place === 'new' ? this.plots.length : Number(place));
    // The next field goes into the same plot.
    if (place === 'new') this.place.value = String(this.plots.length - 1);
  }

  /** Adds a field to a plot by its number; a new one after the last. */
  add(channel, path, number = this.plots.length) {
    if (number >= PLOTS_MAX) return;
    while (this.plots.length <= number) {
      this.plots.push(new Plot(this));
      this.grid.append(this.plots[this.plots.length - 1].root);
    }
    if (this.plots[number].traces.length >= FIELDS_MAX) this.app.problem(`a plot has room for ${FIELDS_MAX} fields`);
    this.plots[number].add(channel, path);
    this.arrange();
    this.request();
  }

  remove(plot, trace) {
    plot.traces = plot.traces.filter((one) => one !== trace);
    plot.fillLegend();
    if (plot.traces.length === 0) {
      plot.plot?.destroy();
      plot.root.remove();
      this.plots = this.plots.filter((one) => one !== plot);
    }
    this.arrange();
    this.channel.focus();
  }

  arrange() {
    this.grid.classList.toggle('two', this.plots.length > 1);
    this.showButtons();
    this.subscribe();
    this.stale = true;
  }

  traces() { return this.plots.flatMap((plot) => plot.traces); }

  /**
   * Asks for the channels of a run that are plotted, also while the panel is closed, and for one to list its fields.
   */
  subscribe() {
    const names = new Set(this.isLog ? [] : this.traces().map((trace) => trace.channel));
    if (this.open && this.channel.value && !this.fields.has(this.channel.value)) names.add(this.channel.value);
    this.app.channels.want('plots', names, RATE_HZ, (message) => this.take(message));
  }

  take(message) {
    if (!this.fields.has(message.channel)) {
      this.fields.set(message.channel, numericFields(message.fields).slice(0, FIELDS_LISTED));
      if (message.channel === this.channel.value) {
        this.listFields();
        this.subscribe();
      }
    }
    if (this.isLog) return;
    for (const trace of this.traces())
      if (trace.channel === message.channel) {
        trace.add(message.time_us / 1e6, numberAt(message.fields, trace.path));
        this.stale = true;
      }
  }

  /** Asks a log for the samples of all traces within the time that is shown. */
  request() {
    if (!this.isLog) return;
    const {start_us, end_us} = this.app.timeBar.hello;
    const [from_us, to_us] = this.zoom ? this.zoom.map((t) => Math.round(t * 1e6)) : [start_us ?? 0, end_us];
    const points = Math.min(4000, Math.max(200, 2 * Math.round(this.grid.clientWidth)));
    this.requests.clear();
    for (const trace of this.traces()) {
      const id = this.nextId++;
      this.requests.set(id, trace);
      this.app.connection.send({op: 'series', id, channel: trace.channel, field: trace.path, from_us, to_us, points});
    }
  }

  /** Takes a message `series`. */
  setSeries({id, t_us, values}) {
    const trace = this.requests.get(id);
    if (!trace || !Array.isArray(t_us) || !Array.isArray(values) || t_us.length !== values.length) return;
    this.requests.delete(id);
    trace.set(t_us, values);
    this.stale = true;
  }

  /** Shows a span of time in all plots; null: all of it. */
  setZoom(zoom) {
    this.zoom = zoom;
    this.stale = true;
    this.showButtons();
    this.request();
  }

  /** Goes to a time of a log; a run offers to rewind. */
  seek(t_s) { this.app.timeBar.goTo(Math.round(t_s * 1e6)); }

  /** Another scene. */
  restart() {
    this.fields.clear();
    for (const trace of this.traces()) trace.clear();
    this.listFields();
    this.request();
  }

  update(now_ms) {
    if (this.look !== this.app.theme.name) this.stale = true;
    if (this.stale && now_ms - this.drawn_ms > DRAW_MS) {
      this.stale = false;
      this.drawn_ms = now_ms;
      this.look = this.app.theme.name;
      const quiet = getComputedStyle(document.documentElement).getPropertyValue('--quiet').trim();
      for (const plot of this.plots) plot.draw(quiet);
    }
    for (const plot of this.plots) plot.showTime(this.app.playback.time_us / 1e6);
  }

  /** The plots as text, for the address: fields with commas, plots with semicolons between them. */
  text() {
    const one = (trace) => `${encodeURIComponent(trace.channel)}/${trace.path}`;
    return this.plots.map((plot) => plot.traces.map(one).join(',')).join(';');
  }

  setText(text) {
    text.split(';').slice(0, PLOTS_MAX).forEach((plot, number) => {
      for (const field of plot.split(',').slice(0, FIELDS_MAX)) {
        const [channel, path] = field.split('/');
        if (channel && path) this.add(decodeURIComponent(channel), path, number);
      }
    });
  }
}
