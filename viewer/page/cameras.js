// SPDX-License-Identifier: BSD-3-Clause
// Cameras: orbit, top, follow (position), chase (pose), first person, fly, and through a camera of a vehicle.
import {matrixOf} from './bodies.js';
import {Matrix4, OrbitControls, PerspectiveCamera, Quaternion, Vector3} from './vendor/three.js';

/** Modes of the camera and what they are for. */
export const MODES = {
  orbit: 'Orbit: drag to turn, right button or two fingers to move, wheel to zoom',
  top: 'Seen from above, north up; the selected vehicle stays in view',
  follow: 'Follow the position of the selected vehicle; you may still turn and zoom',
  chase: 'Follow position and heading of the selected vehicle',
  first: 'From the selected vehicle, along its x axis; drag to look around',
  fly: 'Fly: W A S D, Q and E for down and up, drag to look around, Shift is faster',
  device: 'Through a camera of the selected vehicle',
};
const FOV_DEG = 50;
const GROUND_CLEARANCE_M = 0.05;
const NEEDS_VEHICLE = new Set(['follow', 'chase', 'first', 'device']);
/** Direction from what is fitted to the camera, and the share of the view that it fills, as in `shoal snap`. */
const FIT_BACK = new Vector3(-0.5, -0.75, 0.617).normalize();
const FIT_SHARE = 0.93;
/** Share of the view from above, from its middle to its nearest edge, that panels leave free. */
const FREE_SHARE = 0.75;

/** Rotation of a camera (looks along -z, y up) that looks along x with z up. */
const LOOK_ALONG_X = new Quaternion().setFromRotationMatrix(
    new Matrix4().makeBasis(new Vector3(0, -1, 0), new Vector3(0, 0, 1), new Vector3(-1, 0, 0)));

/** The camera of the page and what moves it. */
export class Cameras {
  /** groundAt(x, y): height of the ground, -Infinity where there is none. */
  constructor(element, groundAt) {
    this.element = element;
    this.groundAt = groundAt;
    this.camera = new PerspectiveCamera(FOV_DEG, 1, 0.05, 10000);
    this.camera.up.set(0, 0, 1);
    this.camera.position.set(8, -8, 6);
    this.controls = new OrbitControls(this.camera, element);
    this.controls.enableDamping = !matchMedia('(prefers-reduced-motion: reduce)').matches;
    this.controls.dampingFactor = 0.15;
    this.controls.screenSpacePanning = true;
    this.controls.zoomToCursor = false;
    this.mode = 'orbit';
    this.look = {yaw: 0, pitch: 0};
    this.keys = new Set();
    this.device = null;
    this.last = null;
    this.listen();
  }

  listen() {
    // Look around with the pointer where the orbit is off.
    let from = null;
    this.element.addEventListener('pointerdown', (event) => {
      from = [event.clientX, event.clientY];
    });
    addEventListener('pointerup', () => {
      from = null;
    });
    addEventListener('pointermove', (event) => {
      if (!from || !['first', 'fly'].includes(this.mode)) return;
      this.look.yaw -= (event.clientX - from[0]) * 0.004;
      this.look.pitch = Math.max(-1.5, Math.min(1.5, this.look.pitch - (event.clientY - from[1]) * 0.004));
      from = [event.clientX, event.clientY];
    });
    // Keys held down, for flying.
    addEventListener('keydown', (event) => {
      if (!/^(INPUT|SELECT|TEXTAREA)$/.test(event.target.tagName)) this.keys.add(event.code);
    });
    addEventListener('keyup', (event) => this.keys.delete(event.code));
    addEventListener('blur', () => this.keys.clear());
  }

  /** Changes the mode; vehicle: {name, X_WV, radius_m} or null. */
  setMode(mode, vehicle) {
    if (NEEDS_VEHICLE.has(mode) && !vehicle) return false;
    const before = this.mode;
    this.mode = mode;
    this.camera.fov = FOV_DEG;
    this.controls.enabled = !['first', 'fly', 'device'].includes(mode);
    this.controls.enableRotate = mode !== 'top';
    this.last = null;
    if (mode === 'top') {
      // The place that an orbit turns about is of no use after a camera without one.
      if (vehicle && ['first', 'fly', 'device'].includes(before)) this.approach(vehicle, mode, before);
      const distance_m = this.camera.position.distanceTo(this.controls.target);
      this.camera.position.copy(this.controls.target).add(new Vector3(0, -1e-4 * distance_m, distance_m));
    }
    if (mode === 'follow' || mode === 'chase') this.approach(vehicle, mode, before);
    if (mode === 'first') this.look = {yaw: 0, pitch: 0};
    if (mode === 'fly') {
      const direction = this.camera.getWorldDirection(new Vector3());
      this.look = {yaw: Math.atan2(direction.y, direction.x), pitch: Math.asin(direction.z)};
    }
    // Back to an orbit: turn about a point ahead.
    if (['first', 'fly', 'device'].includes(before) && this.controls.enabled && !vehicle) {
      const direction = this.camera.getWorldDirection(new Vector3());
      this.controls.target.copy(this.camera.position).addScaledVector(direction, 10);
    }
    return true;
  }

  /** Brings the target to a vehicle; the user's own view of it stays, unless it is too far away to see it. */
  approach(vehicle, mode, before) {
    const at = new Vector3().setFromMatrixPosition(vehicle.X_WV);
    const offset = this.camera.position.clone().sub(this.controls.target);
    const near_m = 10 * vehicle.radius_m;
    if (['first', 'fly', 'device', 'top'].includes(before)) offset.set(-1, -0.6, 0.7).setLength(near_m);
    if (offset.length() > 8 * near_m || offset.length() < vehicle.radius_m) offset.setLength(near_m);
    if (mode === 'chase') {
      const yaw = headingOf(vehicle.X_WV), distance_m = Math.min(offset.length(), near_m);
      offset.set(-Math.cos(yaw), -Math.sin(yaw), 0.42).setLength(distance_m);
    }
    this.controls.target.copy(at);
    this.camera.position.copy(at).add(offset);
    // The vehicle may move before the next update: the offset belongs to this place and heading.
    this.last = {name: vehicle.name, at, yaw: headingOf(vehicle.X_WV)};
  }

  /**
   * Shows a box as a whole: from the least distance at which all its corners are in view, by the rule of
   * camera_pose_for() in viewer/images/overview.cpp.  `free`: shares of width and height of the view, about
   * its middle, that no panel covers; `share`: how far it goes there, 1: at once.
   */
  fit(box, free, share = 1) {
    if (!this.controls.enabled) this.setMode('orbit', null);
    const back = this.mode === 'top' ? new Vector3(0, -1e-4, 1).normalize() : FIT_BACK;
    const right = new Vector3().crossVectors(this.camera.up, back).normalize();
    const up = new Vector3().crossVectors(back, right);
    const half = FIT_SHARE * Math.tan(FOV_DEG * Math.PI / 360);
    const wide = half * this.camera.aspect * free.wide, high = half * free.high;
    const center = box.getCenter(new Vector3());
    let distance_m = 0.5;
    for (const x of [box.min.x, box.max.x])
      for (const y of [box.min.y, box.max.y])
        for (const z of [box.min.z, box.max.z]) {
          const corner = new Vector3(x, y, z).sub(center), nearer_m = corner.dot(back);
          const aside_m = Math.abs(corner.dot(right)), above_m = Math.abs(corner.dot(up));
          distance_m = Math.max(distance_m, aside_m / wide + nearer_m, above_m / high + nearer_m);
        }
    this.controls.target.lerp(center, share);
    this.camera.position.lerp(center.addScaledVector(back, distance_m), share);
    this.last = null;
  }

  /** Keeps the camera above the ground: no orbit goes below it. */
  stayAboveGround() {
    const {position} = this.camera, {target} = this.controls, distance_m = position.distanceTo(target);
    const min_m = this.groundAt(position.x, position.y) + GROUND_CLEARANCE_M + 0.02 * distance_m - target.z;
    this.controls.maxPolarAngle = Math.acos(Math.max(-1, Math.min(1, min_m / distance_m)));
  }

  /** Moves the camera with the selected vehicle; X_WB: matrices of all bodies. */
  update(dt_s, vehicle, X_WB) {
    if (NEEDS_VEHICLE.has(this.mode) && !vehicle) this.setMode('orbit', null);
    if (this.mode === 'follow' || this.mode === 'chase') this.followVehicle(vehicle);
    if (this.mode === 'top') this.keepInView(vehicle);
    if (this.mode === 'first') this.sitOn(vehicle.X_WV, vehicle.radius_m);
    if (this.mode === 'fly') this.fly(dt_s);
    if (this.mode === 'device') this.lookThrough(X_WB);
    if (this.controls.enabled) {
      if (this.mode === 'orbit' || this.mode === 'top') this.moveByKeys(dt_s);
      this.stayAboveGround();
      this.controls.update(dt_s);
    }
    // Keep the depth precise at any distance.
    const distance_m = this.controls.enabled ? this.camera.position.distanceTo(this.controls.target) : 5;
    this.camera.near = Math.min(20, Math.max(0.02, 0.01 * distance_m));
    this.camera.far = Math.max(20000, 60 * distance_m);
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld();
  }

  followVehicle(vehicle) {
    const at = new Vector3().setFromMatrixPosition(vehicle.X_WV), yaw = headingOf(vehicle.X_WV);
    if (this.last) {
      const offset = this.camera.position.clone().sub(this.controls.target);
      if (this.mode === 'chase') offset.applyAxisAngle(this.camera.up, yaw - this.last.yaw);
      this.controls.target.copy(at);
      this.camera.position.copy(at).add(offset);
    }
    this.last = {yaw};
    this.controls.target.copy(at);
  }

  /**
   * Moves the view from above along with a vehicle, from where the user put it; one that is outside comes to its
   * middle.
   */
  keepInView(vehicle) {
    if (vehicle) {
      const at = new Vector3().setFromMatrixPosition(vehicle.X_WV), {target} = this.controls;
      const height_m = this.camera.position.distanceTo(target);
      const half_m = FREE_SHARE * height_m * Math.tan(FOV_DEG * Math.PI / 360) * Math.min(1, this.camera.aspect);
      const known = this.last?.name === vehicle.name;
      const outside = Math.hypot(at.x - target.x, at.y - target.y) > half_m;
      const step = at.clone().sub(known ? this.last.at : target);
      if (known || outside) {
        target.add(step);
        this.camera.position.add(step);
      }
      this.last = {name: vehicle.name, at};
    } else {
      this.last = null;
    }
  }

  sitOn(X_WV, radius_m) {
    const head = new Vector3(0.3 * radius_m, 0, 0.6 * radius_m + 0.05).applyMatrix4(X_WV);
    const turn = new Quaternion().setFromAxisAngle(new Vector3(0, 0, 1), this.look.yaw);
    turn.multiply(new Quaternion().setFromAxisAngle(new Vector3(0, 1, 0), -this.look.pitch));
    this.camera.position.copy(head);
    this.camera.quaternion.setFromRotationMatrix(X_WV).multiply(turn).multiply(LOOK_ALONG_X);
  }

  lookThrough(X_WB) {
    if (!this.device) return;
    const X_WS = X_WB[this.device.body].clone().multiply(matrixOf(this.device.pose));
    this.camera.position.setFromMatrixPosition(X_WS);
    this.camera.quaternion.setFromRotationMatrix(X_WS).multiply(LOOK_ALONG_X);
    const view = this.device.field_of_view ?? {};
    const vertical = view.vertical_rad ?? 2 * Math.atan(Math.tan((view.horizontal_rad ?? 1) / 2) / this.camera.aspect);
    this.camera.fov = Math.min(150, vertical * 180 / Math.PI);
  }

  fly(dt_s) {
    const turn = new Quaternion().setFromAxisAngle(new Vector3(0, 0, 1), this.look.yaw);
    turn.multiply(new Quaternion().setFromAxisAngle(new Vector3(0, 1, 0), -this.look.pitch));
    this.camera.quaternion.copy(turn).multiply(LOOK_ALONG_X);
    const held = (code) => (this.keys.has(code) ? 1 : 0);
    const step = new Vector3(held('KeyW') - held('KeyS'), held('KeyA') - held('KeyD'), 0).applyQuaternion(turn);
    step.z += held('KeyE') - held('KeyQ');
    this.camera.position.addScaledVector(step, dt_s * this.speed_mps());
  }

  moveByKeys(dt_s) {
    const held = (code) => (this.keys.has(code) ? 1 : 0);
    const right = new Vector3().setFromMatrixColumn(this.camera.matrix, 0);
    const ahead = new Vector3().crossVectors(this.camera.up, right);
    const step = right.multiplyScalar(held('ArrowRight') - held('ArrowLeft'))
                     .addScaledVector(ahead, held('ArrowUp') - held('ArrowDown'));
    if (step.lengthSq() === 0) return;
    this.controls.dispatchEvent({type: 'start'});  // the user moves the camera
    step.multiplyScalar(dt_s * 0.8 * this.camera.position.distanceTo(this.controls.target));
    this.camera.position.add(step);
    this.controls.target.add(step);
  }

  speed_mps() {
    const fast = this.keys.has('ShiftLeft') || this.keys.has('ShiftRight') ? 5 : 1;
    return fast * Math.max(1, 0.25 * (this.extent_m ?? 20));
  }

  /** Zooms by a factor, for keys. */
  zoom(factor) {
    this.controls.dispatchEvent({type: 'start'});
    const offset = this.camera.position.clone().sub(this.controls.target).multiplyScalar(factor);
    this.camera.position.copy(this.controls.target).add(offset);
  }

  /** What the camera looks at. */
  get focus() {
    return this.controls.enabled ? this.controls.target :
                                   this.camera.position.clone().add(this.camera.getWorldDirection(new Vector3()));
  }

  /** Numbers of the view, for the URL: mode, position, target. */
  view() {
    const numbers = [...this.camera.position.toArray(), ...this.controls.target.toArray()];
    return `${this.mode},${numbers.map((x) => +x.toFixed(2)).join(',')}`;
  }

  /** Takes numbers that view() gave; returns false if they are none. */
  setView(text, vehicle) {
    const [mode, ...numbers] = text.split(',');
    const values = numbers.map(Number);
    if (!Object.hasOwn(MODES, mode) || values.length !== 6 || !values.every(Number.isFinite)) return false;
    this.setMode(NEEDS_VEHICLE.has(mode) && !vehicle ? 'orbit' : mode, vehicle);
    this.camera.position.fromArray(values, 0);
    this.controls.target.fromArray(values, 3);
    if (mode === 'fly') this.setMode('fly', vehicle);
    return true;
  }
}

/** Yaw of a vehicle, counter-clockwise from east. */
export function headingOf(X) { return Math.atan2(X.elements[1], X.elements[0]); }
