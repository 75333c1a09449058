// SPDX-License-Identifier: BSD-3-Clause
// What people know a vehicle by, drawn from its devices and its hull: fins, propellers, the nose of a torpedo with a
// band in the color of the vehicle, lamps.  The scene has no sizes of devices: they are drawn in proportion to the
// hull.
import {matrixOf} from './bodies.js';
import {simpleShape} from './shapes.js';
import {Color, DynamicDrawUsage, Group, InstancedMesh, Matrix4, Vector3} from './vendor/three.js';

const FITTINGS_MAX = 4000;
const DARK = '#2a323a', PALE = '#c9ced2', LAMP = '#fff3b0';
const BLADES = 3;
/** A propeller advances this many of its diameters in a turn. */
const PITCH = 0.9;

/** Half of the smallest size of the largest part of a body, and whether it is a torpedo along x; null: it has none. */
export function hullOf(body) {
  let hull = null;
  for (const part of body.parts) {
    const r = part.radius_m;
    const size = {box: part.size_m, sphere: [2 * r, 2 * r, 2 * r]}[part.shape] ??
        (['capsule', 'cylinder'].includes(part.shape) ? [2 * r, 2 * r, part.length_m + 2 * r] : null);
    if (!size) continue;
    const volume = size[0] * size[1] * size[2];
    if (hull && volume <= hull.volume) continue;
    const along = new Vector3(0, 0, 1).transformDirection(matrixOf(part.pose));
    const torpedo = part.shape === 'capsule' && Math.abs(along.x) > 0.99 && part.length_m > 4 * r;
    hull = {part, volume, radius_m: Math.min(...size) / 2, torpedo};
  }
  return hull;
}

/** Matrix of a fitting at a place of a frame, turned about x by an angle. */
const placed = (X, x, y, z, turn = 0) =>
    X.clone().multiply(new Matrix4().makeTranslation(x, y, z)).multiply(new Matrix4().makeRotationX(turn));

/** Fittings of a device, in the frame of its body: {part, X_BP, screw}; screw: it turns with the way of the vehicle. */
function ofDevice(device, hull) {
  const X = matrixOf(device.pose), r = hull.radius_m;
  const box = (x, y, z, color) => ({shape: 'box', size_m: [x, y, z], color});
  const rod = (radius_m, length_m, color) => ({shape: 'cylinder', radius_m, length_m, color});
  if (device.type === 'fin') {
    // Ahead of a propeller, on both sides of the hull; z is the hinge.
    const central = Math.hypot(device.pose[1], device.pose[2]) < 0.5 * r;
    const span_m = central ? 4.2 * r : 1.6 * r, chord_m = 1.1 * r;
    return [{part: box(chord_m, 0.12 * r, span_m, DARK), X_BP: placed(X, 0.9 * chord_m, 0, 0)}];
  }
  if (device.type === 'thruster') {
    const d = (hull.torpedo ? 1.5 : 0.9) * r;
    const along = new Matrix4().makeRotationY(Math.PI / 2);
    const fittings = [{part: rod(0.14 * d, 0.6 * d, DARK), X_BP: placed(X, 0.1 * d, 0, 0).multiply(along)}];
    for (let i = 0; i < BLADES; ++i) {
      const blade = placed(X, -0.1 * d, 0, 0, 2 * Math.PI * i / BLADES);
      // Twisted against the plane of the propeller.
      const twist = new Matrix4().makeTranslation(0, 0, 0.3 * d).multiply(new Matrix4().makeRotationZ(0.6));
      fittings.push({part: box(0.05 * d, 0.24 * d, 0.42 * d, PALE), X_BP: blade, screw: {diameter_m: d, twist}});
    }
    return fittings;
  }
  if (device.type === 'led') return [{part: {shape: 'sphere', radius_m: 0.12 * r, color: LAMP}, X_BP: X}];
  return [];
}

/** Fittings of a vehicle: of its devices, and of a hull that is a torpedo. */
export function fittingsOf(vehicle, bodies) {
  const all = [];
  const add = (body, items) => all.push(...items.map((item) => ({...item, body})));
  for (const device of vehicle.devices) {
    const hull = hullOf(bodies[device.body]);
    if (hull) add(device.body, ofDevice(device, hull));
  }
  const hull = hullOf(bodies[vehicle.body]);
  if (hull?.torpedo) {
    const X = matrixOf(hull.part.pose), r = hull.radius_m, half_m = hull.part.length_m / 2;
    // The end of the capsule that is ahead.
    const ahead = new Vector3(0, 0, 1).transformDirection(X).x > 0 ? 1 : -1;
    add(vehicle.body, [
      {part: {shape: 'sphere', radius_m: 1.05 * r, color: DARK}, X_BP: placed(X, 0, 0, ahead * half_m)},
      {
        part: {shape: 'cylinder', radius_m: 1.02 * r, length_m: 1.2 * r, color: vehicle.color},
        X_BP: placed(X, 0, 0, ahead * (half_m - 1.6 * r))
      },
    ]);
  }
  return all;
}

/** Fittings of all vehicles. */
export class Fittings {
  constructor(scene, bodies) {
    this.bodies = bodies;
    this.root = new Group();
    this.groups = [];
    scene.add(this.root);
  }

  setScene(data, {vehicles}) {
    for (const {mesh} of this.groups) mesh.dispose();
    this.root.clear();
    this.groups = [];
    this.ways = vehicles.map(() => ({at: null, way_m: 0}));
    const items =
        vehicles.flatMap((vehicle, number) => fittingsOf(vehicle, data.bodies).map((item) => ({...item, number})));
    // One mesh for each shape.
    const groups = new Map();
    for (const item of items.slice(0, FITTINGS_MAX)) {
      const {key, geometry, scale} = simpleShape(item.part, vehicles.length > 50);
      if (!groups.has(key)) groups.set(key, {geometry, items: []});
      groups.get(key).items.push({...item, scale: new Matrix4().makeScale(...scale)});
    }
    for (const group of groups.values()) {
      const material = this.bodies.surfaces.get({shape: 'fitting', color: DARK, material: {}});
      group.mesh = new InstancedMesh(group.geometry, material, group.items.length);
      group.mesh.instanceMatrix.setUsage(DynamicDrawUsage);
      group.items.forEach(({part}, i) => group.mesh.setColorAt(i, new Color(part.color)));
      group.mesh.frustumCulled = false;
      group.mesh.castShadow = group.mesh.receiveShadow = true;
      this.root.add(group.mesh);
      this.groups.push(group);
    }
  }

  /** Moves them with their bodies. */
  update({vehicles, X_WB}) {
    this.root.visible = this.bodies.shapes === 'drawn' && this.groups.length > 0;
    if (!this.root.visible) return;
    vehicles.forEach(({at, X_WV}, i) => {
      // The way along the axis of the vehicle, since it was seen first.
      const one = this.ways[i];
      if (one.at) one.way_m += at.clone().sub(one.at).dot(new Vector3().setFromMatrixColumn(X_WV, 0));
      one.at = (one.at ?? new Vector3()).copy(at);
    });
    const matrix = new Matrix4(), turn = new Matrix4();
    for (const {mesh, items} of this.groups) {
      items.forEach(({body, X_BP, screw, scale, number}, i) => {
        matrix.multiplyMatrices(X_WB[body], X_BP);
        if (screw) {
          const turns = this.ways[number].way_m / (PITCH * screw.diameter_m);
          matrix.multiply(turn.makeRotationX(2 * Math.PI * (turns % 1))).multiply(screw.twist);
        }
        mesh.setMatrixAt(i, matrix.multiply(scale));
      });
      mesh.instanceMatrix.needsUpdate = true;
    }
  }

  /** Numbers for tests: shape, color and position of each. */
  probe(world) {
    if (!this.root.visible) return [];
    const matrix = new Matrix4();
    return this.groups.flatMap(({mesh, items}) => items.map(({part, number, screw}, i) => {
      mesh.getMatrixAt(i, matrix);
      const position = world(new Vector3().setFromMatrixPosition(matrix));
      return {vehicle: number, shape: part.shape, color: part.color, position, turns: Boolean(screw)};
    }));
  }
}
