// SPDX-License-Identifier: BSD-3-Clause
// Where sensors were when a message was measured: poses of devices at times of the states that the page keeps.
import {matrixOf} from './bodies.js';
import {Matrix4, Quaternion, Vector3} from './vendor/three.js';

/** A stamp this much before its publication is that of another clock. */
const LATENCY_MAX_US = 500000;
const ONE = new Vector3(1, 1, 1);

/** Devices of a scene by their channels and names. */
export class SensorPoses {
  constructor(app) {
    this.app = app;
    this.clear();
  }

  clear() {
    this.byChannel = new Map();
    this.byName = new Map();
    this.slots = new Map();
  }

  /** Channels of devices of these types, at most `max`; `which`: of all vehicles, of the selected one, or of none. */
  channelsOf(types, which, max) {
    const names = [];
    for (const [channel, {vehicle, device}] of this.byChannel)
      if (types.includes(device.type) && (which === 'all' || (which === 'selected' && vehicle === this.app.selected)))
        names.push(channel);
    return new Set(names.slice(0, max));
  }

  /** Takes the devices of a scene. */
  setScene(data) {
    this.clear();
    data.bodies.filter((body) => !body.fixed).forEach((body, slot) => this.slots.set(body.index, slot));
    for (const vehicle of data.vehicles) {
      const clocked = vehicle.devices.some((device) => device.type === 'clock');
      for (const device of vehicle.devices) {
        const mounted = {vehicle: vehicle.name, device, clocked, body: device.body, X_BS: matrixOf(device.pose)};
        this.byName.set(`${vehicle.name}/${device.name}`, mounted);
        for (const channel of device.channels ?? []) this.byChannel.set(String(channel), mounted);
      }
    }
  }

  /** Time at which a message was measured: its stamp, unless that is of the clock of a vehicle. */
  sampleTime({time_us, fields}, mounted) {
    const stamp_us = Number(fields.utime) - (this.app.timeBar.hello.epoch_us ?? 0);
    const usable = !mounted.clocked && stamp_us <= time_us && stamp_us >= time_us - LATENCY_MAX_US;
    return usable ? stamp_us : time_us;
  }

  /** Are the poses at a time known? */
  reached(time_us) { return (this.app.playback.newest?.time_us ?? -Infinity) >= time_us; }

  /** Is a time later than what the page shows, because it shows the past of a run? */
  isFuture(time_us) {
    const newest = this.app.playback.newest;
    return newest !== null && time_us > newest.time_us + 1e6 * Math.max(1, newest.speed || 100);
  }

  /** Pose of a body at a time; that which is drawn where the page does not keep this time. */
  bodyAt(body, time_us) {
    const slot = this.slots.get(body);
    const pose = slot === undefined ? null : this.app.playback.poseAt(slot, time_us);
    if (!pose) return this.app.bodies.X_WB[body].clone();
    const q = new Quaternion(pose[3], pose[4], pose[5], pose[6]);
    return new Matrix4().compose(new Vector3(pose[0], pose[1], pose[2]), q, ONE);
  }

  /** Pose of a sensor at a time. */
  sensorAt(mounted, time_us) { return this.bodyAt(mounted.body, time_us).multiply(mounted.X_BS); }

  /** Position of what a range goes to: VEHICLE/DEVICE, a vehicle, an object or a body; null: not in the scene. */
  targetAt(name, time_us) {
    const mounted = this.byName.get(name);
    if (mounted) return new Vector3().setFromMatrixPosition(this.sensorAt(mounted, time_us));
    const vehicle = this.app.byName.get(name);
    if (vehicle) return new Vector3().setFromMatrixPosition(this.bodyAt(vehicle.body, time_us).multiply(vehicle.X_BV));
    const body = this.app.data.bodies.find((one) => one.name === name || one.owner === name);
    return body ? new Vector3().setFromMatrixPosition(this.bodyAt(body.index, time_us)) : null;
  }
}
