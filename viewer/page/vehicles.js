// SPDX-License-Identifier: BSD-3-Clause
// Vehicles of a scene: their colors and poses.
import {matrixOf, radiusOf} from './bodies.js';
import {VEHICLE_COLORS} from './palette.js';
import {Quaternion, Vector3} from './vendor/three.js';

/** Color of a vehicle: the scene says it; in a log of before it did, by the place of the vehicle. */
function colorOf(vehicle, place) {
  return /^#[0-9a-f]{6}$/.test(vehicle.color) ? vehicle.color : VEHICLE_COLORS[place % VEHICLE_COLORS.length];
}

/** What the page knows of the vehicles of a scene. */
export function describeVehicles(data) {
  return data.vehicles.map((vehicle, place) => {
    const own = data.bodies[vehicle.body];
    return {
      ...vehicle,
      color: colorOf(vehicle, place),
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
