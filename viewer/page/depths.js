// SPDX-License-Identifier: BSD-3-Clause
// Depths: from each vehicle a dashed line to the surface and one to the bottom, and a frame about the vehicles from the
// surface to the bottom with a scale of depth.
import {roundUp} from './shapes.js';
import {trailColor} from './trails.js';
import {
  BackSide,
  BufferAttribute,
  BufferGeometry,
  DynamicDrawUsage,
  Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  ShaderMaterial,
  Vector3,
} from './vendor/three.js';

const VEHICLES_MAX = 300;
/** With more vehicles the depth is written at the selected one only. */
const WRITTEN_MAX = 12;
const RING_STEPS = 12;
const RING_PX = 5;
/** Vehicles nearer to the surface have no line to it; radii of the vehicle. */
const SURFACE_RADII = 0.75;
/** Parts of a side of the frame, along which it follows the bottom. */
const SIDE_STEPS = 12;
const FRAME_COLOR = '#e9f6f8';

const VERTEX = /* glsl */ `
attribute vec3 tint;
varying vec4 vTint;
varying float vUp;
void main() {
  vTint = vec4(tint, 1.0);
  vUp = position.z;
  gl_Position = projectionMatrix * viewMatrix * vec4(position, 1.0);
}`;
const FRAGMENT = /* glsl */ `
varying vec4 vTint;
varying float vUp;
uniform float level, dash_m;
void main() {
  // Dashes and gaps are equally long, and counted from the surface.
  if (mod(level - vUp, 2.0 * dash_m) > dash_m) discard;
  gl_FragColor = vTint;
  #include <colorspace_fragment>
}`;

const WALL_VERTEX = /* glsl */ `
varying float vDepth;
uniform float level;
void main() {
  vDepth = level - position.z;
  gl_Position = projectionMatrix * viewMatrix * vec4(position, 1.0);
}`;
const WALL_FRAGMENT = /* glsl */ `
varying float vDepth;
uniform float height_m;
void main() {
  // From the light at the surface to the dark of the bottom.
  float share = clamp(vDepth / height_m, 0.0, 1.0);
  gl_FragColor = vec4(mix(vec3(0.22, 0.58, 0.66), vec3(0.01, 0.06, 0.13), share), mix(0.30, 0.60, share));
  #include <colorspace_fragment>
}`;

/** Line segments in a buffer that is filled again in each frame. */
class Segments {
  constructor(material, vertices) {
    this.at = 0;
    this.position = new BufferAttribute(new Float32Array(3 * vertices), 3).setUsage(DynamicDrawUsage);
    this.tint = new BufferAttribute(new Float32Array(3 * vertices), 3).setUsage(DynamicDrawUsage);
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', this.position);
    geometry.setAttribute('tint', this.tint);
    this.lines = new LineSegments(geometry, material);
    this.lines.frustumCulled = false;
    this.lines.renderOrder = 12;
  }

  add(ax, ay, az, bx, by, bz, color) {
    if (this.at + 2 > this.position.count) return;
    this.position.setXYZ(this.at, ax, ay, az);
    this.position.setXYZ(this.at + 1, bx, by, bz);
    this.tint.setXYZ(this.at, color.r, color.g, color.b);
    this.tint.setXYZ(this.at + 1, color.r, color.g, color.b);
    this.at += 2;
  }

  /** A level circle. */
  ring({x, y}, z, radius_m, color) {
    for (let i = 0; i < RING_STEPS; ++i) {
      const a = 2 * Math.PI * i / RING_STEPS, b = 2 * Math.PI * (i + 1) / RING_STEPS;
      this.add(
          x + radius_m * Math.cos(a), y + radius_m * Math.sin(a), z, x + radius_m * Math.cos(b),
          y + radius_m * Math.sin(b), z, color);
    }
  }

  end() {
    this.lines.geometry.setDrawRange(0, this.at);
    this.position.needsUpdate = this.tint.needsUpdate = true;
  }
}

/** Lines of depth and the frame. */
export class Depths {
  constructor(scene) {
    this.root = new Group();
    this.dashed = new ShaderMaterial({
      uniforms: {level: {value: 0}, dash_m: {value: 1}},
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      transparent: true,
      depthWrite: false,
    });
    this.drops = new Segments(this.dashed, VEHICLES_MAX * (4 + 4 * RING_STEPS));
    const solid = new LineBasicMaterial({color: FRAME_COLOR, transparent: true, opacity: 0.75, depthWrite: false});
    this.frame = new Segments(solid, 2000);
    this.makeWalls();
    this.root.add(this.walls, this.drops.lines, this.frame.lines);
    this.shown = true;
    this.items = [];
    this.scale = [];
    scene.add(this.root);
  }

  /** The sides of the frame that are behind the vehicles, as the camera sees them. */
  makeWalls() {
    const material = new ShaderMaterial({
      uniforms: {level: this.dashed.uniforms.level, height_m: {value: 1}},
      vertexShader: WALL_VERTEX,
      fragmentShader: WALL_FRAGMENT,
      side: BackSide,
      transparent: true,
      depthWrite: false,
    });
    const geometry = new BufferGeometry();
    const corners = new Float32Array(3 * 6 * 4 * SIDE_STEPS);
    geometry.setAttribute('position', new BufferAttribute(corners, 3).setUsage(DynamicDrawUsage));
    this.walls = new Mesh(geometry, material);
    this.walls.frustumCulled = false;
    this.walls.renderOrder = 9;
  }

  choose(get) { this.shown = get('depths'); }

  setScene(data, {vehicles}) {
    this.hasWater = data.water !== null && data.water !== undefined;
    this.colors = vehicles.map(({color}) => trailColor(color));
    this.items = [];
  }

  /** Places the lines. */
  update(view) {
    this.items = [];
    this.scale = [];
    this.root.visible = this.shown && this.hasWater && view.placed && !view.onBoard;
    if (!this.root.visible) return;
    this.step_m = roundUp(Math.max(0.1, view.distance_m / 50));
    this.dashed.uniforms.level.value = view.level_m;
    this.dashed.uniforms.dash_m.value = this.step_m;
    this.drops.at = this.frame.at = 0;
    view.vehicles.slice(0, VEHICLES_MAX).forEach((vehicle, i) => this.addDrop(vehicle, this.colors[i], view));
    this.addFrame(view);
    this.drops.end();
    this.frame.end();
  }

  addDrop({name, at, radius_m}, color, {vehicles, camera, height_px, level_m, groundAt}) {
    if (!Number.isFinite(at.x)) return;
    const bottom = groundAt(at.x, at.y), depth_m = level_m - at.z;
    if (bottom > level_m) return;  // on land
    const meter_px =
        camera.projectionMatrix.elements[5] * height_px / 2 / Math.max(0.1, at.distanceTo(camera.position));
    // The circles of many vehicles take long to draw, and hide them.
    const ring_m = vehicles.length > WRITTEN_MAX ? 0 : RING_PX / meter_px,
          deep = depth_m > Math.max(0.2, SURFACE_RADII * radius_m);
    if (deep) {
      this.drops.add(at.x, at.y, at.z, at.x, at.y, level_m, color);
      if (ring_m > 0) this.drops.ring(at, level_m, ring_m, color);
    }
    const altitude_m = Number.isFinite(bottom) ? at.z - bottom : null;
    if (altitude_m !== null && altitude_m > 0) {
      this.drops.add(at.x, at.y, at.z, at.x, at.y, bottom, color);
      if (ring_m > 0) this.drops.ring(at, bottom, ring_m, color);
    }
    this.items.push({name, at, depth_m: deep ? depth_m : 0, altitude_m});
  }

  /** The area that the frame encloses; it moves in steps. */
  areaOf(vehicles, camera_m) {
    const xs = [], ys = [];
    for (const {at} of vehicles)
      if (Number.isFinite(at.x)) xs.push(at.x), ys.push(at.y);
    if (xs.length === 0) return null;
    const [x0, x1] = [Math.min(...xs), Math.max(...xs)], [y0, y1] = [Math.min(...ys), Math.max(...ys)];
    const margin_m = Math.max(0.18 * Math.hypot(x1 - x0, y1 - y0), 0.18 * camera_m, 5 * vehicles[0].radius_m);
    const step_m = roundUp(margin_m / 2);
    const low = (x) => Math.floor((x - margin_m) / step_m) * step_m, high = (x) => -low(-x);
    return [low(x0), low(y0), high(x1), high(y1)];
  }

  addFrame({vehicles, distance_m, level_m, groundAt, camera}) {
    const area = this.areaOf(vehicles, distance_m);
    if (!area) return;
    const [x0, y0, x1, y1] = area, {frame} = this;
    const corners = [[x0, y0], [x1, y0], [x1, y1], [x0, y1]], color = {r: 1, g: 1, b: 1};
    const bottomAt = (x, y) => Math.min(level_m, groundAt(x, y));
    // Without a bottom the frame ends below the deepest vehicle.
    const deepest_m = Math.max(0, ...this.items.map((item) => item.depth_m));
    const floor = deepest_m > 0 ? level_m - this.step_m * Math.ceil(1.2 * deepest_m / this.step_m) : level_m;
    const lowAt = (x, y) => {
      const z = bottomAt(x, y);
      return Number.isFinite(z) ? z + 0.001 * distance_m : floor;
    };
    const wall = this.walls.geometry.getAttribute('position');
    let at = 0, lowest = floor;
    corners.forEach(([ax, ay], i) => {
      const [bx, by] = corners[(i + 1) % 4];
      frame.add(ax, ay, level_m, bx, by, level_m, color);
      const place = (k) => [ax + (bx - ax) * k / SIDE_STEPS, ay + (by - ay) * k / SIDE_STEPS];
      for (let k = 0; k < SIDE_STEPS; ++k) {
        const [px, py] = place(k), [qx, qy] = place(k + 1);
        const p = lowAt(px, py), q = lowAt(qx, qy);
        frame.add(px, py, p, qx, qy, q, color);
        lowest = Math.min(lowest, p);
        for (const [x, y, z] of [
                 [px, py, p], [qx, qy, q], [qx, qy, level_m], [px, py, p], [qx, qy, level_m], [px, py, level_m]])
          wall.setXYZ(at++, x, y, z);
      }
      frame.add(ax, ay, level_m, ax, ay, lowAt(ax, ay), color);
    });
    wall.needsUpdate = true;
    this.walls.material.uniforms.height_m.value = Math.max(1e-3, level_m - lowest);
    this.addScale(corners, {level_m, lowAt, camera});
  }

  /** Ticks at the upright edge that is farthest to the left as the camera sees it. */
  addScale(corners, {level_m, lowAt, camera}) {
    const right = new Vector3().setFromMatrixColumn(camera.matrixWorld, 0);
    const [x, y] =
        corners.reduce((a, b) => (a[0] * right.x + a[1] * right.y <= b[0] * right.x + b[1] * right.y ? a : b));
    const height_m = level_m - lowAt(x, y);
    if (!(height_m > 0)) return;
    const tick_m = roundUp(height_m / 5), half_m = 0.02 * height_m;
    for (let depth_m = 0; depth_m <= height_m + 1e-6; depth_m += tick_m) {
      const z = level_m - depth_m;
      this.frame.add(
          x - half_m * right.x, y - half_m * right.y, z, x + half_m * right.x, y + half_m * right.y, z,
          {r: 1, g: 1, b: 1});
      this.scale.push({at: new Vector3(x, y, z), text: `${+ depth_m.toFixed(2)} m`});
    }
  }

  /** Writes depth and altitude at the middle of the lines, and the numbers of the scale. */
  annotate(labels, selected) {
    const few = this.items.length <= WRITTEN_MAX, middle = new Vector3();
    const level_m = this.dashed.uniforms.level.value;
    for (const {name, at, depth_m, altitude_m} of this.items) {
      if (!few && name !== selected) continue;
      if (depth_m > 0) {
        middle.set(at.x, at.y, at.z + 0.5 * (level_m - at.z));
        labels.text(middle, `depth ${depth_m.toFixed(1)} m`, {dx: 6, dy: [0, -18, 18]});
      }
      if (altitude_m > 0 && (depth_m > 0 || name === selected)) {
        middle.set(at.x, at.y, at.z - 0.5 * altitude_m);
        labels.text(middle, `altitude ${altitude_m.toFixed(1)} m`, {dx: 6, dy: [0, 18, -18]});
      }
    }
    for (const {at, text} of this.scale) labels.text(at, text, {dx: -46});
  }

  /** Numbers for tests. */
  probe(world) {
    if (!this.root.visible) return {vehicles: [], scale: [], vertices: 0};
    return {
      vehicles: this.items.map(({name, at, depth_m, altitude_m}) => ({name, position: world(at), depth_m, altitude_m})),
      scale: this.scale.map(({at, text}) => ({position: world(at), text})),
      vertices: this.drops.at + this.frame.at,
    };
  }
}
