// SPDX-License-Identifier: BSD-3-Clause
// Drawings that explain the scene: fields of view of devices, zones, dots and rings of vehicles.
import {matrixOf} from './bodies.js';
import {trailColor} from './trails.js';
import {
  BufferAttribute,
  BufferGeometry,
  DoubleSide,
  Group,
  LineBasicMaterial,
  LineSegments,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  Points,
  Quaternion,
  ShaderMaterial,
  Vector3,
} from './vendor/three.js';

const VIEWS_MAX = 400;
const ARC_STEPS = 48;

function segments(points) {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(new Float32Array(points), 3));
  return geometry;
}

/** Points of line segments along a function of 0..1. */
function along(curve, steps = ARC_STEPS) {
  const points = [];
  for (let i = 0; i < steps; ++i) points.push(...curve(i / steps), ...curve((i + 1) / steps));
  return points;
}

/** Line segments of a field of view, in the frame of the sensor. */
export function fieldOfViewLines(view) {
  const r = Number(view.range_m);
  if (!(r > 0)) return null;
  if (view.kind === 'fan') {
    const from = view.from_rad, span = view.to_rad - view.from_rad;
    const edge = (angle) => [r * Math.cos(angle), r * Math.sin(angle), 0];
    const rim = along((share) => edge(from + share * span));
    return span < 6.28 ? [...rim, 0, 0, 0, ...edge(from), 0, 0, 0, ...edge(from + span)] : rim;
  }
  if (view.kind === 'cone') {
    const x = r * Math.cos(view.half_angle_rad), radius_m = r * Math.sin(view.half_angle_rad);
    const edge = (share) => [x, radius_m * Math.cos(2 * Math.PI * share), radius_m * Math.sin(2 * Math.PI * share)];
    const points = along(edge);
    for (let i = 0; i < 8; ++i) points.push(0, 0, 0, ...edge(i / 8));
    // Rotation from x to the axis of the cone.
    const turn = new Quaternion().setFromUnitVectors(new Vector3(1, 0, 0), new Vector3(...view.axis ?? [1, 0, 0]));
    const point = new Vector3();
    for (let i = 0; i < points.length; i += 3) point.fromArray(points, i).applyQuaternion(turn).toArray(points, i);
    return points;
  }
  if (view.kind === 'frustum') {
    const y = r * Math.tan(Math.min(1.5, view.horizontal_rad / 2));
    const z = r * Math.tan(Math.min(1.5, view.vertical_rad / 2));
    const corners = [[r, y, z], [r, -y, z], [r, -y, -z], [r, y, -z]];
    return corners.flatMap((corner, i) => [0, 0, 0, ...corner, ...corner, ...corners[(i + 1) % 4]]);
  }
  if (view.kind === 'beams')
    return (view.directions ?? []).flatMap((d) => [0, 0, 0, ...d.map((component) => component * r)]);
  return null;
}

/** Fields of view of the devices of the selected vehicle, or of all. */
export class FieldsOfView {
  constructor(scene) {
    this.root = new Group();
    this.material = new LineBasicMaterial({color: '#35c6d8', transparent: true, opacity: 0.55, depthWrite: false});
    this.which = 'selected';
    scene.add(this.root);
  }

  choose(get) { this.which = get('sensors'); }

  /** Takes the devices of a scene. */
  setScene(data) {
    this.root.traverse((object) => object.geometry?.dispose());
    this.root.clear();
    for (const vehicle of data.vehicles)
      for (const device of vehicle.devices) {
        const points = device.field_of_view ? fieldOfViewLines(device.field_of_view) : null;
        if (!points || !points.every(Number.isFinite) || this.root.children.length >= VIEWS_MAX) continue;
        const lines = new LineSegments(segments(points), this.material);
        lines.matrixAutoUpdate = false;
        lines.frustumCulled = false;
        lines.userData = {vehicle: vehicle.name, body: device.body, X_BS: matrixOf(device.pose)};
        this.root.add(lines);
      }
  }

  /** Moves them with their bodies. */
  update({X_WB, selected}) {
    for (const lines of this.root.children) {
      const {vehicle, body, X_BS} = lines.userData;
      lines.visible = this.which === 'all' || (this.which === 'selected' && vehicle === selected);
      if (lines.visible) lines.matrix.multiplyMatrices(X_WB[body], X_BS);
    }
  }
}

/** Zones: outlines, and walls between their heights. */
export class Zones {
  constructor(scene) {
    this.root = new Group();
    this.lines = new LineBasicMaterial({color: '#cc79a7'});
    this.walls = new MeshBasicMaterial(
        {color: '#cc79a7', transparent: true, opacity: 0.10, side: DoubleSide, depthWrite: false});
    scene.add(this.root);
  }

  choose(get) { this.root.visible = get('zones'); }

  /** Takes the zones of a scene. */
  setScene(data, {extent_m}) {
    this.root.traverse((object) => object.geometry?.dispose());
    this.root.clear();
    this.labels = [];
    for (const zone of data.zones) {
      // Without heights: a low wall at the ground.
      const base = zone.z_m[0] ?? (zone.z_m[1] !== null ? zone.z_m[1] - 0.1 * extent_m : data.water?.level_m ?? 0);
      const top = zone.z_m[1] ?? base + Math.max(0.2, 0.02 * extent_m);
      const corners = zone.polygon_m.map(([x, y]) => [x - data.origin_m[0], y - data.origin_m[1]]);
      const low = base - data.origin_m[2], high = top - data.origin_m[2];
      const rim = [], wall = [];
      corners.forEach((a, i) => {
        const b = corners[(i + 1) % corners.length];
        for (const z of [low, high]) rim.push(...a, z, ...b, z);
        wall.push(...a, low, ...b, low, ...b, high, ...a, low, ...b, high, ...a, high);
      });
      this.root.add(new LineSegments(segments(rim), this.lines), new Mesh(segments(wall), this.walls));
      const center =
          corners.reduce((sum, c) => [sum[0] + c[0] / corners.length, sum[1] + c[1] / corners.length], [0, 0]);
      const text = zone.flags.includes('gps_denied') ? `${zone.name} ⊘ no GPS` : zone.name;
      this.labels.push({text, at: new Vector3(center[0], center[1], high)});
    }
  }
}

const DOT_VERTEX = /* glsl */ `
attribute vec3 tint;
attribute float radius_m;
uniform float pixels;
varying vec4 vTint;
void main() {
  gl_Position = projectionMatrix * viewMatrix * vec4(position, 1.0);
  gl_PointSize = 9.0;
  // Only where the vehicle itself is too small to see.
  float seen_px = pixels * radius_m / gl_Position.w;
  vTint = vec4(tint, 1.0 - smoothstep(5.0, 11.0, seen_px));
}`;
const DOT_FRAGMENT = /* glsl */ `
varying vec4 vTint;
void main() {
  float off = length(gl_PointCoord - 0.5) * 2.0;
  if (off > 1.0 || vTint.a < 0.02) discard;
  float alpha = vTint.a * (1.0 - smoothstep(0.85, 1.0, off));
  gl_FragColor = vec4(mix(vTint.rgb, vec3(1.0), smoothstep(0.55, 0.75, off)), alpha);
  #include <colorspace_fragment>
}`;

/** Dots at vehicles that are far away. */
export class Dots {
  constructor(scene) {
    this.pixels = {value: 1};
    const material = new ShaderMaterial({
      uniforms: {pixels: this.pixels},
      vertexShader: DOT_VERTEX,
      fragmentShader: DOT_FRAGMENT,
      transparent: true,
      depthWrite: false,
    });
    this.points = new Points(new BufferGeometry(), material);
    this.points.frustumCulled = false;
    this.points.renderOrder = 16;
    scene.add(this.points);
  }

  setScene(data, {vehicles}) {
    const colors = vehicles.map(({color}) => trailColor(color));
    const geometry = new BufferGeometry();
    this.position = new BufferAttribute(new Float32Array(3 * colors.length), 3);
    geometry.setAttribute('position', this.position);
    geometry.setAttribute('tint', new BufferAttribute(new Float32Array(colors.flatMap((c) => c.toArray())), 3));
    geometry.setAttribute('radius_m', new BufferAttribute(new Float32Array(vehicles.map(({radius_m}) => radius_m)), 1));
    this.points.geometry.dispose();
    this.points.geometry = geometry;
  }

  /** Moves the dots to the vehicles; `height_px`: of the canvas. */
  update({X_WVs, camera, height_px}) {
    this.pixels.value = camera.projectionMatrix.elements[5] * height_px;
    X_WVs.forEach((X, i) => this.position?.setXYZ(i, X.elements[12], X.elements[13], X.elements[14]));
    if (this.position) this.position.needsUpdate = true;
  }
}

/** Ring about the selected vehicle, at least some pixels wide. */
export class SelectionRing {
  constructor(scene) {
    const curve = (share) => [Math.cos(2 * Math.PI * share), Math.sin(2 * Math.PI * share), 0];
    const points = [...along(curve, 64), 1, 0, 0, 1.35, 0, 0];
    this.lines = new LineSegments(
        segments(points), new LineBasicMaterial({color: '#ffd166', depthTest: false, transparent: true, opacity: 0.9}));
    this.lines.matrixAutoUpdate = false;
    this.lines.frustumCulled = false;
    this.lines.renderOrder = 35;
    scene.add(this.lines);
  }

  /** Draws it level, with a tick along the heading of the vehicle. */
  update({vehicle, camera, height_px, onBoard}) {
    this.lines.visible = vehicle !== null && !onBoard;
    if (!this.lines.visible) return;
    const {X_WV, radius_m} = vehicle;
    const at = new Vector3().setFromMatrixPosition(X_WV);
    const meter_px =
        camera.projectionMatrix.elements[5] * height_px / 2 / Math.max(0.01, at.distanceTo(camera.position));
    const size_m = Math.max(1.25 * radius_m, 16 / meter_px);
    const yaw = Math.atan2(X_WV.elements[1], X_WV.elements[0]);
    this.lines.matrix.copy(new Matrix4().makeRotationZ(yaw).scale(new Vector3(size_m, size_m, size_m))).setPosition(at);
  }
}
