// SPDX-License-Identifier: BSD-3-Clause
// The view of the water: profile of the sound speed with the depths of the vehicles, waves, zones without GPS.
import {soundSpeedAt} from './clocks.js';
import {fillTable, table} from './dock.js';
import {element, formatNumber} from './panels.js';

const DRAW_MS = 300;
const NAMES_MAX = 20;
const MARGIN = {
  left: 52,
  right: 14,
  top: 26,
  bottom: 12
};

/** Steps of 1, 2 or 5 times a power of ten between two numbers, about `count` of them. */
export function ticks(low, high, count) {
  const raw = (high - low) / count || 1, ten = Math.pow(10, Math.floor(Math.log10(raw)));
  const step = ten * [1, 2, 5, 10].find((one) => one * ten >= raw);
  const all = [];
  for (let at = Math.ceil(low / step) * step; at <= high + 1e-9 * step; at += step) all.push(+at.toPrecision(10));
  return all;
}

/** The view. */
export class WaterPanel {
  constructor(app) {
    this.app = app;
    this.name = 'water';
    this.title = 'Water';
    this.drawn_ms = 0;
    this.root = element('div', '', 'columns');
    this.none = element('p', 'This world has no water.', 'quiet');
    this.canvas = document.createElement('canvas');
    this.canvas.className = 'profile';
    this.canvas.setAttribute('role', 'img');
    this.canvas.setAttribute('aria-label', 'Sound speed over depth');
    this.chart = element('section');
    this.chart.append(element('h3', 'Sound speed, m/s, over depth, m'), this.canvas);
    this.side = element('section');
    this.depths =
        table('Sound speed at the vehicles', ['Vehicle', 'depth, m', 'sound, m/s', 'current, m/s', 'towards, °']);
    this.depths.className = 'grid';
    this.facts = element('ul');
    this.tide = element('p', '', 'quiet');
    this.side.append(this.facts, this.tide, this.depths);
    this.root.append(this.none, this.chart, this.side);
  }

  setOpen() { this.drawn_ms = 0; }

  /** Takes a scene. */
  setScene(data) {
    const {water} = data;
    const dark = data.zones.filter((zone) => zone.flags.includes('gps_denied'));
    this.none.hidden = water !== null;
    this.chart.hidden = this.depths.hidden = !(water?.sound_speed?.length > 0);
    const facts = [];
    if (water) {
      const height_m = 4 * Math.sqrt(water.waves.reduce((sum, wave) => sum + wave.amplitude_m ** 2 / 2, 0));
      facts.push(`Still surface at z = ${formatNumber(water.mean_level_m ?? water.level_m)} m`);
      facts.push(
          water.waves.length ? `${water.waves.length} waves, significant height ${height_m.toFixed(2)} m` : 'No waves');
    }
    facts.push(dark.length ? `⊘ No GPS in: ${dark.map((zone) => zone.name).join(', ')}` : 'GPS everywhere above water');
    this.facts.replaceChildren(...facts.map((fact) => element('li', fact)));
  }

  update(now_ms) {
    const {data, vehicles} = this.app;
    const profile = data?.water?.sound_speed ?? [];
    if (profile.length === 0 || now_ms - this.drawn_ms < DRAW_MS) return;
    this.drawn_ms = now_ms;
    const {level_m} = data.water;
    const places = vehicles.map((vehicle) => ({vehicle, depth_m: level_m - vehicle.at.z - data.origin_m[2]}))
                       .filter((one) => one.depth_m > -5)
                       .slice(0, NAMES_MAX);
    for (const place of places) place.speed_mps = soundSpeedAt(profile, level_m - place.depth_m);
    fillTable(
        this.depths,
        places.map(
            (place) =>
                [place.vehicle.name, place.depth_m.toFixed(2), place.speed_mps.toFixed(1), ...this.currentAt(place)]));
    const {motion} = this.app.currents, {time_us} = this.app.playback;
    this.tide.textContent = motion.tides.length ? `Tide at present ${motion.tideAt(time_us).toFixed(3)} m` : '';
    this.draw(profile, level_m, places);
  }

  /**
   * Speed of the current at a vehicle, and where it flows to, counter-clockwise from east; of one that is random and
   * not known its mean.
   */
  currentAt({vehicle, depth_m}) {
    const {app} = this, {motion} = app.currents, {time_us} = app.playback;
    if (depth_m < 0) return ['–', '–'];
    const [x, y, z] = vehicle.at.toArray().map((part, k) => part + app.data.origin_m[k]);
    const v = motion.velocityAt([x, y, z], time_us), speed_mps = Math.hypot(...v);
    const direction = speed_mps > 1e-4 ? (Math.atan2(v[1], v[0]) * 180 / Math.PI).toFixed(0) : '–';
    return [`${motion.knows(time_us) ? '' : '≈ '}${speed_mps.toFixed(3)}`, direction];
  }

  draw(profile, level_m, places) {
    const width = this.canvas.clientWidth, height = this.canvas.clientHeight, ratio = devicePixelRatio;
    if (width === 0) return;
    [this.canvas.width, this.canvas.height] = [width * ratio, height * ratio];
    const c = this.canvas.getContext('2d'), style = getComputedStyle(document.documentElement);
    const color = (name) => style.getPropertyValue(name).trim();
    c.scale(ratio, ratio);
    c.font = '11px system-ui';
    // Axes: speed to the right on top, depth downwards as far as the vehicles go, and a bit more.
    const depths = profile.map(([z]) => level_m - z), speeds = profile.map(([, speed]) => speed);
    const deepest = Math.min(Math.max(...depths), Math.max(20, 1.5 * Math.max(0, ...places.map((one) => one.depth_m))));
    const shown = [...speeds.filter((_, i) => depths[i] <= deepest), soundSpeedAt(profile, level_m - deepest)];
    const pad = Math.max(0.5, 0.08 * (Math.max(...shown) - Math.min(...shown)));
    const low = Math.min(...shown) - pad, high = Math.max(...shown) + pad;
    const x = (speed) => MARGIN.left + (speed - low) / (high - low) * (width - MARGIN.left - MARGIN.right);
    const y = (depth) => MARGIN.top + depth / deepest * (height - MARGIN.top - MARGIN.bottom);
    c.strokeStyle = 'rgba(128,150,165,0.3)';
    c.fillStyle = color('--quiet');
    const line = (x0, y0, x1, y1) => {
      c.beginPath();
      c.moveTo(x0, y0);
      c.lineTo(x1, y1);
      c.stroke();
    };
    c.textAlign = 'center';
    for (const speed of ticks(low, high, width / 80)) {
      line(x(speed), MARGIN.top, x(speed), height - MARGIN.bottom);
      c.fillText(speed, x(speed), MARGIN.top - 8);
    }
    c.textAlign = 'right';
    for (const depth of ticks(0, deepest, height / 40)) {
      line(MARGIN.left, y(depth), width - MARGIN.right, y(depth));
      c.fillText(depth, MARGIN.left - 6, y(depth) + 4);
    }
    // The profile, then the vehicles on it.
    c.save();
    c.beginPath();
    c.rect(MARGIN.left, MARGIN.top, width - MARGIN.left - MARGIN.right, height - MARGIN.top - MARGIN.bottom);
    c.clip();
    c.beginPath();
    profile.forEach(([, speed], i) => c.lineTo(x(speed), y(depths[i])));
    c.strokeStyle = color('--accent');
    c.lineWidth = 2;
    c.stroke();
    c.restore();
    c.textAlign = 'left';
    for (const {vehicle, depth_m, speed_mps} of places) {
      if (depth_m < 0 || depth_m > deepest) continue;
      c.beginPath();
      c.arc(x(speed_mps), y(depth_m), 4.5, 0, 2 * Math.PI);
      c.fillStyle = vehicle.color;
      c.fill();
      c.strokeStyle = color('--text');
      c.lineWidth = 1;
      c.stroke();
      c.fillStyle = color('--text');
      const name_px = c.measureText(vehicle.name).width + 9, fits = x(speed_mps) + name_px < width - MARGIN.right;
      c.fillText(vehicle.name, x(speed_mps) + (fits ? 9 : -name_px), y(depth_m) + 4);
    }
  }
}
