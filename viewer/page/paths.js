// SPDX-License-Identifier: BSD-3-Clause
// Paths along which vehicles mean to go, by messages of their programs: a line, and a dot at each point.
import {
  BufferAttribute,
  BufferGeometry,
  Color,
  Group,
  Line,
  LineBasicMaterial,
  Points,
  ShaderMaterial,
  Vector3,
} from './vendor/three.js';

const PATHS_MAX = 300;
const POINTS_MAX = 1000;
/** Height above a vehicle frame, which is on the ground on land. */
const HEIGHT_M = 0.05;

const VERTEX = /* glsl */ `
void main() {
  gl_Position = projectionMatrix * viewMatrix * vec4(position, 1.0);
  gl_PointSize = 6.0;
}`;
const FRAGMENT = /* glsl */ `
uniform vec3 color;
void main() {
  float off = 2.0 * length(gl_PointCoord - 0.5);
  if (off > 1.0) discard;
  // A dark rim, to be seen on any ground.
  gl_FragColor = vec4(mix(color, vec3(0.02, 0.05, 0.08), smoothstep(0.6, 0.8, off)), 1.0);
  #include <colorspace_fragment>
}`;

/** Points [x_m, y_m, depth_m or null] that can be drawn. */
function pointsOf({points}) {
  const fits = (point) => Array.isArray(point) && Number.isFinite(point[0]) && Number.isFinite(point[1]);
  return (Array.isArray(points) ? points : []).filter(fits).slice(0, POINTS_MAX);
}

/** The newest path of each channel, drawn. */
export class Layer {
  constructor(scene) {
    this.root = new Group();
    this.items = [];
    this.drawn = [];
    scene.add(this.root);
  }

  /** Takes the vehicles of a scene; the paths stay. */
  setScene(data, {vehicles}) {
    this.origin = new Vector3(...data.origin_m);
    this.vehicles = new Map(vehicles.map((vehicle) => [vehicle.name, vehicle]));
    this.set(this.items);
  }

  take({items}) { this.set(items); }

  /** Takes all paths, in place of those before. */
  set(items) {
    this.items = items.slice(0, PATHS_MAX);
    for (const {line, dots} of this.drawn)
      for (const object of [line, dots]) {
        object.geometry.dispose();
        object.material.dispose();
      }
    this.root.clear();
    this.drawn = this.origin ? this.items.map((item) => this.make(item)).filter(({points}) => points.length > 0) : [];
    for (const {line, dots} of this.drawn) this.root.add(line, dots);
  }

  make(item) {
    const points = pointsOf(item), vehicle = this.vehicles.get(item.vehicle);
    if (item.loop && points.length > 1) points.push(points[0]);
    const color = new Color(vehicle?.color ?? '#ffffff').lerp(new Color('#ffffff'), 0.5);
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(new Float32Array(3 * points.length), 3));
    const line = new Line(geometry, new LineBasicMaterial({color, transparent: true, opacity: 0.9}));
    const material =
        new ShaderMaterial({uniforms: {color: {value: color}}, vertexShader: VERTEX, fragmentShader: FRAGMENT});
    const dots = new Points(geometry, material);
    for (const object of [line, dots]) {
      object.frustumCulled = false;
      object.renderOrder = 14;
    }
    return {item, points, vehicle, line, dots, key: ''};
  }

  /** Forgets paths later than a time: the run went back. */
  rewind(time_us) {
    const kept = this.items.filter((item) => !(item.time_us > time_us));
    if (kept.length < this.items.length) this.set(kept);
  }

  /**
   * Draws them; those without a depth at the height of their vehicle.  level_m: of the still water, above the origin.
   */
  update({level_m}) {
    for (const one of this.drawn) {
      const low = one.vehicle ? one.vehicle.at.z + HEIGHT_M : HEIGHT_M - this.origin.z;
      const key = `${level_m.toFixed(3)} ${low.toFixed(3)}`;
      if (key === one.key) continue;
      one.key = key;
      const position = one.line.geometry.getAttribute('position');
      one.points.forEach(([x, y, depth_m], i) => {
        const z = Number.isFinite(depth_m) ? level_m - depth_m : low;
        position.setXYZ(i, x - this.origin.x, y - this.origin.y, z);
      });
      position.needsUpdate = true;
    }
  }

  /** What is drawn, for tests. */
  probe(world) {
    if (!this.root.visible) return [];
    return this.drawn.map(({item, line}) => {
      const position = line.geometry.getAttribute('position');
      const points =
          [...Array(position.count).keys()].map((i) => world(new Vector3().fromBufferAttribute(position, i)));
      return {channel: item.channel, vehicle: item.vehicle, points};
    });
  }
}
