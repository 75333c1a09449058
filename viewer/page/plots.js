// SPDX-License-Identifier: BSD-3-Clause
// Plots of numeric fields of channels: of a run from the messages that arrive, of a log from the whole log.
import {button, choice, setChoices} from './dock.js';
import {numberAt, numericFields} from './messages.js';
import {element} from './panels.js';
import {Plot} from './plot.js';

const PLOTS_MAX = 4;
const FIELDS_MAX = 6;
const RATE_HZ = 20;
const DRAW_MS = 200;
const FIELDS_LISTED = 400;

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
   * Asks for the channels of a run that are plotted, even while the panel is closed, and for one to list its fields.
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
