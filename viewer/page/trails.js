// SPDX-License-Identifier: BSD-3-Clause
// Trails of all vehicles in one set of line segments: a ring of samples, each with one segment for each vehicle, so
// that a new sample is one range of memory.
import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DynamicDrawUsage,
  LineSegments,
  ShaderMaterial,
  Vector3
} from './vendor/three.js';

const SEGMENTS_MAX = 150000;
const SAMPLES_MAX = 1500;
const TRAILS_MAX_S = 3600;

const VERTEX = /* glsl */ `
attribute float stamp;
attribute vec3 tint;
uniform float now, length_s;
varying vec4 vColor;
void main() {
  float age = (now - stamp) / max(length_s, 1e-6);
  vColor = vec4(tint, age < 0.0 || age > 1.0 ? 0.0 : 0.25 + 0.75 * (1.0 - age));
  gl_Position = projectionMatrix * viewMatrix * vec4(position, 1.0);
}`;
const FRAGMENT = /* glsl */ `
varying vec4 vColor;
void main() {
  if (vColor.a <= 0.01) discard;
  gl_FragColor = vColor;
  #include <colorspace_fragment>
}`;

/** Trails of a fixed number of moving points; colorOf(vehicle): color of one, option: the switch that they have. */
export class Trails {
  constructor(scene, colorOf, option = null) {
    Object.assign(this, {colorOf, option});
    this.material = new ShaderMaterial({
      uniforms: {now: {value: 0}, length_s: {value: 60}},
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      transparent: true,
      depthWrite: false,
    });
    this.lines = new LineSegments(new BufferGeometry(), this.material);
    this.lines.frustumCulled = false;
    this.lines.renderOrder = 15;
    scene.add(this.lines);
    this.length_s = 60;
    this.reset([]);
  }

  setScene(data, {vehicles}) { this.reset(vehicles.map(this.colorOf)); }

  rewind() { this.clear(); }

  choose(get) {
    this.length_s = Math.min(TRAILS_MAX_S, Math.max(0, Number(get('trails')) || 0));
    this.shown = this.option === null || get(this.option);
  }

  /** Starts empty trails, one for each color. */
  reset(colors) {
    this.count = colors.length;
    this.samples = Math.max(2, Math.min(SAMPLES_MAX, Math.floor(SEGMENTS_MAX / Math.max(1, this.count))));
    const vertices = 2 * this.count * this.samples;
    this.lines.geometry.dispose();
    const geometry = this.lines.geometry = new BufferGeometry();
    this.position = new BufferAttribute(new Float32Array(3 * vertices), 3).setUsage(DynamicDrawUsage);
    this.stamp = new BufferAttribute(new Float32Array(vertices).fill(-1e9), 1).setUsage(DynamicDrawUsage);
    const tint = new Float32Array(3 * vertices);
    for (let i = 0; i < vertices; ++i) colors[(i >> 1) % this.count].toArray(tint, 3 * i);
    geometry.setAttribute('position', this.position);
    geometry.setAttribute('stamp', this.stamp);
    geometry.setAttribute('tint', new BufferAttribute(tint, 3));
    this.clear();
  }

  /** Forgets the past. */
  clear() {
    this.last = new Array(this.count).fill(null);
    this.last_us = null;
    this.next = 0;
    this.stamp.array.fill(-1e9);
    this.stamp.addUpdateRange(0, this.stamp.array.length);
    this.stamp.needsUpdate = true;
    this.filled = 0;
    this.empty = true;
    this.lines.geometry.setDrawRange(0, 0);
  }

  /** Adds a sample if it is due; positions: Vector3 or null for each trail. */
  sample(time_us, positions) {
    const period_us = 1e6 * Math.max(0.1, this.length_s / (this.samples - 1));
    if (this.last_us !== null && time_us < this.last_us) this.clear();
    if (this.count === 0 || (this.last_us !== null && time_us - this.last_us < period_us)) return;
    // One segment for each trail, from its sample before; without one it has no length.
    const first = 2 * this.next * this.count;
    for (let i = 0, at = first; i < this.count; ++i, at += 2) {
      const to = positions[i], from = this.last[i] ?? to;
      const stamp = to && this.last[i] ? time_us * 1e-6 : -1e9;
      if (to) {
        this.position.setXYZ(at, from.x, from.y, from.z);
        this.position.setXYZ(at + 1, to.x, to.y, to.z);
      }
      this.stamp.array[at] = this.stamp.array[at + 1] = stamp;
      this.last[i] = to ? (this.last[i] ?? new Vector3()).copy(to) : null;
    }
    for (const attribute of [this.position, this.stamp]) {
      attribute.addUpdateRange(first * attribute.itemSize, 2 * this.count * attribute.itemSize);
      attribute.needsUpdate = true;
    }
    this.next = (this.next + 1) % this.samples;
    this.filled = Math.min(this.samples, this.filled + 1);
    this.last_us = time_us;
    // Points that have never been anywhere, such as estimates of a run without them, are not drawn.
    if (this.empty) this.empty = !positions.some((to) => to);
    this.lines.geometry.setDrawRange(0, this.empty ? 0 : 2 * this.count * this.filled);
  }

  /** Draws the trails of the last length_s before a time. */
  update({time_us}) {
    this.material.uniforms.now.value = time_us * 1e-6;
    this.material.uniforms.length_s.value = this.length_s;
    this.lines.visible = this.shown && this.length_s > 0 && !this.empty;
  }

  /** Number of samples and last position of a trail, for tests. */
  describe(i) {
    let points = 0;
    const oldest_s = this.material.uniforms.now.value - this.length_s;
    for (let s = 0; s < this.samples; ++s)
      if (this.stamp.array[2 * (s * this.count + i)] >= oldest_s) ++points;
    return {points, last: this.last[i]?.toArray() ?? null};
  }
}

/** Returns a color for the trail of a vehicle. */
export function trailColor(color) { return new Color(color).lerp(new Color('#ffffff'), 0.15); }
