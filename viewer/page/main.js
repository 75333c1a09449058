// SPDX-License-Identifier: BSD-3-Clause
// The live page: brings the parts together and draws the frames.
import {Branches} from './branches.js';
import {MODES} from './cameras.js';
import {Ghosts} from './compare.js';
import {Connection} from './connection.js';
import {Drive} from './drive.js';
import {Forms} from './forms.js';
import {Instruments} from './instruments.js';
import {makeLayers} from './layers.js';
import {Marks} from './marks.js';
import {Details, Events, formatTime, Legend, Scores, VehicleList} from './panels.js';
import {Past} from './past.js';
import {Picking} from './picking.js';
import {Playback} from './playback.js';
import {probe} from './probe.js';
import {readScene} from './protocol.js';
import {Resolution} from './resolution.js';
import {Address, Options, pressKey, setUpFolds, setUpKeyList, Tabs, Theme} from './settings.js';
import {SideBySide} from './side_by_side.js';
import {Stability} from './stability.js';
import {TimeBar} from './time_bar.js';
import {describeVehicles, moveVehicles, truthAt} from './vehicles.js';
import {Box3, Vector3} from './vendor/three.js';

const $ = (id) => document.getElementById(id);

const sizeOf = (box) => box.getSize(new Vector3()).length();

/** While time passes the panels are written this far apart: each time costs a layout. */
const PANELS_MS = 125;
/** The camera moves for this time after the last vehicle has come into view again. */
const CATCH_UP_S = 1;

/** The page. */
class App {
  /** `recording`: a run inside of the page; null: a server sends one. */
  constructor(recording) {
    this.recording = recording;
    this.address = new Address();
    this.live = new Playback();
    this.data = null;
    this.noRun = '';  // why there is no run
    this.vehicles = [];
    this.selected = null;
    this.dirty = true;
    this.keepsAll = false;  // the camera follows vehicles that leave the view
    this.catchesUp_s = 0;
    this.frames = 0;
    this.drawn = 0;
    this.cpu_ms = [];
    this.last_ms = performance.now();
    Object.assign(this, makeLayers($('view'), (text) => this.problem(text), () => {
                    this.dirty = true;
                  }));
    this.camera = this.cameras.camera;
    this.resolution = new Resolution(this.renderer, this.software);
    this.picking = new Picking($('view'), this);
    this.setUpPanels();
    addEventListener('keydown', (event) => pressKey(this, event));
    addEventListener('resize', () => this.resize());
    this.resize();
    const handlers = this.setUpConnection();
    this.instruments = new Instruments(this);
    this.recording?.start(handlers);
    requestAnimationFrame((now_ms) => this.frame(now_ms));
  }

  /** The panels and buttons. */
  setUpPanels() {
    this.list = new VehicleList((name) => this.select(name), (name) => this.follow(name));
    this.details = new Details((device) => this.lookThrough(device));
    this.scores = new Scores((time_us) => this.timeBar.goTo(time_us));
    this.stability = new Stability();
    this.events = new Events((time_us) => this.timeBar.goTo(time_us));
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
    this.bodies.onShape = () => {
      this.fitDue ||= this.isFirstView;
    };
    this.cameras.controls.addEventListener('start', () => {
      this.isFirstView = this.keepsAll = false;
    });
  }

  /** Makes the connection, and returns the handlers of its messages. */
  setUpConnection() {
    const handlers = {
      state: (state) => this.takeState(state),
      message: (message) => this.take(message),
      data: (message) => this.instruments.take(message),
      problem: (text) => this.problem(text),
    };
    if (this.recording) {
      this.connection = this.recording;
      this.assets.source = (hash) => this.recording.asset(hash);
    } else {
      const url = new URL('.', location.href);
      url.protocol = url.protocol === 'https:' ? 'wss:' : 'ws:';
      url.hash = '';
      this.connection = new Connection(url.href, this.address.token, handlers);
    }
    this.timeBar = new TimeBar(this.connection, (text) => Events.toast(text));
    this.drive = new Drive(this.connection, (text) => Events.toast(text));
    this.forms = new Forms(this.connection);
    this.past = new Past(this.connection, () => this.jumpTo(this.playback.newest?.time_us ?? 0), () => this.newest_us);
    this.ghosts = new Ghosts(this.scene, this.assets, this.connection);
    const goTo = (time_us) => this.timeBar.goTo(time_us);
    this.branches = new Branches((branch) => {
      this.ghosts.show(branch);
      this.otherEstimates.replace([]);
      this.sides?.show();
      this.dirty = true;
    }, goTo);
    this.sides = new SideBySide(this);
    this.marks = new Marks(goTo);
    Object.assign(this.timeBar, {past: this.past, marks: this.marks});
    return handlers;
  }

  /** Shows what is wrong: in the list of events, and for some seconds over the scene. */
  problem(text) {
    this.events.add([{kind: 'problem', text}]);
    Events.toast(text);
  }

  takeState(state) {
    if (!this.data || state.revision !== this.data.revision) return;
    if (state.past) {
      if (this.ghosts.take(state) || this.past.take(state, performance.now())) this.dirty = true;
      return;
    }
    const before_us = this.newest_us;
    this.live.push(state, performance.now());
    this.timeBar.setNewest(state.time_us);
    this.fitDue ||= this.fitPending;
    this.fitPending = false;
    // The time went back, or was set: what belongs to another time goes.
    if (!this.past.active && (state.jump || state.time_us < before_us)) this.jumpTo(state.time_us);
  }

  /** What is drawn: the present, or the past that the page looks at. */
  get playback() { return this.past?.shown ? this.past.playback : this.live; }

  /** Time of the newest state of the run. */
  get newest_us() { return this.live.newest?.time_us ?? 0; }

  /** Removes what belongs to another time than the one shown from now on. */
  jumpTo(time_us) {
    this.layers.tell('rewind', time_us);
    this.otherEstimates.rewind(time_us);
    this.instruments.rewind(time_us);
    this.live.drawn = this.past.playback.drawn = null;
    this.dirty = true;
  }

  /** Takes events: for the list and the time line. */
  addEvents(items, message) {
    if (!this.events.take(items, message)) return;
    if (message.all) this.marks.clearEvents();
    this.marks.add(items);
  }

  /** Takes estimates: of the run or log that is shown, or of another branch. */
  takeEstimates(branch, items) {
    if (Number.isInteger(branch)) {
      if (branch === this.ghosts.branch) this.otherEstimates.replace(items);
    } else if (!this.past.active) {
      this.estimates.add(items);
    }
  }

  /** Takes the greeting of a server, which may be another one than before. */
  setHello(message) {
    this.past.clear();
    this.branches.clear();
    [this.timeBar, this.drive, this.forms].forEach((part) => part.setHello(message));
    this.noRun = String(message.problem ?? '');
    this.currents.motion.random = [];
    this.instruments.greet();
  }

  setBranches(message) {
    this.branches.set(message);
    this.sides.show();
    this.marks.setDifferences(this.branches.differences());
  }

  /** Handles a text message by its op; unknown ones are those of a later version. */
  take(message) {
    const items = Array.isArray(message.items) ? message.items : [];
    const handlers = {
      hello: () => this.setHello(message),
      forms: () => {
        this.drive.setDrives(message.drives);
        this.forms.setForms(message);
      },
      scene: () => this.setScene(readScene(message)),
      status: () => this.setStatus(message),
      estimates: () => this.takeEstimates(message.branch, items),
      sounds: () => this.sounds.origin_m && this.sounds.add(items),
      receptions: () => {
        if (this.sounds.origin_m) this.sounds.addReceptions(items);
        this.legend.add(items.map((item) => item.outcome));
      },
      events: () => this.addEvents(items, message),
      branches: () => this.setBranches(message),
      scores: () => this.setScores(message),
      current: () => this.currents.motion.take(message),
      reply: () => this.drive.reply(message) || this.forms.reply(message) || this.timeBar.reply(message),
      error: () => this.problem(String(message.text)),
      dropped: () => this.problem(`the server dropped ${message.count} messages: this page is too slow`),
      ...this.ownLayers.handlers(message, this),
      ...this.instruments.handlers(message),
    };
    if (Object.hasOwn(handlers, message.op)) handlers[message.op]();
    this.dirty = true;
  }

  setStatus(message) {
    const {hello} = this.timeBar;
    this.timeBar.setStatus(message);
    this.connection.setStatus(message);
    this.scores.setOver(Boolean(message.ended) || (hello.source === 'log' && message.time_us >= hello.end_us));
  }

  setScores(message) {
    this.scores.set(message);
    this.stability.set(message.metrics ?? []);
  }

  /** Builds a scene; the camera stays if the world is the same. */
  setScene(data) {
    const same = this.data?.world === data.world && this.vehicles.length > 0;
    const kept = this.selected ?? this.address.get('select'), isFirst = this.data === null;
    this.data = data;
    this.live.clear();
    if (same)
      this.past.renew();
    else
      this.past.clear();
    this.ghosts.setScene(data);
    this.bodies.setScene(data);
    this.extent_m = this.cameras.extent_m = Math.max(2, 0.5 * sizeOf(this.bodies.boundingBox()));
    this.vehicles = describeVehicles(data);
    this.byName = new Map(this.vehicles.map((vehicle) => [vehicle.name, vehicle]));
    this.owners =
        new Map(this.vehicles.map((vehicle) => [data.bodies[vehicle.body].owner || vehicle.name, vehicle.name]));
    // Everything else that is drawn.
    this.layers.tell('setScene', data, this);
    this.otherEstimates.setScene(data);
    this.instruments.setScene(data);
    this.applyOptions();
    // Panels.
    $('world').textContent = data.world || 'Shoal';
    $('world').title = data.world;
    document.title = data.world ? `${data.world} – Shoal` : 'Shoal';
    this.list.setScene(this.vehicles);
    this.forms.setVehicles(data.vehicles);
    this.legend.clear();
    if (!same) {
      this.scores.clear();
      this.stability.clear();
      this.instruments.restart();
    }
    // Events of the first world may come before its scene.
    if (!same && !isFirst) {
      this.events.clear();
      this.marks.clear();
    }
    this.select(this.byName.has(kept) ? kept : null);
    if (same) return;
    this.fit();
    const view = this.address.get('view');
    if (view)
      this.setView(view);
    else
      this.fitPending = this.isFirstView = true;  // again with the first state, and with each shape that comes later
    // One vehicle alone: follow it.
    if (!view && this.vehicles.length === 1) this.follow(this.vehicles[0].name);
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
    this.drive.setVehicle(name);
    this.dirty = true;
  }

  follow(name) {
    this.select(name);
    this.setMode('follow');
  }

  setMode(mode) {
    if (!this.cameras.setMode(mode, this.vehicle)) Events.toast('select a vehicle first');
    this.fitDue = this.fitPending = this.isFirstView = this.keepsAll = false;  // the user has chosen where to look
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
    this.keepsAll = false;
    this.cameras.setView(text, this.vehicle);
    this.cameras.update(0, this.vehicle, this.bodies.X_WB);
    this.showMode();
  }

  lookThrough(device) {
    this.cameras.device = device;
    this.setMode('device');
  }

  /** Does the part of the view that no panel covers show all vehicles? */
  showsAll() {
    const {wide, high} = this.sides.free, at = new Vector3();
    return this.vehicles.every((vehicle) => {
      if (!Number.isFinite(vehicle.at.x)) return true;
      at.copy(vehicle.at).project(this.camera);
      return at.z < 1 && Math.abs(at.x) < wide && Math.abs(at.y) < high;
    });
  }

  /** Brings vehicles that have left the view into it again, until the user moves the camera. */
  followAll(dt_s) {
    if (!this.keepsAll || this.cameras.mode !== 'orbit') return;
    this.catchesUp_s = this.showsAll() ? this.catchesUp_s - dt_s : CATCH_UP_S;
    if (this.catchesUp_s > 0) this.fit(1 - Math.exp(-4 * dt_s));
  }

  /** Shows all that moves, with some of its surroundings; `share`: how far the camera goes there. */
  fit(share = 1) {
    const box = this.bodies.boundingBox(), center = box.getCenter(new Vector3());
    const around_m = Math.max(0.05, Math.min(2, ...this.vehicles.map((vehicle) => 0.5 * vehicle.radius_m)));
    box.expandByVector(new Vector3(around_m, around_m, 0));
    for (const ghost of this.ghosts.ghosts)
      if (ghost.root.visible) box.expandByPoint(ghost.at);
    // One vehicle alone does not fill the page.
    const min_size_m = 2.5 * Math.max(0.05, this.vehicles[0]?.radius_m ?? 0.4);
    box.union(new Box3().setFromCenterAndSize(center, new Vector3(min_size_m, min_size_m, min_size_m)));
    this.cameras.fit(box, this.sides.free, share);
    this.keepsAll = true;
    this.showMode();
    this.dirty = true;
  }

  measure(on = !this.picking.measuring) {
    this.picking.setMeasuring(on);
    $('measure').setAttribute('aria-pressed', on);
    if (on) Events.toast('pick two points', true);
    this.dirty = true;
  }

  toggleSides() {
    if (!this.sides.toggle()) Events.toast('show a branch or a second log as ghosts first');
  }

  /** Takes the switches under "Show". */
  applyOptions() {
    const get = (name) => this.options.get(name);
    this.layers.tell('choose', get);
    this.otherEstimates.choose(get);
    this.bodies.setShapes(get('shapes'));
    this.dirty = true;
  }

  resize() {
    this.resolution.reset();
    this.renderer.setSize(innerWidth, innerHeight, false);
    this.labels.resize(innerWidth, innerHeight, devicePixelRatio);
    this.camera.aspect = this.sides?.aspect ?? innerWidth / innerHeight;
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
    this.past.tick(start_ms);
    const moved = this.playback.sample(start_ms);
    if (moved) this.move();
    if (this.ghosts.update(this.playback.time_us)) this.dirty = true;
    if (moved && this.fitDue) {
      this.fitDue = false;
      this.fit();
    }
    if (moved) this.followAll(dt_s);
    this.cameras.update(dt_s, this.vehicle, this.bodies.X_WB);
    this.showMode();
    const key = this.viewKey();
    if (this.resolution.adapt(moved || key !== this.drawnKey, now_ms)) this.dirty = true;
    this.dirty = this.instruments.update(start_ms) || this.dirty;
    if (moved || this.dirty || key !== this.drawnKey) {
      this.drawnKey = key;
      this.dirty = false;
      this.draw();
      ++this.drawn;
      this.updatePanels(start_ms);
      this.cpu_ms.push(performance.now() - start_ms);
      if (this.cpu_ms.length > 60) this.cpu_ms.shift();
    } else {
      this.updatePanels(start_ms);
    }
    this.writeAddress(now_ms);
  }

  viewKey() {
    return `${this.camera.matrixWorld.elements.map((x) => x.toFixed(5)).join()} ${this.camera.fov} ${
        this.picking.points.length}`;
  }

  writeAddress(now_ms) {
    if (!this.address.due(now_ms)) return;
    this.address.write(
        {
          view: this.cameras.mode === 'device' ? '' : this.cameras.view(),
          select: this.selected,
          ...this.instruments.toAddress(),
          ...this.sides.toAddress()
        },
        now_ms);
  }

  showBanner() {
    const text = this.connection.banner(formatTime(this.playback.time_us)) || this.noRun;
    if ($('banner').textContent === text) return;
    $('banner').textContent = text;
    $('banner').hidden = text === '';
    $('banner').classList.toggle('calm', this.connection.isOver);
  }

  /** Moves the bodies and what belongs to them to the poses of the playback. */
  move() {
    const {time_us, poses} = this.playback;
    this.bodies.update(poses);
    moveVehicles(this.vehicles, this.bodies);
    this.trails.sample(time_us, this.vehicles.map((vehicle) => vehicle.at));
    const estimates = this.estimates.vehicles;
    this.estimateTrails.sample(
        time_us, estimates.map((one) => (one.estimate ? new Vector3().setFromMatrixPosition(one.X_WV) : null)));
  }

  /** What the layers draw, which depends on the time and the camera. */
  get view() {
    const {playback, camera, cameras, vehicles, vehicle, selected} = this;
    return {
      time_us: playback.time_us,
      speed: playback.newest?.speed ?? 1,
      paused: playback.newest?.paused !== false,
      now_ms: performance.now(),
      camera,
      focus: cameras.focus,
      distance_m: camera.position.distanceTo(cameras.focus),
      height_px: this.sides.regions[0].height * this.renderer.getPixelRatio(),
      onBoard: ['first', 'device'].includes(cameras.mode),
      shadows: this.options.get('shadows'),
      level_m: this.level(),
      placed: playback.version > 0,
      groundAt: (x, y) => this.bodies.groundAt(x, y),
      vehicles,
      vehicle,
      selected,
      X_WB: this.bodies.X_WB,
      X_WVs: vehicles.map(({X_WV}) => X_WV),
      truthAt: (i, at_us) => truthAt(vehicles[i], at_us, this.bodies, playback),
    };
  }

  /** Draws a frame. */
  draw() {
    if (this.currents.motion.setTime(this.playback.time_us)) this.environment.setLevel(this.level());
    const {view} = this;
    this.bodies.follow(this.camera, view.distance_m);
    this.layers.tell('update', view);
    this.legend.setSlowness(this.sounds.slowness);
    this.sides.render();
    this.instruments.recorder.frame();
    this.panelsStale = true;
  }

  /** Writes the numbers of the last frame into the panels: at once while the time stands, else at intervals. */
  updatePanels(now_ms) {
    const plays = this.playback.newest?.paused === false;
    if (!this.panelsStale || (plays && now_ms - this.panels_ms < PANELS_MS)) return;
    this.panelsStale = false;
    this.panels_ms = now_ms;
    const {time_us} = this.playback;
    this.timeBar.update(time_us);
    const vehicle = this.vehicle;
    this.branches.setDistances(this.ghosts.distances(this.bodies.X_WB), vehicle?.body);
    // Before the first state the bodies are not where their vehicle is.
    if (!vehicle || this.playback.version === 0) return;
    const estimate = this.estimates.vehicles[this.estimates.byName.get(vehicle.name)];
    this.details.update(time_us, vehicle.X_WV, this.data.origin_m, estimate, this.data.water);
  }

  /** Position of a vehicle on the page; null: not in view. */
  pixelOf(vehicle) { return this.labels.project(vehicle.at, this.camera); }
}

/** Starts the page; where there is no WebGL it says so. */
async function start() {
  try {
    // Only a page that is one file has this module in use.
    const run = window.shoalRecording;
    const app = new App(run ? new (await import('./recording.js')).Recording(run) : null);
    // For tests, and for the console.
    window.shoal = {
      probe: () => probe(app),
      waterHeights: (points, time_us) => app.water.heights(app.renderer, points, time_us),
      bodyMask: async (view) => (await import('./mask.js')).bodyMask(app, view),
      bodies: () => app.data.bodies.map(({name, owner, parts}) => ({name, owner, parts})),
      currentAt: (point, time_us) => app.currents.motion.velocityAt(point, time_us),
      tideAt: (time_us) => app.currents.motion.tideAt(time_us),
      waterLevel: () => app.data.water?.level_m ?? null,
      seek: (time_us) => app.connection.send({op: 'seek', time_us}),
      setView: (text) => app.setView(text),
      select: (name) => app.select(name),
      returnsOf: (channel) => app.instruments.returns.pointsOf(channel),
      presentColor: (name) => app.bodies.presentColor(name),
      raysOf: (channel) => app.instruments.returns.pointsOf(channel, 'rays'),
      sonarPixel: (channel, u, v) => app.instruments.sonars.pixelOf(channel, u, v),
      modems: () => app.instruments.traffic.modems.rows(),
      imageOf: (channel) => app.instruments.images.view?.views.find((one) => one.channel === channel),
    };
  } catch (error) {
    $('banner').textContent = `this page cannot draw: ${error.message}`;
    $('banner').hidden = false;
    throw error;
  }
}

start();
