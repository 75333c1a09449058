// SPDX-License-Identifier: BSD-3-Clause
// What is shown and another branch, or a second log, side by side: one canvas, two parts, the same camera and time.
// Where the page is higher than wide they stand one above the other.
import {drawAnnotations, drawNames} from './labels.js';
import {formatTime} from './panels.js';
import {Vector3} from './vendor/three.js';

const $ = (id) => document.getElementById(id);
/** Pages that are narrower than this have the parts one above the other, as in style.css. */
const NARROW_PX = 760;
/** The server keeps states this far apart. */
const END_US = 100000;

/** The two parts of the page; app: the page. */
export class SideBySide {
  constructor(app) {
    this.app = app;
    this.chosen = app.address.get('beside') === '1';
    this.drawn = false;
    this.others = [];
    $('sides').value = this.chosen ? 'beside' : 'over';
    $('sides').addEventListener('change', () => this.choose($('sides').value === 'beside'));
  }

  /** Are there two parts? */
  get on() { return this.chosen && this.app.ghosts.branch !== null; }

  choose(beside) {
    const before = this.aspect;
    this.chosen = beside;
    $('sides').value = beside ? 'beside' : 'over';
    this.show();
    // What was seen from left to right still is.
    const after = this.aspect;
    if (before !== after && this.app.cameras.controls.enabled)
      this.app.cameras.zoom(
          Math.max(1, innerWidth / innerHeight / after) / Math.max(1, innerWidth / innerHeight / before));
  }

  /** The key: the other way of showing both. */
  toggle() {
    if (this.app.ghosts.branch === null) return false;
    this.choose(!this.chosen);
    return true;
  }

  /** Brings the page in line with the choice, with what is compared and with the size. */
  show() {
    const {app} = this, {branches} = app;
    $('sides-row').hidden = app.ghosts.branch === null;
    $('side-names').hidden = !this.on;
    const named = (branch) => branches.items.find((item) => item.branch === branch);
    this.present = named(branches.present);
    this.other = named(app.ghosts.branch);
    this.showNames();
    app.camera.aspect = this.aspect;
    app.camera.updateProjectionMatrix();
    app.dirty = true;
  }

  /** Names of the parts; a branch that has ended before the time shown stands still. */
  showNames() {
    const {branches, playback} = this.app;
    const name = (item) => {
      const over = item && Number.isFinite(item.end_us) && playback.time_us > item.end_us + END_US;
      return item ? branches.titleOf(item) + (over ? `, ended at ${formatTime(item.end_us)}` : '') : '';
    };
    for (const [id, text] of [['side-a', name(this.present)], ['side-b', name(this.other)]])
      if ($(id).textContent !== text) $(id).textContent = text;
  }

  /** Parts of the page, in CSS pixels from its upper left corner. */
  get regions() {
    const whole = {x: 0, y: 0, width: innerWidth, height: innerHeight};
    if (!this.on) return [whole];
    if (innerWidth <= NARROW_PX)
      return [0, 1].map((i) => ({...whole, y: i * innerHeight / 2, height: innerHeight / 2}));
    return [0, 1].map((i) => ({...whole, x: i * innerWidth / 2, width: innerWidth / 2}));
  }

  get aspect() {
    const [{width, height}] = this.regions;
    return width / height;
  }

  /** The part at a position of the page: its place, and whether it is that of the other one. */
  regionAt(x, y) {
    const {regions} = this;
    const other = regions.length > 1 && (x >= regions[1].x && y >= regions[1].y);
    return {...regions[other ? 1 : 0], other};
  }

  /** Position on the page of a vehicle in the part at a position; null: not in view. */
  pixelOf(vehicle, x, y) {
    const {labels, camera} = this.app, before = labels.region;
    labels.region = this.on ? this.regionAt(x, y) : null;
    const at = labels.project(vehicle.at, camera);
    labels.region = before;
    return at;
  }

  /** Numbers for tests: null as long as there is one part. */
  probe(world) {
    if (!this.on) return null;
    const [, b] = this.regions;
    const others = this.others.map((vehicle) => ({
                                     name: vehicle.name,
                                     position: world(vehicle.at),
                                     pixel: this.pixelOf(vehicle, b.x + 1, b.y + 1),
                                   }));
    return {regions: this.regions, names: [$('side-a').textContent, $('side-b').textContent], others};
  }

  /** Does something while the bodies are where the other branch has them. */
  withOther(work) {
    const {bodies, ghosts, playback} = this.app;
    const poses = ghosts.poses ?? new Float32Array(7 * bodies.movable.length).fill(NaN);
    const kept = bodies.movable.map((body) => bodies.X_WB[body].clone());
    bodies.update(poses);
    try {
      return work();
    } finally {
      bodies.movable.forEach((body, i) => bodies.X_WB[body].copy(kept[i]));
      bodies.update(playback.poses);
    }
  }

  /** Draws the scene and what is written over it. */
  render() {
    const {app} = this, {renderer, scene, camera} = app;
    if (!this.on) {
      if (this.drawn) this.drawIn({x: 0, y: 0, width: innerWidth, height: innerHeight}, false);
      this.drawn = false;
      app.labels.region = null;
      renderer.render(scene, camera);
      drawAnnotations(app);
      app.labels.end();
      return;
    }
    this.drawn = true;
    this.showNames();
    const [a, b] = this.regions;
    // The present one without the ghosts.
    app.ghosts.root.visible = false;
    this.drawIn(a, true);
    renderer.render(scene, camera);
    app.labels.region = a;
    drawAnnotations(app);
    // The other one without what belongs to the present one only.
    this.drawIn(b, true);
    const hidden = scene.children.filter((object) => object.visible && !app.shared.has(object));
    for (const object of hidden) object.visible = false;
    this.withOther(() => {
      this.placeOthers();
      renderer.render(scene, camera);
    });
    for (const object of hidden) object.visible = true;
    app.ghosts.root.visible = true;
    app.labels.region = b;
    app.labels.enter();
    app.labels.limit();
    drawNames(app, this.others);
    app.labels.end();
    app.labels.enter();
    app.labels.region = a;  // positions on the page are those of the present one
  }

  /** Limits drawing to a part; three.js measures from the lower left corner. */
  drawIn({x, y, width, height}, only) {
    const {renderer} = this.app, bottom = innerHeight - y - height;
    renderer.setViewport(x, bottom, width, height);
    renderer.setScissor(x, bottom, width, height);
    renderer.setScissorTest(only);
  }

  placeOthers() {
    this.others = this.app.vehicles
                      .map((vehicle) => {
                        const X_WV = this.app.bodies.X_WB[vehicle.body].clone().multiply(vehicle.X_BV);
                        return {...vehicle, at: new Vector3().setFromMatrixPosition(X_WV)};
                      })
                      .filter((vehicle) => Number.isFinite(vehicle.at.x));
  }

  /** For the address of the page. */
  toAddress() { return {beside: this.chosen ? '1' : ''}; }
}
