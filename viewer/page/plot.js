// SPDX-License-Identifier: BSD-3-Clause
// One plot: its fields and samples, its axes and legend.
import {button} from './dock.js';
import {unitOf} from './messages.js';
import {element, formatNumber} from './panels.js';
import {plotLibrary} from './plot_library.js';

const SAMPLES_MAX = 4000;
const CLICK_PX = 4;
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
export class Plot {
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
