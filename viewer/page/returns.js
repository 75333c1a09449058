// SPDX-License-Identifier: BSD-3-Clause
// Returns of sensors in the scene: points of lidars and the rays to them, beams of a DVL, echoes of sonars, at the pose
// of the sensor when it measured.
import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DynamicDrawUsage,
  LineSegments,
  Points,
  ShaderMaterial,
  Sphere,
  Vector3
} from './vendor/three.js';

const DEVICES_MAX = 64;
const POINTS_MAX = 200000;
const RATE_HZ = 15;
/** Messages wait this long for the pose at their time. */
const WAIT_MS = 500;
const KEPT_US = 5e6;
/** Points of one revolution this close in time have the same pose. */
const SLOT_US = 10000;
const RING_STEPS = 32;
const TYPES = ['planar_lidar_t', 'point_cloud_t', 'dvl_t', 'sonar_range_t', 'multibeam_t'];
const DEVICES = ['lidar', 'lidar3d', 'dvl', 'sonar', 'altimeter', 'multibeam'];
/** Devices that have rays, from the sensor to each point. */
const LASERS = ['lidar', 'lidar3d'];
const COLORS = {
  planar_lidar_t: '#ff9d3c',
  point_cloud_t: '#ff9d3c',
  dvl_t: '#2fd6a3',
  sonar_range_t: '#7cc7ff',
  multibeam_t: '#7cc7ff'
};

const VERTEX = /* glsl */ `
uniform float size_px;
void main() {
  gl_Position = projectionMatrix * viewMatrix * vec4(position, 1.0);
  gl_PointSize = size_px;
}`;
const FRAGMENT = /* glsl */ `
uniform vec3 color;
uniform float round, opacity;
void main() {
  float off = round * 2.0 * length(gl_PointCoord - 0.5);
  if (off > 1.0) discard;
  // A dark rim, to be seen on any ground.
  gl_FragColor = vec4(mix(color, vec3(0.02, 0.05, 0.08), smoothstep(0.6, 0.8, off)), opacity);
  #include <colorspace_fragment>
}`;

const look = (color, round, opacity = 1) => new ShaderMaterial({
  uniforms: {color: {value: new Color(color)}, round: {value: round}, size_px: {value: 5}, opacity: {value: opacity}},
  vertexShader: VERTEX,
  fragmentShader: FRAGMENT,
  transparent: opacity < 1,
  depthWrite: opacity === 1,
});

/** Opacity of each of so many rays: thousands leave something to be seen behind them. As in images of `shoal snap`. */
const rayOpacity = (count) => Math.max(0.05, Math.min(0.6, 90 / Math.max(1, count)));

const finite = (values) => values.every(Number.isFinite);

function lidarPoints(fields, view) {
  const points = [], reach_m = view?.range_m ?? Infinity;
  const ranges = fields.ranges ?? [];
  for (let i = 0; i < ranges.length; ++i) {
    // The farthest range is that of a beam without a return.
    if (!(ranges[i] > 0) || ranges[i] >= reach_m - 1e-4 * reach_m) continue;
    const angle = fields.rad0 + i * fields.radstep;
    points.push([ranges[i] * Math.cos(angle), ranges[i] * Math.sin(angle), 0]);
  }
  return {points, lines: []};
}

function cloudPoints({x_m = [], y_m = [], z_m = [], time_offsets_us = []}) {
  const count = Math.min(x_m.length, y_m.length, z_m.length, POINTS_MAX), points = [];
  for (let i = 0; i < count; ++i) points.push([x_m[i], y_m[i], z_m[i], time_offsets_us[i] ?? 0]);
  return {points, lines: []};
}

function dvlBeams(fields, view) {
  const points = (view?.directions ?? []).map((direction, i) => {
    const range_m = fields.beam_range_m?.[i];
    return fields.beam_valid?.[i] && range_m !== null ? direction.map((part) => part * range_m) : [NaN, NaN, NaN];
  });
  const hits = points.filter(finite);
  return {points: hits, lines: hits.flatMap((hit) => [[0, 0, 0], hit])};
}

/** Range along the axis of a cone, with the circle that the cone has there. */
function sonarCone({valid, range_m}, view) {
  if (!valid || !Number.isFinite(range_m) || view?.kind !== 'cone') return {points: [], lines: []};
  const axis = new Vector3(...view.axis ?? [1, 0, 0]), hit = axis.clone().multiplyScalar(range_m);
  const side = new Vector3(axis.z, axis.x, axis.y).cross(axis).normalize(), up = axis.clone().cross(side);
  const radius_m = range_m * Math.tan(Math.min(1.4, view.half_angle_rad ?? 0));
  const rim = (i) => {
    const angle = 2 * Math.PI * i / RING_STEPS;
    return hit.clone()
        .addScaledVector(side, radius_m * Math.cos(angle))
        .addScaledVector(up, radius_m * Math.sin(angle))
        .toArray();
  };
  const lines = [[0, 0, 0], hit.toArray()];
  for (let i = 0; i < RING_STEPS; ++i) lines.push(rim(i), rim(i + 1));
  return {points: [hit.toArray()], lines};
}

function swath({angles_rad = [], ranges_m = [], valid = []}) {
  const points = [], lines = [];
  for (let i = 0; i < angles_rad.length; ++i) {
    if (!valid[i]) continue;
    points.push([0, ranges_m[i] * Math.sin(angles_rad[i]), -ranges_m[i] * Math.cos(angles_rad[i])]);
    if (i > 0 && valid[i - 1]) lines.push(points[points.length - 2], points[points.length - 1]);
  }
  if (points.length) lines.push([0, 0, 0], points[0], [0, 0, 0], points[points.length - 1]);
  return {points, lines};
}

/**
 * Points and ends of line segments of a message, in the frame of the sensor; a fourth number is a time offset in us.
 */
export function returnsOf({type, fields}, view) {
  const makers = {
    planar_lidar_t: lidarPoints,
    point_cloud_t: cloudPoints,
    dvl_t: dvlBeams,
    sonar_range_t: sonarCone,
    multibeam_t: swath,
  };
  const {points, lines} = makers[type](fields, view);
  return {points: points.filter(finite).slice(0, POINTS_MAX), lines: lines.flat().every(Number.isFinite) ? lines : []};
}

/** Replaces the positions of a geometry; its memory grows only. */
function setPositions(object, positions) {
  let attribute = object.geometry.getAttribute('position');
  if (!attribute || attribute.array.length < positions.length) {
    object.geometry.dispose();
    object.geometry = new BufferGeometry();
    attribute =
        new BufferAttribute(new Float32Array(3 * Math.ceil(0.4 * positions.length)), 3).setUsage(DynamicDrawUsage);
    object.geometry.setAttribute('position', attribute);
    // Never culled: its true sphere does not matter.
    object.geometry.boundingSphere = new Sphere();
  }
  attribute.array.set(positions);
  attribute.needsUpdate = true;
  object.geometry.setDrawRange(0, positions.length / 3);
  object.visible = positions.length > 0;
}

/** The returns of the devices of the selected vehicle, or of all. */
export class Returns {
  constructor(app, poses) {
    this.app = app;
    this.poses = poses;
    this.drawn = new Map();
    this.pending = new Map();
    this.pointLooks = new Map(), this.lineLooks = new Map();
    for (const type of TYPES) {
      this.pointLooks.set(type, look(COLORS[type], 1));
      this.lineLooks.set(type, look(COLORS[type], 0));
    }
  }

  clear() {
    for (const name of [...this.drawn.keys()]) this.remove(name);
    this.pending.clear();
  }

  remove(name) {
    const {points, lines, rays} = this.drawn.get(name);
    for (const object of [points, lines, rays]) {
      object.geometry.dispose();
      this.app.scene.remove(object);
    }
    rays.material.dispose();
    this.drawn.delete(name);
    this.app.dirty = true;
  }

  /** Forgets what does not belong to a time that was set. */
  rewind(time_us) {
    for (const [name, one] of this.drawn)
      if (one.time_us > time_us || one.time_us < time_us - KEPT_US) this.remove(name);
  }

  /** Wants the channels of the devices whose returns are shown, and of those with rays. */
  subscribe(which, ofRays) {
    this.shown = this.poses.channelsOf(DEVICES, which, DEVICES_MAX);
    this.traced = this.poses.channelsOf(LASERS, ofRays, DEVICES_MAX);
    this.names = new Set([...this.shown, ...this.traced]);
    this.app.channels.want('returns', this.names, RATE_HZ, (message) => this.take(message));
    for (const [name, {message}] of [...this.drawn])
      if (this.names.has(name))
        this.draw(name, this.poses.byChannel.get(name), message);
      else
        this.remove(name);
    this.app.dirty = true;
  }

  take(message) {
    if (TYPES.includes(message.type)) this.pending.set(message.channel, {message, at_ms: performance.now()});
  }

  /** Draws messages whose pose is known by now; returns true if anything changed. */
  update(now_ms) {
    let changed = false;
    for (const [channel, {message, at_ms}] of this.pending) {
      const mounted = this.poses.byChannel.get(channel);
      if (mounted && !this.poses.reached(message.time_us) && now_ms - at_ms < WAIT_MS) continue;
      this.pending.delete(channel);
      if (!mounted || !this.names.has(channel) || this.poses.isFuture(message.time_us)) continue;
      this.draw(channel, mounted, message);
      changed = true;
    }
    return changed;
  }

  draw(channel, mounted, message) {
    const time_us = this.poses.sampleTime(message, mounted);
    const {points, lines} = returnsOf(message, mounted.device.field_of_view);
    const one = this.drawn.get(channel) ?? this.make(channel, message.type);
    Object.assign(one, {message, time_us: message.time_us});
    // One pose for all points, or one for each slot of time.
    const X_WS = new Map(), at = new Vector3();
    const toWorld = (list) => {
      const positions = new Float32Array(3 * list.length);
      list.forEach((point, i) => {
        const slot = Math.round((point[3] ?? 0) / SLOT_US);
        if (!X_WS.has(slot)) X_WS.set(slot, this.poses.sensorAt(mounted, time_us + slot * SLOT_US));
        at.set(point[0], point[1], point[2]).applyMatrix4(X_WS.get(slot)).toArray(positions, 3 * i);
      });
      return positions;
    };
    const shown = this.shown.has(channel);
    const rays = this.traced.has(channel) ? points.flatMap((point) => [[0, 0, 0, point[3]], point]) : [];
    setPositions(one.points, toWorld(shown ? points : []));
    setPositions(one.lines, toWorld(shown ? lines : []));
    setPositions(one.rays, toWorld(rays));
    one.rays.material.uniforms.opacity.value = rayOpacity(points.length);
  }

  make(channel, type) {
    const one = {
      type,
      points: new Points(new BufferGeometry(), this.pointLooks.get(type)),
      lines: new LineSegments(new BufferGeometry(), this.lineLooks.get(type)),
      rays: new LineSegments(new BufferGeometry(), look(COLORS[type], 0, 0.5))
    };
    for (const object of [one.rays, one.points, one.lines]) {
      object.frustumCulled = false;
      object.renderOrder = object === one.rays ? 13 : 14;
      this.app.scene.add(object);
    }
    this.drawn.set(channel, one);
    return one;
  }

  /** Points of a channel in the world, or the two ends of each of its rays, for tests. */
  pointsOf(channel, kind = 'points') {
    const one = this.drawn.get(channel);
    if (!one) return null;
    const {geometry} = one[kind], origin = this.app.data.origin_m;
    const values = geometry.getAttribute('position')?.array ?? [];
    const count = geometry.drawRange.count;
    return [...Array(count).keys()].map((i) => origin.map((o, k) => o + values[3 * i + k]));
  }
}
