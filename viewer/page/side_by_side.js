// SPDX-License-Identifier: BSD-3-Clause
// Side-by-side view of the present and another branch, or of two logs: one canvas, two parts, same camera and time.
// Where the page is higher than wide they stand one above the other.
import {drawAnnotations, drawNames} from './labels.js';
import {formatTime} from './panels.js';
import {freeArea, NARROW_PX} from './settings.js';
import {truthAt} from './vehicles.js';
import {Vector3} from './vendor/three.js';

const $ = (id) => document.getElementById(id);
/** The least share of a view that counts as free of panels. */
const FREE_MIN = 0.2;
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
    const before = this.freeShare;
    this.chosen = beside;
    $('sides').value = beside ? 'beside' : 'over';
    this.show();
    // What was seen between the panels still is.
    const after = this.freeShare;
    if (before !== after && this.app.cameras.controls.enabled) this.app.cameras.zoom(before / after);
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
    this.fitCamera();
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

  /**
   * Views of the page, in CSS pixels from its upper left corner, and `clip`, the part of each that is seen.  Two
   * have the same size and share the page where the middle between the panels is; the middle of each is in the middle
   * of its share of what no panel covers.
   */
  get regions() {
    const page = {x: 0, y: 0, width: innerWidth, height: innerHeight};
    if (!this.on) return [{...page, clip: page}];
    const free = freeArea(), stacked = innerWidth <= NARROW_PX;
    const [at, size] = stacked ? ['y', 'height'] : ['x', 'width'];
    const split = Math.round(free[at] + free[size] / 2);
    const clips = [{...page, [size]: split}, {...page, [at]: split, [size]: page[size] - split}];
    const middles = [0.25, 0.75].map((share) => ({
                                       x: free.x + free.width * (stacked ? 0.5 : share),
                                       y: free.y + free.height * (stacked ? share : 0.5),
                                     }));
    const reach = (axis, extent) => 2 *
        Math.max(...clips.flatMap(
            (clip, i) => [middles[i][axis] - clip[axis], clip[axis] + clip[extent] - middles[i][axis]]));
    const width = reach('x', 'width'), height = reach('y', 'height');
    return clips.map((clip, i) => ({x: middles[i].x - width / 2, y: middles[i].y - height / 2, width, height, clip}));
  }

  get aspect() {
    const [{width, height}] = this.regions;
    return width / height;
  }

  /** What is seen between the panels about the middle of a view, as shares of its width and height. */
  get free() {
    const {x, y, width, height} = freeArea(), [view] = this.regions;
    const share = (from, size, middle, whole) =>
        Math.max(FREE_MIN, Math.min(1, 2 * Math.min(middle - from, from + size - middle) / whole));
    if (!this.on)
      return {wide: share(x, width, innerWidth / 2, innerWidth), high: share(y, height, innerHeight / 2, innerHeight)};
    // Each view is centered in its half.
    const stacked = innerWidth <= NARROW_PX;
    const part = (size, whole) => Math.max(FREE_MIN, Math.min(1, size / whole));
    return {
      wide: part(stacked ? width : width / 2, view.width),
      high: part(stacked ? height / 2 : height, view.height)
    };
  }

  /** The smaller side of it, as a share of the height of a view. */
  get freeShare() {
    const {wide, high} = this.free;
    return Math.min(1, wide * this.aspect, high);
  }

  /** Brings the camera in line with the size of a view, which changes with the panels. */
  fitCamera() {
    const {camera} = this.app, {aspect} = this;
    if (camera.aspect === aspect) return;
    camera.aspect = aspect;
    camera.updateProjectionMatrix();
  }

  /** The part at a position of the page: its place, and whether it is that of the other one. */
  regionAt(x, y) {
    const {regions} = this;
    const other = regions.length > 1 && (x >= regions[1].clip.x && y >= regions[1].clip.y);
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
    const [, {clip}] = this.regions, {otherEstimates} = this.app;
    const others = this.others.map((vehicle) => {
      const {estimate, error_m} = otherEstimates.vehicles[otherEstimates.byName.get(vehicle.name)];
      return {
        name: vehicle.name,
        position: world(vehicle.at),
        pixel: this.pixelOf(vehicle, clip.x + 1, clip.y + 1),
        error_m: estimate ? error_m : null,
      };
    });
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
    app.otherEstimates.root.visible = false;
    if (!this.on) {
      if (this.drawn) {
        this.drawIn(this.regions[0], false);
        this.fitCamera();
      }
      this.drawn = false;
      app.labels.region = null;
      renderer.render(scene, camera);
      drawAnnotations(app);
      app.labels.end();
      return;
    }
    this.drawn = true;
    this.showNames();
    this.fitCamera();
    const [a, b] = this.regions;
    const grid = b.clip.x === 0 ? `${b.clip.y}px 1fr / 1fr` : `1fr / ${b.clip.x}px 1fr`;
    if (this.grid !== grid) this.grid = $('side-names').style.gridTemplate = grid;
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
    app.otherEstimates.root.visible = true;
    this.withOther(() => {
      this.placeOthers();
      renderer.render(scene, camera);
    });
    app.otherEstimates.root.visible = false;
    for (const object of hidden) object.visible = true;
    app.ghosts.root.visible = true;
    app.labels.region = b;
    app.labels.enter();
    app.labels.limit();
    drawNames(app, this.others, app.otherEstimates);
    app.labels.end();
    app.labels.enter();
    app.labels.region = a;  // positions on the page are those of the present one
  }

  /** Limits drawing to a part; three.js measures from the lower left corner. */
  drawIn({x, y, width, height, clip}, only) {
    const {renderer} = this.app;
    renderer.setViewport(x, innerHeight - y - height, width, height);
    renderer.setScissor(clip.x, innerHeight - clip.y - clip.height, clip.width, clip.height);
    renderer.setScissorTest(only);
  }

  /** Places the vehicles of the other one, and its estimates. */
  placeOthers() {
    const {bodies, ghosts, otherEstimates, vehicles} = this.app;
    const all = vehicles.map((vehicle) => {
      const X_WV = bodies.X_WB[vehicle.body].clone().multiply(vehicle.X_BV);
      return {...vehicle, X_WV, at: new Vector3().setFromMatrixPosition(X_WV)};
    });
    this.others = all.filter((vehicle) => Number.isFinite(vehicle.at.x));
    otherEstimates.place(
        all.map((vehicle) => vehicle.X_WV),
        (i, at_us) => (Number.isFinite(all[i].at.x) ? truthAt(vehicles[i], at_us, bodies, ghosts) : null));
  }

  /** For the address of the page. */
  toAddress() { return {beside: this.chosen ? '1' : ''}; }
}
