// SPDX-License-Identifier: BSD-3-Clause
// Data of sensors on the page: the panel of plots, images, clocks, traffic, water and distances of two logs; returns,
// images of sonars and ranges in the scene.
import {Distances} from './distances.js';
import {Dock} from './dock.js';
import {LazyView} from './lazy_view.js';
import {Channels} from './messages.js';
import {Plots} from './plots.js';
import {Recorder} from './recorder.js';
import {Returns} from './returns.js';
import {SensorPoses} from './sensor_poses.js';
import {panelsText, setPanels} from './settings.js';
import {Traffic} from './traffic.js';

const LIST_MS = 500;
/** Types of devices that measure ranges to others. */
const RANGING_DEVICES = ['usbl', 'lbl', 'range_beacon', 'acoustic_modem', 'micromodem'];

/** Brings them together; the page calls this one only. */
export class Instruments {
  constructor(app) {
    this.app = app;
    app.channels = new Channels(app.connection, () => this.listChanged());
    this.poses = new SensorPoses(app);
    this.returns = new Returns(app, this.poses);
    this.sonars = null;
    this.ranges = null;
    this.lights = null;
    this.plots = new Plots(app);
    this.images = new LazyView('images', 'Images', async () => new (await import('./image_panel.js')).Images(app));
    this.clocks = new LazyView('clocks', 'Clocks', async () => new (await import('./clocks.js')).Clocks(app));
    this.traffic = new Traffic(app);
    this.water = new LazyView('water', 'Water', async () => new (await import('./water_panel.js')).WaterPanel(app));
    this.distances = new Distances(app);
    this.recorder = new Recorder(app);
    this.dock = new Dock([this.plots, this.images, this.clocks, this.traffic, this.water, this.distances], () => {
      app.dirty = true;
    });
    this.listed_ms = 0;
    this.fromAddress();
  }

  /** Opens what the address names. */
  fromAddress() {
    const {address} = this.app;
    if (address.get('plots')) this.plots.setText(address.get('plots'));
    this.imagesAsked = address.get('images');
    if (this.imagesAsked) this.images.apply('images', (view) => view.setText(this.imagesAsked));
    if (address.get('panels') !== null) setPanels(address.get('panels'));
    this.dock.show(address.get('data'));
  }

  /** What the address is to have. */
  toAddress() {
    return {
      data: this.dock.open,
      plots: this.plots.text(),
      images: this.images.view?.text() ?? this.imagesAsked,
      panels: panelsText()
    };
  }

  /** Handlers of texts by their op. */
  handlers(message) {
    return {
      channels: () => this.app.channels.setItems(message),
      links: () => this.traffic.setReceptions(message),
      modems: () => this.traffic.modems.set(message),
      distances: () => this.distances.set(message),
      series: () => this.plots.setSeries(message),
    };
  }

  /** The server said hello: it knows nothing of what this page wants. */
  greet() {
    this.app.channels.subscribe(true);
    this.plots.subscribe();
    this.plots.request();
  }

  take(message) { this.app.channels.take(message); }

  setScene(data) {
    this.poses.setScene(data);
    this.returns.clear();
    this.sonars?.clear();
    this.ranges?.clear();
    this.water.apply('scene', (view) => view.setScene(data));
    this.loadParts(data);
    this.listChanged();
    this.key = null;
  }

  /** Loads what draws images of sonars, ranges and lights, if the scene has devices that give them. */
  async loadParts({vehicles}) {
    const has = (types) => vehicles.some(({devices}) => devices.some((device) => types.includes(device.type)));
    if (has(['imaging_sonar']) && !this.sonars) {
      const {SonarPlanes} = await import('./sonar_planes.js');
      this.sonars ??= new SonarPlanes(this.app, this.poses);
    }
    if (has(RANGING_DEVICES) && !this.ranges) {
      const {Ranges} = await import('./ranges.js');
      this.ranges ??= new Ranges(this.app, this.poses);
    }
    if (has(['led']) && !this.lights) {
      const {Lights} = await import('./lights.js');
      this.lights ??= new Lights(this.app, this.poses);
    }
    this.key = null;  // to subscribe
    this.app.dirty = true;
  }

  /** Another run: nothing of the one before stays. */
  restart() {
    this.app.channels.clear();
    this.traffic.clear();
    this.plots.restart();
    this.distances.clear();
    this.lights?.clear();
    this.listChanged();
  }

  rewind(time_us) {
    this.app.channels.rewind(time_us);
    this.returns.rewind(time_us);
    this.sonars?.rewind(time_us);
    this.ranges?.rewind(time_us);
    this.lights?.rewind();
  }

  listChanged() { this.listStale = true; }

  /** Before a frame: returns true if the scene has changed. */
  update(now_ms) {
    if (this.listStale && now_ms - this.listed_ms > LIST_MS) {
      this.listStale = false;
      this.listed_ms = now_ms;
      this.dock.view?.changed?.();
    }
    const {options, selected, data} = this.app;
    const chosen = ['returns', 'rays', 'ranges'].map((name) => options.get(name));
    const key = JSON.stringify([chosen, selected, data.revision]);
    if (key !== this.key) {
      this.key = key;
      this.returns.subscribe(options.get('returns'), options.get('rays'));
      this.sonars?.subscribe(options.get('returns'));
      this.ranges?.subscribe(options.get('ranges'), RANGING_DEVICES);
      this.lights?.subscribe();
    }
    this.dock.update(now_ms);
    const changed = [this.returns, this.sonars, this.ranges, this.lights].map((part) => part?.update(now_ms));
    return changed.includes(true);
  }

  annotate(labels, time_us) { this.ranges?.draw(labels, time_us); }

  /** Numbers for tests. */
  probe() {
    const origin = this.app.data?.origin_m ?? [0, 0, 0];
    return {
      dock: this.dock.open,
      plots: this.plots.plots.map((plot) => plot.traces.map((trace) => ({
                                                              channel: trace.channel,
                                                              field: trace.path,
                                                              unit: trace.unit,
                                                              count: trace.t_s.length,
                                                              first_s: trace.t_s[0] ?? null,
                                                              last_s: trace.t_s[trace.t_s.length - 1] ?? null,
                                                            }))),
      images: (this.images.view?.views ?? []).map(({channel, image, time_us}) => ({
                                                    channel,
                                                    time_us,
                                                    width: image?.width,
                                                    height: image?.height,
                                                  })),
      returns: [...this.returns.drawn].map(([channel, one]) => ({
                                             channel,
                                             time_us: one.time_us,
                                             count: one.points.geometry.drawRange.count,
                                             rays: one.rays.geometry.drawRange.count / 2,
                                           })),
      ranges: (this.ranges?.shown(this.app.playback.time_us) ??
               []).map((range) => ({
                         name: range.name,
                         range_m: range.range_m,
                         true_m: range.true_m,
                         center: range.center.toArray().map((x, i) => x + origin[i]),
                       })),
      sonars: this.sonars?.probe() ?? [],
      distances: this.distances.probe(),
      saved: this.recorder.last,
    };
  }
}
