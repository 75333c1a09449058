// SPDX-License-Identifier: BSD-3-Clause
// Text over the scene, on its own canvas: names, errors in meters, marks of sounds, the measuring tape.
import {Vector3} from './vendor/three.js';

const LABELS_MAX = 80;
/** More vehicles than this have names only where they are near. */
const MANY = 60;
const FONT = '12px system-ui, sans-serif';
const WIDTHS_MAX = 4000;

/** Canvas over the scene. */
export class Labels {
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext('2d');
    this.at = new Vector3();
    this.widths = new Map();
    this.used = [];  // boxes of texts: left, middle, right, the text
    this.inked = true;
    this.region = null;  // part of the page that is written on; null: all of it
  }

  /** Takes the size of the page, in CSS pixels. */
  resize(width, height, ratio) {
    this.canvas.width = width * ratio;
    this.canvas.height = height * ratio;
    this.width = width, this.height = height, this.ratio = ratio;
  }

  /** Returns the position of a point in CSS pixels; null behind the camera or far outside. */
  project(point, camera) {
    this.at.copy(point).applyMatrix4(camera.matrixWorldInverse);
    if (this.at.z > -camera.near) return null;
    this.at.applyMatrix4(camera.projectionMatrix);
    if (Math.abs(this.at.x) > 1.5 || Math.abs(this.at.y) > 1.5) return null;
    const {x, y, width, height} = this.region ?? {x: 0, y: 0, width: this.width, height: this.height};
    return [x + (0.5 + 0.5 * this.at.x) * width, y + (0.5 - 0.5 * this.at.y) * height];
  }

  /** Starts a frame. */
  begin(camera, colors) {
    this.camera = camera;
    this.colors = colors;
    this.enter();
    if (this.inked) this.context.clearRect(0, 0, this.width, this.height);
    this.inked = false;
    this.limit();
    this.context.font = FONT;
    this.context.textBaseline = 'middle';
    this.used = [];
  }

  /** Ends a frame: an empty canvas is not laid over the scene. */
  end() {
    if (this.canvas.hidden === this.inked) this.canvas.hidden = !this.inked;
  }

  /** Width of a text in the present font, in CSS pixels. */
  widthOf(text, bold) {
    const key = bold ? `b${text}` : `n${text}`;
    let width = this.widths.get(key);
    if (width === undefined) {
      if (this.widths.size >= WIDTHS_MAX) this.widths.clear();
      width = this.context.measureText(text).width;
      this.widths.set(key, width);
    }
    return width;
  }

  /** Writes on the whole canvas again. */
  enter() {
    if (this.limited) this.context.restore();
    this.limited = false;
    this.context.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
  }

  /** Keeps what is written within the region. */
  limit() {
    if (!this.region) return;
    const {x, y, width, height} = this.region.clip;
    this.context.save();
    this.limited = true;
    this.context.beginPath();
    this.context.rect(x, y, width, height);
    this.context.clip();
  }

  /**
   * Draws a text beside a point, on a small plate, at the first of some heights where no other label is; returns false
   * where there is none.
   */
  text(point, text, {color = null, dx = 10, dy = 0, bold = false} = {}) {
    const at = this.project(point, this.camera);
    if (!at || this.used.length >= LABELS_MAX) return false;
    const c = this.context;
    c.font = bold ? `600 ${FONT}` : FONT;
    const x = at[0] + dx, width = this.widthOf(text, bold) + 10;
    const isFree = (y) => !this.used.some((box) => Math.abs(box[1] - y) < 17 && x < box[2] && x + width > box[0]);
    const heights = [dy].flat().map((one) => at[1] + one), y = bold ? heights[0] : heights.find(isFree);
    if (y === undefined) return false;
    this.used.push([x, y, x + width, text]);
    this.inked = true;
    c.fillStyle = this.colors.plate;
    c.beginPath();
    c.roundRect(x, y - 9, width, 18, 4);
    c.fill();
    if (color) {
      c.fillStyle = color;
      c.fillRect(x, y - 9, 3, 18);
    }
    c.fillStyle = this.colors.text;
    c.fillText(text, x + 6, y + 0.5);
    return true;
  }

  /** Draws a sign in a disc at a point: its color and its sign both say what it is. */
  mark(point, look, text) {
    const at = this.project(point, this.camera);
    if (!at) return;
    this.inked = true;
    const c = this.context;
    c.beginPath();
    c.arc(at[0], at[1] - 18, 9, 0, 2 * Math.PI);
    c.fillStyle = look.color;
    c.fill();
    c.lineWidth = 1.5;
    c.strokeStyle = '#ffffff';
    c.stroke();
    c.fillStyle = '#000000';
    c.textAlign = 'center';
    c.font = `600 ${FONT}`;
    c.fillText(look.sign, at[0], at[1] - 17.5);
    c.textAlign = 'left';
    if (text) this.text(point, text, {dx: 14, dy: [-18, -36, -54, 2]});
  }

  /** Draws a horizontal circle about a point, such as the front of a sound. */
  circle(center, radius_m, color, width_px, alpha) {
    const c = this.context, point = new Vector3();
    this.inked = true;
    c.beginPath();
    let drawing = false;
    for (let i = 0; i <= 96; ++i) {
      const angle = 2 * Math.PI * i / 96;
      point.set(center.x + radius_m * Math.cos(angle), center.y + radius_m * Math.sin(angle), center.z);
      const at = this.project(point, this.camera);
      if (at && drawing)
        c.lineTo(at[0], at[1]);
      else if (at)
        c.moveTo(at[0], at[1]);
      drawing = at !== null;
    }
    c.globalAlpha = alpha;
    c.strokeStyle = color;
    c.lineWidth = width_px;
    c.stroke();
    c.globalAlpha = 1;
  }

  /** Draws a line between two points, without ends. */
  stroke(a, b, {color, alpha, dashes = []}) {
    const from = this.project(a, this.camera), to = this.project(b, this.camera);
    if (!from || !to) return;
    this.inked = true;
    const c = this.context;
    c.globalAlpha = alpha;
    c.strokeStyle = color;
    c.lineWidth = 2;
    c.setLineDash(dashes);
    c.beginPath();
    c.moveTo(...from);
    c.lineTo(...to);
    c.stroke();
    c.setLineDash([]);
    c.globalAlpha = 1;
  }

  /** Draws a dashed line between two points, with dots at its ends. */
  line(a, b, color) {
    const from = this.project(a, this.camera), to = this.project(b, this.camera);
    if (!from || !to) return;
    this.stroke(a, b, {color, alpha: 1, dashes: [6, 4]});
    const c = this.context;
    for (const [x, y] of [from, to]) {
      c.fillStyle = color;
      c.beginPath();
      c.arc(x, y, 4, 0, 2 * Math.PI);
      c.fill();
    }
  }
}

/** Draws all texts and marks of the page over its scene. */
export function drawAnnotations(app) {
  const {labels} = app;
  labels.begin(app.camera, app.theme.colors);
  // Solid: it was received.
  for (const {from, to, look, left, mark} of app.sounds.lines)
    labels.stroke(from, to, {color: look.color, alpha: 0.9 * left, dashes: mark.outcome === 'none' ? [] : [3, 5]});
  for (const ring of app.sounds.shown ? app.sounds.rings : []) drawRing(app, ring);
  // Names come first: whatever else is written finds another place.
  drawNames(app, app.vehicles, app.estimates);
  for (const mark of app.sounds.visibleMarks ?? []) {
    const snr = Number.isFinite(mark.snr_dB) ? ` ${mark.snr_dB.toFixed(0)} dB` : '';
    labels.mark(mark.at, mark.look, `${mark.look.text}${snr}`);
  }
  app.instruments.annotate(labels, app.playback.time_us);
  app.currents.annotate(labels, app.playback.time_us);
  app.depths.annotate(labels, app.selected);
  if (app.picking.points.length === 2) {
    labels.line(...app.picking.points, '#ffd166');
    const middle = app.picking.points[0].clone().add(app.picking.points[1]).multiplyScalar(0.5);
    labels.text(middle, app.picking.text(), {bold: true});
  } else if (app.picking.points.length === 1) {
    labels.text(app.picking.points[0], '× first point', {bold: true});
  }
}

/** The front of a sound at the depth of its source, as wide as the sound lasts. */
function drawRing(app, {sound, outer_m, inner_m}) {
  const middle_m = (outer_m + inner_m) / 2;
  const meter_px = app.camera.projectionMatrix.elements[5] * app.sides.regions[0].height / 2 /
      Math.max(1, app.camera.position.distanceTo(sound.at));
  const width_px = Math.min(12, Math.max(1.5, (outer_m - inner_m) * meter_px));
  const color = {ping: '#f0e442', answer: '#009e73', noise: '#cc79a7'}[sound.kind] ?? '#56b4e9';
  app.labels.circle(sound.at, middle_m, color, width_px, 0.38);
}

/** Names of vehicles, which may be those of another branch, with its estimates. */
export function drawNames(app, vehicles, estimates) {
  const {labels} = app;
  const selected = vehicles.find((vehicle) => vehicle.name === app.selected) ?? null;
  const onBoard = ['first', 'device'].includes(app.cameras.mode);
  if (selected && !onBoard) {
    const estimate = estimates.vehicles[estimates.byName.get(selected.name)];
    const error = estimate?.estimate && estimates.showGhosts ? `  error ${estimate.error_m.toFixed(2)} m` : '';
    labels.text(selected.at, selected.name + error, {color: selected.color, dy: -22, bold: true});
  }
  if (!app.options.get('labels')) return;
  // With many vehicles only the near ones are labeled.
  const meter_px = app.camera.projectionMatrix.elements[5] * app.sides.regions[0].height / 2;
  for (const vehicle of vehicles) {
    const seen_px = vehicle.radius_m * meter_px / vehicle.at.distanceTo(app.camera.position);
    if (vehicle === selected || (vehicles.length > MANY && seen_px < 6)) continue;
    labels.text(vehicle.at, vehicle.name, {color: vehicle.color, dy: [-16, -34, 12]});
  }
  if (app.zones.root.visible)
    for (const zone of app.zones.labels ?? []) labels.text(zone.at, zone.text, {color: '#cc79a7'});
}
