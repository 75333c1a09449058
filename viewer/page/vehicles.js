// SPDX-License-Identifier: BSD-3-Clause
// Vehicles of a scene: their colors and poses.
import {matrixOf, radiusOf} from './bodies.js';
import {Quaternion, Vector3} from './vendor/three.js';

/** Colors of vehicles that have none of their own (after Okabe and Ito 2008). */
const PALETTE = ['#56b4e9', '#009e73', '#d55e00', '#cc79a7', '#0072b2', '#8c6bb1', '#66a61e', '#a6761d'];

/** Color of a vehicle in lists and trails: that of its body, if it is bright and no other vehicle has it. */
function pickColor(body, bodies, taken) {
  const hsl = {};
  const own = body.parts.map((part) => bodies.colorOf(body, part)).find((color) => {
    color.getHSL(hsl);
    return hsl.s > 0.4 && hsl.l > 0.12 && hsl.l < 0.8 && (hsl.h < 0.08 || hsl.h > 0.18);  // yellow: estimates
  });
  const name = own ? `#${own.getHexString()}` : '';
  const color =
      own && !taken.has(name) ? name : PALETTE.find((one) => !taken.has(one)) ?? PALETTE[taken.size % PALETTE.length];
  taken.add(color);
  return color;
}

/** What the page knows of the vehicles of a scene. */
export function describeVehicles(data, bodies) {
  const taken = new Set();
  return data.vehicles.map((vehicle) => {
    const own = data.bodies[vehicle.body];
    return {
      ...vehicle,
      color: pickColor(own, bodies, taken),
      radius_m: Math.max(0.1, radiusOf(own)),
      X_BV: matrixOf(vehicle.pose),
      X_WV: matrixOf(vehicle.pose),
      at: new Vector3()
    };
  });
}

/** Moves vehicles to the poses of their bodies. */
export function moveVehicles(vehicles, bodies) {
  for (const vehicle of vehicles) {
    vehicle.X_WV.multiplyMatrices(bodies.X_WB[vehicle.body], vehicle.X_BV);
    vehicle.at.setFromMatrixPosition(vehicle.X_WV);
  }
}

/** Position of the frame of a vehicle at a time not long ago; null: unknown. */
export function truthAt(vehicle, time_us, bodies, playback) {
  const slot = bodies.movable.indexOf(vehicle.body);
  const pose = slot < 0 ? null : playback.poseAt(slot, time_us);
  if (!pose) return null;
  const offset = new Vector3().setFromMatrixPosition(vehicle.X_BV);
  return offset.applyQuaternion(new Quaternion(pose[3], pose[4], pose[5], pose[6]))
      .add(new Vector3(...pose.slice(0, 3)));
}
