// SPDX-License-Identifier: BSD-3-Clause
// The live page: brings the parts together and draws the frames.
import {Bodies, matrixOf, radiusOf} from './bodies.js';
import {Cameras, MODES} from './cameras.js';
import {Connection} from './connection.js';
import {Environment} from './environment.js';
import {Estimates} from './estimates.js';
import {Labels} from './labels.js';
import {Dots, FieldsOfView, SelectionRing, Zones} from './overlays.js';
import {Details, Events, formatTime, Legend, Scores, VehicleList} from './panels.js';
import {Picking} from './picking.js';
import {Playback} from './playback.js';
import {readScene} from './protocol.js';
import {Address, coveredWidth, Options, setUpFolds, setUpKeyList, Tabs, Theme} from './settings.js';
import {Assets} from './shapes.js';
import {Sounds} from './sounds.js';
import {TimeBar} from './time_bar.js';
import {trailColor, Trails} from './trails.js';
import {NoToneMapping, PCFShadowMap, Quaternion, Scene, Vector3, WebGLRenderer} from './vendor/three.js';
import {Water} from './water.js';

const $ = (id) => document.getElementById(id);

/** More vehicles than this have names only where they are near. */
const MANY = 60;

/** Is WebGL drawn by the processor?  Then shadows and fine water are off. */
function isSoftware(gl) {
  const info = gl.getExtension('WEBGL_debug_renderer_info');
  return /swiftshader|llvmpipe|software/i.test(info ? gl.getParameter(info.UNMASKED_RENDERER_WEBGL) : '');
}

/** The page. */
class App {
  constructor() {
    this.address = new Address();
    this.playback = new Playback();
    this.data = null;
    this.vehicles = [];
    this.selected = null;
    this.dirty = true;
    this.frames = 0;
    this.drawn = 0;
    this.cpu_ms = [];
    this.last_ms = performance.now();
    this.setUpScene();
    this.setUpPanels();
    this.setUpConnection();
    addEventListener('keydown', (event) => this.key(event));
    addEventListener('resize', () => this.resize());
    this.resize();
    requestAnimationFrame((now_ms) => this.frame(now_ms));
  }

  /** The parts that draw. */
  setUpScene() {
    this.renderer = new WebGLRenderer({canvas: $('view'), antialias: true, powerPreference: 'high-performance'});
    this.software = isSoftware(this.renderer.getContext());
    this.renderer.toneMapping = NoToneMapping;
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.scene = new Scene();
    this.assets = new Assets('asset', (text) => this.problem(text), () => {
      this.dirty = true;
    });
    this.environment = new Environment(this.scene);
    this.bodies = new Bodies(this.scene, this.assets);
    this.water = new Water(this.scene, this.software);
    this.sounds = new Sounds(this.scene);
    this.estimates = new Estimates(this.scene, this.assets);
    this.trails = new Trails(this.scene);
    this.estimateTrails = new Trails(this.scene);
    this.views = new FieldsOfView(this.scene);
    this.zones = new Zones(this.scene);
    this.dots = new Dots(this.scene);
    this.ring = new SelectionRing(this.scene);
    this.labels = new Labels($('labels'));
    this.cameras = new Cameras($('view'));
    this.camera = this.cameras.camera;
    this.picking = new Picking($('view'), this);
  }

  /** The panels and buttons. */
  setUpPanels() {
    this.list = new VehicleList((name) => this.select(name), (name) => this.follow(name));
    this.details = new Details((device) => this.lookThrough(device));
    this.scores = new Scores();
    this.events = new Events();
    this.legend = new Legend();
    this.theme = new Theme(() => {
      this.dirty = true;
    });
    this.options = new Options(() => this.applyOptions());
    this.tabs = new Tabs();
    setUpFolds();
    setUpKeyList();
    $('camera').addEventListener('change', () => this.setMode($('camera').value));
    $('fit').addEventListener('click', () => this.fit());
    $('measure').addEventListener('click', () => this.measure());
    $('follow').addEventListener('click', () => this.setMode('follow'));
    $('chase').addEventListener('click', () => this.setMode('chase'));
    $('first').addEventListener('click', () => this.setMode('first'));
    $('unselect').addEventListener('click', () => this.select(null));
    if (this.software) this.options.set('shadows', false);
    this.applyOptions();
  }

  setUpConnection() {
    const url = new URL('.', location.href);
    url.protocol = url.protocol === 'https:' ? 'wss:' : 'ws:';
    url.hash = '';
    this.connection = new Connection(url.href, this.address.token, {
      state: (state) => this.takeState(state),
      message: (message) => this.take(message),
      problem: (text) => this.problem(text),
    });
    this.timeBar = new TimeBar(this.connection, (text) => Events.toast(text));
  }

  /** Shows what is wrong: in the list of events, and for some seconds over the scene. */
  problem(text) {
    this.events.add([{kind: 'problem', text}]);
    Events.toast(text);
  }

  takeState(state) {
    if (!this.data || state.revision !== this.data.revision) return;
    const before_us = this.playback.newest?.time_us ?? 0;
    this.playback.push(state, performance.now());
    this.fitDue ||= this.fitPending;
    this.fitPending = false;
    // The time went back, or was set: what belongs to another time goes.
    if (state.jump || state.time_us < before_us) {
      this.sounds.clear();
      this.estimates.rewind(state.time_us);
      this.trails.clear();
      this.estimateTrails.clear();
    }
  }

  /** Handles a text message by its op; unknown ones are those of a later version. */
  take(message) {
    const items = Array.isArray(message.items) ? message.items : [];
    const handlers = {
      hello: () => this.timeBar.setHello(message),
      scene: () => this.setScene(readScene(message)),
      status: () => this.timeBar.setStatus(message),
      estimates: () => this.estimates.add(items),
      sounds: () => this.sounds.origin_m && this.sounds.add(items),
      receptions: () => {
        if (this.sounds.origin_m) this.sounds.addReceptions(items);
        this.legend.add(items.map((item) => item.outcome));
      },
      events: () => this.events.add(items),
      scores: () => this.scores.set(message),
      reply: () => this.timeBar.reply(message),
      error: () => this.problem(String(message.text)),
      dropped: () => this.problem(`the server dropped ${message.count} messages: this page is too slow`),
    };
    if (Object.hasOwn(handlers, message.op)) handlers[message.op]();
    this.dirty = true;
  }

  /** Builds a scene; the camera stays if the world is the same. */
  setScene(data) {
    const same = this.data?.world === data.world && this.vehicles.length > 0;
    const kept = this.selected ?? this.address.get('select');
    this.data = data;
    this.playback.clear();
    this.bodies.setScene(data);
    const sphere = this.bodies.boundingSphere();
    this.extent_m = this.cameras.extent_m = Math.max(2, sphere.radius);
    this.vehicles = data.vehicles.map((vehicle) => this.describe(vehicle));
    this.byName = new Map(this.vehicles.map((vehicle) => [vehicle.name, vehicle]));
    this.owners =
        new Map(this.vehicles.map((vehicle) => [data.bodies[vehicle.body].owner || vehicle.name, vehicle.name]));
    // Everything else that is drawn.
    this.environment.setScene(data, this.extent_m);
    this.water.setScene(data);
    this.sounds.setScene(data, this.extent_m);
    this.estimates.setScene(data);
    this.views.setScene(data);
    this.zones.setScene(data, this.extent_m);
    const colors = this.vehicles.map((vehicle) => trailColor(vehicle.color));
    this.trails.reset(colors);
    this.estimateTrails.reset(colors.map(() => trailColor('#ffb000')));
    this.dots.setScene(colors, this.vehicles.map((vehicle) => vehicle.radius_m));
    this.applyOptions();
    // Panels.
    $('world').textContent = data.world || 'Shoal';
    $('world').title = data.world;
    document.title = data.world ? `${data.world} – Shoal` : 'Shoal';
    this.list.setScene(this.vehicles);
    this.legend.clear();
    if (!same) this.events.clear();
    this.select(this.byName.has(kept) ? kept : null);
    if (same) return;
    this.fit();
    const view = this.address.get('view');
    if (view)
      this.setView(view);
    else
      this.fitPending = true;  // again with the first state
  }

  /** What the page knows of a vehicle. */
  describe(vehicle) {
    const own = this.data.bodies[vehicle.body];
    const first = own.parts.find((part) => part.color) ?? own.parts[0];
    const color = first ? `#${this.bodies.colorOf(own, first).getHexString()}` : '#888888';
    return {
      ...vehicle,
      color,
      radius_m: Math.max(0.1, radiusOf(own)),
      X_BV: matrixOf(vehicle.pose),
      X_WV: matrixOf(vehicle.pose),
      at: new Vector3()
    };
  }

  /** Name of the vehicle that a body belongs to; null: none. */
  owner(body) { return this.owners?.get(this.data.bodies[body]?.owner) ?? null; }

  /** Height that the mouse points at where there is no surface. */
  level() { return this.data?.water ? this.data.water.level_m - this.data.origin_m[2] : 0; }

  get vehicle() { return this.byName?.get(this.selected) ?? null; }

  /** Selects a vehicle; null: none. */
  select(name) {
    this.selected = name;
    if (name === null && ['follow', 'chase', 'first', 'device'].includes(this.cameras.mode)) this.setMode('orbit');
    this.list.setSelected(name);
    this.details.setVehicle(this.vehicle);
    this.dirty = true;
  }

  follow(name) {
    this.select(name);
    this.setMode('follow');
  }

  setMode(mode) {
    if (!this.cameras.setMode(mode, this.vehicle)) Events.toast('select a vehicle first');
    this.showMode();
    this.dirty = true;
  }

  /** Brings the list of cameras in line with the camera. */
  showMode() {
    const mode = this.cameras.mode;
    if (this.shownMode === mode) return;
    this.shownMode = mode;
    const select = $('camera');
    let device = select.querySelector('[value="device"]');
    if (mode === 'device' && !device) select.append(device = new Option('Device', 'device'));
    if (mode !== 'device') device?.remove();
    select.value = mode;
    select.title = MODES[mode];
  }

  setView(text) {
    this.cameras.setView(text, this.vehicle);
    this.cameras.update(0, this.vehicle, this.bodies.X_WB);
    this.showMode();
  }

  lookThrough(device) {
    this.cameras.device = device;
    this.setMode('device');
  }

  /** Shows all that moves. */
  fit() {
    const sphere = this.bodies.boundingSphere();
    this.cameras.fit(sphere, (innerWidth - coveredWidth()) / innerHeight);
    this.showMode();
    this.dirty = true;
  }

  measure(on = !this.picking.measuring) {
    this.picking.setMeasuring(on);
    $('measure').setAttribute('aria-pressed', on);
    if (on) Events.toast('pick two points', true);
    this.dirty = true;
  }

  /** Takes the switches under "Show". */
  applyOptions() {
    const get = (name) => this.options.get(name);
    this.water.shown = get('water');
    this.sounds.shown = get('sounds');
    this.estimates.showGhosts = get('ghosts');
    this.estimates.showEllipsoids = get('ellipsoids');
    this.zones.root.visible = get('zones');
    this.views.which = get('sensors');
    const length_s = Math.min(3600, Math.max(0, Number(get('trails')) || 0));
    this.trails.length_s = this.estimateTrails.length_s = length_s;
    this.estimateTrails.lines.visible = get('ghosts');
    this.environment.setClarity(Number(get('clarity')) >= 4 ? 0 : Number(get('clarity')) + 0.05);
    this.dirty = true;
  }

  key(event) {
    const typing = /^(INPUT|SELECT|TEXTAREA)$/.test(event.target.tagName) && event.target.type !== 'checkbox';
    if (event.key === 'Escape') this.escape(event);
    if (typing || event.ctrlKey || event.metaKey || event.altKey || $('keys').open) return;
    const onButton = event.target.tagName === 'BUTTON';
    const next = (step) => {
      const name = this.list.neighbour(step);
      if (name !== null) this.select(name);
    };
    const actions = {
      ' ': () => onButton || this.timeBar.togglePlay(),
      '.': () => this.timeBar.step(1),
      ':': () => this.timeBar.step(10),
      '>': () => this.timeBar.step(10),
      ',': () => this.timeBar.skip(-1),
      ';': () => this.timeBar.skip(-10),
      '[': () => next(-1),
      ']': () => next(1),
      f: () => this.setMode('follow'),
      c: () => this.setMode('chase'),
      Home: () => this.fit(),
      m: () => this.measure(),
      v: () => this.options.toggle(),
      t: () => this.theme.toggle(),
      l: () => this.options.set('labels', !this.options.get('labels')),
      '?': () => $('keys').showModal(),
      '+': () => this.cameras.zoom(0.8),
      '=': () => this.cameras.zoom(0.8),
      '-': () => this.cameras.zoom(1.25),
      '/': () => {
        if ($('left-body').hidden) $('fold-left').click();
        $('search').focus();
      },
    };
    ['orbit', 'top', 'follow', 'chase', 'first', 'fly'].forEach((mode, i) => {
      actions[String(i + 1)] = () => this.setMode(mode);
    });
    if (!Object.hasOwn(actions, event.key) || (this.cameras.mode === 'fly' && /^[wasdqe]$/.test(event.key))) return;
    actions[event.key]();
    if (!(event.key === ' ' && onButton)) event.preventDefault();
  }

  escape(event) {
    if (!$('options').hidden)
      this.options.toggle(false);
    else if (this.picking.measuring)
      this.measure(false);
    else if (event.target === $('search'))
      $('view').focus();
    else if (!$('keys').open)
      this.select(null);
  }

  resize() {
    const ratio = Math.min(devicePixelRatio, this.software ? 1 : 2);
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(innerWidth, innerHeight, false);
    this.labels.resize(innerWidth, innerHeight, devicePixelRatio);
    this.camera.aspect = innerWidth / innerHeight;
    this.camera.updateProjectionMatrix();
    this.dirty = true;
  }

  /** One frame: take the newest states, move, draw if anything changed. */
  frame(now_ms) {
    requestAnimationFrame((next_ms) => this.frame(next_ms));
    const start_ms = performance.now();
    const dt_s = Math.min(0.1, (now_ms - this.last_ms) / 1000);
    this.last_ms = now_ms;
    this.connection.acknowledge();
    ++this.frames;
    this.showBanner();
    if (!this.data) return;
    const moved = this.playback.sample(start_ms);
    if (moved) this.move();
    if (moved && this.fitDue) {
      this.fitDue = false;
      this.fit();
    }
    this.cameras.update(dt_s, this.vehicle, this.bodies.X_WB);
    this.showMode();
    const key = this.viewKey();
    if (moved || this.dirty || key !== this.drawnKey) {
      this.drawnKey = key;
      this.dirty = false;
      this.draw();
      ++this.drawn;
      this.cpu_ms.push(performance.now() - start_ms);
      if (this.cpu_ms.length > 60) this.cpu_ms.shift();
    }
    this.writeAddress(now_ms);
  }

  viewKey() {
    return `${this.camera.matrixWorld.elements.map((x) => x.toFixed(5)).join()} ${this.camera.fov} ${
        this.picking.points.length}`;
  }

  writeAddress(now_ms) {
    this.address.write(
        {view: this.cameras.mode === 'device' ? '' : this.cameras.view(), select: this.selected}, now_ms);
  }

  showBanner() {
    const text = this.connection.banner(formatTime(this.playback.time_us));
    if ($('banner').textContent === text) return;
    $('banner').textContent = text;
    $('banner').hidden = text === '';
  }

  /** Moves the bodies and what belongs to them to the poses of the playback. */
  move() {
    const {time_us, poses} = this.playback;
    this.bodies.update(poses);
    for (const vehicle of this.vehicles) {
      vehicle.X_WV.multiplyMatrices(this.bodies.X_WB[vehicle.body], vehicle.X_BV);
      vehicle.at.setFromMatrixPosition(vehicle.X_WV);
    }
    this.trails.sample(time_us, this.vehicles.map((vehicle) => vehicle.at));
    const estimates = this.estimates.vehicles;
    this.estimateTrails.sample(
        time_us, estimates.map((one) => (one.estimate ? new Vector3().setFromMatrixPosition(one.X_WV) : null)));
  }

  /** Position of the frame of a vehicle at a time not long ago; null: unknown. */
  truthAt(vehicle, time_us) {
    const slot = this.bodies.movable.indexOf(vehicle.body);
    const pose = slot < 0 ? null : this.playback.poseAt(slot, time_us);
    if (!pose) return null;
    const offset = new Vector3().setFromMatrixPosition(vehicle.X_BV);
    return offset.applyQuaternion(new Quaternion(pose[3], pose[4], pose[5], pose[6]))
        .add(new Vector3(...pose.slice(0, 3)));
  }

  /** Draws a frame. */
  draw() {
    const {time_us} = this.playback;
    const X_WVs = this.vehicles.map((vehicle) => vehicle.X_WV);
    const focus = this.cameras.focus, distance_m = this.camera.position.distanceTo(focus);
    const height_px = innerHeight * this.renderer.getPixelRatio();
    // Everything that depends on the time or the camera.
    this.environment.update(this.camera, focus, distance_m, this.options.get('shadows'));
    this.bodies.follow(this.camera);
    this.water.update(time_us, this.camera);
    this.sounds.update(time_us, this.playback.newest?.speed ?? 1);
    this.estimates.update(X_WVs, (i, at_us) => this.truthAt(this.vehicles[i], at_us));
    this.views.update(this.bodies.X_WB, this.selected);
    this.trails.update(time_us);
    this.estimateTrails.update(time_us);
    if (!this.options.get('ghosts')) this.estimateTrails.lines.visible = false;
    this.dots.update(X_WVs, this.camera, height_px);
    const vehicle = this.vehicle;
    const onBoard = ['first', 'device'].includes(this.cameras.mode);
    this.ring.update(vehicle?.X_WV ?? null, vehicle?.radius_m ?? 1, this.camera, height_px, onBoard);
    this.renderer.render(this.scene, this.camera);
    this.drawLabels();
    this.updatePanels(time_us);
  }

  updatePanels(time_us) {
    this.timeBar.update(time_us);
    const vehicle = this.vehicle;
    if (!vehicle) return;
    const estimate = this.estimates.vehicles[this.estimates.byName.get(vehicle.name)];
    this.details.update(time_us, vehicle.X_WV, this.data.origin_m, estimate, this.data.water);
  }

  drawLabels() {
    const {labels} = this;
    labels.begin(this.camera, this.theme.colors);
    for (const ring of this.sounds.shown ? this.sounds.rings : []) this.drawRing(ring);
    for (const mark of this.sounds.visibleMarks ?? []) {
      const snr = Number.isFinite(mark.snr_dB) ? ` ${mark.snr_dB.toFixed(0)} dB` : '';
      labels.mark(mark.at, mark.look, `${mark.look.text}${snr}`);
    }
    if (this.picking.points.length === 2) {
      labels.line(...this.picking.points, '#ffd166');
      const middle = this.picking.points[0].clone().add(this.picking.points[1]).multiplyScalar(0.5);
      labels.text(middle, this.picking.text(), {bold: true});
    } else if (this.picking.points.length === 1) {
      labels.text(this.picking.points[0], '× first point', {bold: true});
    }
    this.drawNames();
  }

  /** The front of a sound at the depth of its source, as wide as the sound lasts. */
  drawRing({sound, outer_m, inner_m}) {
    const middle_m = (outer_m + inner_m) / 2;
    const metre_px = this.camera.projectionMatrix.elements[5] * innerHeight / 2 /
        Math.max(1, this.camera.position.distanceTo(sound.at));
    const width_px = Math.min(40, Math.max(1.5, (outer_m - inner_m) * metre_px));
    const color = {ping: '#f0e442', answer: '#009e73', noise: '#cc79a7'}[sound.kind] ?? '#56b4e9';
    this.labels.circle(sound.at, middle_m, color, width_px, 0.38);
  }

  drawNames() {
    const {labels} = this;
    const selected = this.vehicle;
    const onBoard = ['first', 'device'].includes(this.cameras.mode);
    if (selected && !onBoard) {
      const estimate = this.estimates.vehicles[this.estimates.byName.get(selected.name)];
      const error = estimate?.estimate && this.estimates.showGhosts ? `  error ${estimate.error_m.toFixed(2)} m` : '';
      labels.text(selected.at, selected.name + error, {color: selected.color, dy: -22, bold: true});
    }
    if (!this.options.get('labels')) return;
    // Of many vehicles only those that are near have their names.
    const metre_px = this.camera.projectionMatrix.elements[5] * innerHeight / 2;
    for (const vehicle of this.vehicles) {
      const seen_px = vehicle.radius_m * metre_px / vehicle.at.distanceTo(this.camera.position);
      if (vehicle === selected || (this.vehicles.length > MANY && seen_px < 6)) continue;
      labels.text(vehicle.at, vehicle.name, {color: vehicle.color, dy: -16});
    }
    if (this.zones.root.visible)
      for (const zone of this.zones.labels ?? []) labels.text(zone.at, zone.text, {color: '#cc79a7'});
  }

  /** Position of a vehicle on the page; null: not in view. */
  pixelOf(vehicle) { return this.labels.project(vehicle.at, this.camera); }

  /** Numbers of what is drawn, for tests: positions in the world, pixels, sizes. */
  probe() {
    const sorted = [...this.cpu_ms].sort((a, b) => a - b);
    const origin = new Vector3(...(this.data?.origin_m ?? [0, 0, 0]));
    const world = (point) => point.clone().add(origin).toArray();
    const place = new Vector3();
    return {
      frames: this.drawn,
      ticks: this.frames,
      cpu_ms: sorted[sorted.length >> 1] ?? null,
      software: this.software,
      draw_calls: this.renderer.info.render.calls,
      triangles: this.renderer.info.render.triangles,
      scene: this.data && {world: this.data.world, revision: this.data.revision},
      tape: this.picking.text(),
      time_us: this.playback.time_us,
      connected: this.connection.isOpen,
      banner: $('banner').textContent,
      control: this.timeBar.hello.control === true,
      selected: this.selected,
      camera: {
        mode: this.cameras.mode,
        position: world(this.camera.position),
        target: world(this.cameras.focus),
        fov_deg: this.camera.fov,
      },
      bodies: this.bodies.X_WB.map((X, i) => ({
                                     name: this.bodies.list[i].name,
                                     position: world(place.setFromMatrixPosition(X)),
                                     pixel: this.labels.project(place, this.camera),
                                   })),
      vehicles: this.vehicles.map((vehicle, i) => ({
                                    name: vehicle.name,
                                    position: world(vehicle.at),
                                    pixel: this.pixelOf(vehicle),
                                    trail: this.trails.describe(i),
                                  })),
      estimates: this.estimates.vehicles.filter((one) => one.estimate).map((one) => ({
                                                                             vehicle: one.name,
                                                                             error_m: one.error_m,
                                                                             axes_m: one.axes?.lengths_m ?? null,
                                                                             axes: one.axes?.vectors ?? null,
                                                                           })),
      sounds: this.sounds.rings.map((ring) => ({
                                      id: ring.sound.id,
                                      outer_m: ring.outer_m,
                                      inner_m: ring.inner_m,
                                      center: world(ring.sound.at),
                                    })),
      marks: (this.sounds.visibleMarks ?? []).map((mark) => ({outcome: mark.outcome, position: world(mark.at)})),
    };
  }
}

const app = new App();
/** For tests: numbers of what is drawn, and heights of the water as the shader has them. */
window.shoal = {
  probe: () => app.probe(),
  waterHeights: (points, time_us) => app.water.heights(app.renderer, points, time_us),
  setView: (text) => app.setView(text),
  select: (name) => app.select(name),
};
