// SPDX-License-Identifier: BSD-3-Clause
// Images of imaging sonars in the plane of their beams, at the pose that the sensor had when it measured.
import {FanImage} from './sonar_images.js';
import {
  BufferAttribute,
  BufferGeometry,
  DataTexture,
  DoubleSide,
  LinearFilter,
  Mesh,
  MeshBasicMaterial,
  SRGBColorSpace,
  Vector3,
} from './vendor/three.js';

const DEVICES_MAX = 16;
const RATE_HZ = 10;
/** Messages wait this long for the pose at their time. */
const WAIT_MS = 500;
const KEPT_US = 5e6;

/**
 * Corner of an image that has x of the sensor up and y to the left: (0, 0) is on top on the left.  Returns its place in
 * the frame of the sensor.
 */
export function placeOf(map, u, v) { return [map.top_m - v * map.pixel_m, map.left_m - u * map.pixel_m, 0]; }

/** One image, as a rectangle that is transparent outside of the fan. */
class SonarPlane {
  constructor(scene) {
    this.scene = scene;
    this.fan = new FanImage();
    this.material = new MeshBasicMaterial({transparent: true, opacity: 0.8, side: DoubleSide, depthWrite: false});
    this.mesh = new Mesh(new BufferGeometry(), this.material);
    this.mesh.matrixAutoUpdate = false;
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = 12;
    scene.add(this.mesh);
  }

  /** Shows a message at a pose; throws an Error that says what is wrong with it. */
  show({fields, time_us}, X_WS) {
    const image = this.fan.decode(fields), {width, height, rgba} = image;
    this.time_us = time_us;
    this.image = image;
    this.X_WS = X_WS.clone();
    if (this.map !== this.fan.map) this.build(this.fan.map);
    if (this.texture?.image.width !== width || this.texture.image.height !== height) this.makeTexture(width, height);
    this.texture.image.data.set(rgba);
    this.texture.needsUpdate = true;
    this.mesh.matrix.copy(X_WS);
    this.mesh.matrixWorldNeedsUpdate = true;
  }

  /** The rectangle of an image; v of the texture is down as in the image. */
  build(map) {
    this.map = map;
    const corners = [[0, 0], [1, 0], [1, 1], [0, 1]];
    this.mesh.geometry.dispose();
    this.mesh.geometry = new BufferGeometry();
    const places = corners.flatMap(([u, v]) => placeOf(map, u * map.width, v * map.height));
    this.mesh.geometry.setAttribute('position', new BufferAttribute(new Float32Array(places), 3));
    this.mesh.geometry.setAttribute('uv', new BufferAttribute(new Float32Array(corners.flat()), 2));
    this.mesh.geometry.setIndex([0, 1, 2, 0, 2, 3]);
  }

  makeTexture(width, height) {
    this.texture?.dispose();
    this.texture = new DataTexture(new Uint8Array(4 * width * height), width, height);
    this.texture.colorSpace = SRGBColorSpace;
    this.texture.minFilter = this.texture.magFilter = LinearFilter;
    this.material.map = this.texture;
    this.material.needsUpdate = true;
  }

  /** Place in the scene and value in dB of a pixel. */
  pixel(u, v) {
    const [x, y, z] = placeOf(this.map, u + 0.5, v + 0.5), i = v * this.image.width + u;
    const rgba = [...this.texture.image.data.subarray(4 * i, 4 * i + 4)];
    return {at: new Vector3(x, y, z).applyMatrix4(this.mesh.matrix), value_dB: this.image.values[i], rgba};
  }

  remove() {
    this.scene.remove(this.mesh);
    this.mesh.geometry.dispose();
    this.material.dispose();
    this.texture?.dispose();
  }
}

/** The images of the sonars of the selected vehicle, or of all. */
export class SonarPlanes {
  constructor(app, poses) {
    this.app = app;
    this.poses = poses;
    this.planes = new Map();
    this.pending = new Map();
    this.names = new Set();
  }

  clear() {
    for (const name of [...this.planes.keys()]) this.remove(name);
    this.pending.clear();
  }

  remove(name) {
    this.planes.get(name).remove();
    this.planes.delete(name);
    this.app.dirty = true;
  }

  /** Forgets what does not belong to a time that was set. */
  rewind(time_us) {
    for (const [name, one] of this.planes)
      if (one.time_us > time_us || one.time_us < time_us - KEPT_US) this.remove(name);
  }

  /** Wants the channels of the sonars whose images are shown. */
  subscribe(which) {
    this.names = this.poses.channelsOf(['imaging_sonar'], which, DEVICES_MAX);
    this.app.channels.want('sonar planes', this.names, RATE_HZ, (message) => {
      if (message.type === 'sonar_image_t') this.pending.set(message.channel, {message, at_ms: performance.now()});
    });
    for (const name of [...this.planes.keys()])
      if (!this.names.has(name)) this.remove(name);
  }

  /** Draws messages whose pose is known by now; returns true if anything changed. */
  update(now_ms) {
    let changed = false;
    for (const [channel, {message, at_ms}] of this.pending) {
      const mounted = this.poses.byChannel.get(channel);
      if (mounted && !this.poses.reached(message.time_us) && now_ms - at_ms < WAIT_MS) continue;
      this.pending.delete(channel);
      if (!mounted || !this.names.has(channel) || this.poses.isFuture(message.time_us)) continue;
      changed = this.draw(channel, mounted, message) || changed;
    }
    return changed;
  }

  draw(channel, mounted, message) {
    const plane = this.planes.get(channel) ?? new SonarPlane(this.app.scene);
    try {
      plane.show(message, this.poses.sensorAt(mounted, this.poses.sampleTime(message, mounted)));
      this.planes.set(channel, plane);
      return true;
    } catch (error) {
      if (!this.planes.has(channel)) plane.remove();
      if (this.failed !== channel) this.app.problem(`${channel}: this message ${error.message}`);
      this.failed = channel;
      return false;
    }
  }

  /** A pixel of the image of a channel, for tests; its place in the world. */
  pixelOf(channel, u, v) {
    const {at, value_dB, rgba} = this.planes.get(channel).pixel(u, v);
    return {at: at.toArray().map((x, k) => x + this.app.data.origin_m[k]), value_dB, rgba};
  }

  /** Numbers for tests. */
  probe() {
    return [...this.planes].map(([channel, {time_us, image}]) => ({
                                  channel,
                                  time_us,
                                  width: image.width,
                                  height: image.height,
                                }));
  }
}
