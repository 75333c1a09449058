// SPDX-License-Identifier: BSD-3-Clause
// How far each vehicle is from itself in the other of two logs, over time, with the first difference marked.
import {element, formatNumber} from './panels.js';
import {plotLibrary} from './plot_library.js';

const DRAW_MS = 200;
const COLORS = ['#2b8cc4', '#d55e00', '#009e73', '#cc79a7', '#c98a00', '#8c6bb1'];
const DASHES = [[], [9, 4], [2, 3], [10, 3, 2, 3], [5, 5]];
const CLICK_PX = 4;

/** The plot, in the view of distances. */
export class DistancePlot {
  /** `note`: line of text about the plot. */
  constructor(app, root, note) {
    this.app = app;
    this.note = note;
    this.drawn_ms = 0;
    this.legend = element('ul', '', 'plot-legend');
    this.place = element('div', '', 'plot-place');
    this.place.setAttribute('role', 'img');
    this.place.setAttribute('aria-label', 'Distance of each vehicle between the two logs over time');
    this.section = element('section', '', 'plot');
    this.section.append(this.legend, this.place);
    root.append(this.section);
    this.clear();
  }

  clear() {
    this.t_s = [];
    this.traces = [];
    this.differs_s = null;
    this.plot?.destroy();
    this.plot = this.key = null;
    this.section.hidden = true;
  }

  setOpen() { this.drawn_ms = 0; }

  /** Takes a message `distances`. */
  set({t_us, vehicles, differs_us, left_out}) {
    this.clear();
    if (!Array.isArray(t_us) || !t_us.every(Number.isFinite) || !Array.isArray(vehicles)) return;
    this.t_s = t_us.map((t) => t / 1e6);
    this.differs_s = Number.isFinite(differs_us) ? differs_us / 1e6 : null;
    const whole = vehicles.filter((one) => Array.isArray(one?.distance_m) && one.distance_m.length === t_us.length);
    this.traces = whole.map((one, i) => ({
                              name: String(one.name),
                              values: one.distance_m.map((d) => (Number.isFinite(d) ? d : null)),
                              color: COLORS[i % COLORS.length],
                              dash: DASHES[i % DASHES.length],
                            }));
    this.legend.replaceChildren(...this.traces.map((trace) => {
      const item = element('li'), sign = element('span', '━━', 'sign');
      sign.style.color = trace.color;
      trace.output = element('output', '–');
      item.append(sign, element('span', trace.name, 'name'), trace.output, element('span', 'm', 'quiet'));
      return item;
    }));
    const differs = this.differs_s === null ? 'No difference' : `First difference at ${this.differs_s.toFixed(3)} s`;
    this.note.textContent = left_out > 0 ? `${differs}; ${left_out} further vehicles are left out` : differs;
    this.section.hidden = this.traces.length === 0;
    this.drawn_ms = 0;
  }

  update(now_ms) {
    if (this.traces.length === 0 || now_ms - this.drawn_ms < DRAW_MS) return;
    this.drawn_ms = now_ms;
    const t_s = this.app.playback.time_us / 1e6;
    for (const trace of this.traces) {
      const next = this.t_s.findIndex((one) => one > t_s + 1e-6);
      const value = trace.values[(next < 0 ? this.t_s.length : next) - 1] ?? null;
      trace.output.textContent = value === null ? '–' : formatNumber(value);
    }
    this.draw();
    this.plot?.redraw(false);
  }

  draw() {
    const width = this.place.clientWidth, height = Math.max(90, this.place.clientHeight);
    if (width === 0) return;
    const Library = plotLibrary(() => this.draw());
    if (!Library) return;
    const quiet = getComputedStyle(document.documentElement).getPropertyValue('--quiet').trim();
    const key = JSON.stringify([width, height, quiet, this.traces.map((trace) => trace.name)]);
    if (key === this.key) return;
    this.key = key;
    this.plot?.destroy();
    this.make(Library, width, height, quiet);
  }

  make(Library, width, height, quiet) {
    const axis = {stroke: quiet, ticks: {show: false}, font: '11px system-ui', grid: {stroke: 'rgba(128,150,165,0.2)'}};
    this.plot =
        new Library(
            {
              width,
              height,
              legend: {show: false},
              cursor: {y: false, points: {show: false}, drag: {setScale: false, x: false, y: false}},
              scales: {x: {time: false}, y: {range: (plot, low, high) => [0, Math.max(1e-6, 1.06 * (high ?? 1))]}},
              axes: [
                {...axis, size: 24, values: (plot, ticks) => ticks.map((t) => `${t} s`)},
                {...axis, size: 56, values: (plot, ticks) => ticks.map((d) => `${d} m`)}
              ],
              series: [
                {}, ...this.traces.map(({name, color, dash}) => ({
                                         label: name,
                                         stroke: color,
                                         width: 2,
                                         dash,
                                         points: {show: this.t_s.length < 2},
                                       }))
              ],
              hooks: {
                draw: [(plot) => {
                  this.line(plot, this.differs_s, '#ff4fd0', [6, 4]);
                  this.line(plot, this.app.playback.time_us / 1e6, '#e4572e', []);
                }]
              },
            },
            [this.t_s, ...this.traces.map((trace) => trace.values)], this.place);
    let down = null;
    this.plot.over.addEventListener('pointerdown', (event) => {
      down = event.offsetX;
    });
    this.plot.over.addEventListener('pointerup', (event) => {
      if (down !== null && Math.abs(event.offsetX - down) < CLICK_PX)
        this.app.timeBar.goTo(1e6 * this.plot.posToVal(event.offsetX, 'x'));
      down = null;
    });
  }

  /** Draws an upright line at a time. */
  line(plot, t_s, color, dash) {
    if (t_s === null || !(t_s >= plot.scales.x.min && t_s <= plot.scales.x.max)) return;
    const x = plot.valToPos(t_s, 'x', true), c = plot.ctx;
    c.save();
    c.beginPath();
    c.strokeStyle = color;
    c.lineWidth = 2 * devicePixelRatio;
    c.setLineDash(dash.map((part) => part * devicePixelRatio));
    c.moveTo(x, plot.bbox.top);
    c.lineTo(x, plot.bbox.top + plot.bbox.height);
    c.stroke();
    c.restore();
  }

  /** Numbers for tests. */
  probe() {
    return {
      differs_s: this.differs_s,
      traces: this.traces.map(
          ({name, values}) => ({name, count: values.length, first_m: values[0], last_m: values[values.length - 1]})),
    };
  }
}
