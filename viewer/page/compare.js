// SPDX-License-Identifier: BSD-3-Clause
// Another branch of the run, or a second log, as ghosts over what is shown, at the same time.
import {ghostOf} from './bodies.js';
import {Looker} from './past.js';
import {Playback} from './playback.js';
import {Group, Matrix4, MeshBasicMaterial, Quaternion, Vector3} from './vendor/three.js';

const COLOR = '#ff4fd0';
/** Bodies of a scene that get a ghost; the bodies of vehicles first. */
const GHOSTS_MAX = 300;
/** The server keeps states at least this far apart. */
const INTERVAL_US = 100000;
const KEPT = 20;
const ONE = new Vector3(1, 1, 1);

/** The ghosts. */
export class Ghosts {
  constructor(scene, assets, connection) {
    this.assets = assets;
    this.looker = new Looker(connection);
    // A little behind: a body that is where its ghost is covers it.
    const behind = {polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 4};
    this.material =
        new MeshBasicMaterial({color: COLOR, transparent: true, opacity: 0.4, depthWrite: false, ...behind});
    this.root = new Group();
    scene.add(this.root);
    this.branch = null;
    this.clear();
  }

  clear() {
    this.root.clear();
    this.ghosts = [];
    this.bodies = null;
    this.states = [];
    this.mixer = new Playback();
    this.looker.reset();
  }

  /** Takes the bodies of a scene. */
  setScene(data) {
    this.clear();
    this.data = data;
    if (this.branch !== null) this.build();
  }

  build() {
    const bases = new Set(this.data.vehicles.map((vehicle) => vehicle.body));
    const movable = this.data.bodies.filter((body) => !body.fixed);
    const order =
        movable.map((body, slot) => ({body, slot})).sort((a, b) => bases.has(b.body.index) - bases.has(a.body.index));
    this.ghosts = order.slice(0, GHOSTS_MAX).map(({body, slot}) => {
      const root = ghostOf(body, this.assets, this.material);
      root.visible = false;
      this.root.add(root);
      return {root, slot, body, at: new Vector3()};
    });
    this.left_out = movable.length - this.ghosts.length;
  }

  /** Shows a branch; null: none. */
  show(branch) {
    this.branch = branch;
    this.states = [];
    this.mixer = new Playback();
    this.looker.reset();
    if (branch === null) {
      this.root.clear();
      this.ghosts = [];
    } else if (this.data && this.ghosts.length === 0) {
      this.build();
    }
  }

  /** Takes a state; returns false if it is not of the branch that is shown. */
  take(state) {
    if (this.branch === null || state.branch !== this.branch) return false;
    this.states = this.states.filter((one) => one.time_us !== state.time_us && one.poses.length === state.poses.length);
    this.states.push(state);
    this.states.sort((a, b) => a.time_us - b.time_us);
    if (this.states.length > KEPT) this.states.splice(this.shown_at_us > state.time_us ? 0 : KEPT, 1);
    this.looker.answered();
    this.stale = true;
    return true;
  }

  /** Poses of the branch at the time shown, after its end the last ones, as those of a playback; null: not known. */
  get poses() { return this.mixer.poses.length > 0 ? this.mixer.poses : null; }

  /** Pose of a movable body of the branch at a time near the one shown, as Playback.poseAt; null: not known. */
  poseAt(slot, time_us) {
    this.mixer.states = this.states;
    return this.mixer.poseAt(slot, time_us);
  }

  /** Moves the ghosts to a time, and asks for the states around it; returns true if they moved. */
  update(time_us) {
    if (this.branch === null || !this.data) return false;
    this.shown_at_us = time_us;
    this.states = this.states.filter((one) => Math.abs(one.time_us - time_us) < 20 * INTERVAL_US);
    const next = this.states.findIndex((one) => one.time_us > time_us);
    const a = next < 0 ? this.states[this.states.length - 1] : this.states[next - 1];
    const b = next < 0 ? null : this.states[next];
    // The state at or before the time, then the one after it.
    if (!a || time_us - a.time_us > INTERVAL_US)
      this.looker.request(time_us, this.branch);
    else if (!b)
      this.looker.request(a.time_us + INTERVAL_US, this.branch);
    this.looker.send();
    if (!a || (!this.stale && this.shown_us === time_us)) return false;
    this.stale = false;
    this.shown_us = time_us;
    const share = b ? (time_us - a.time_us) / (b.time_us - a.time_us) : 0;
    this.mixer.interpolate(a.poses, b ? b.poses : a.poses, share);
    this.place(this.mixer.poses);
    return true;
  }

  /** A body that the branch does not have has no position. */
  place(poses) {
    const rotation = new Quaternion();
    for (const {root, slot, at} of this.ghosts) {
      const i = 7 * slot;
      root.visible = i + 6 < poses.length && Number.isFinite(poses[i]);
      if (!root.visible) continue;
      at.set(poses[i], poses[i + 1], poses[i + 2]);
      rotation.set(poses[i + 3], poses[i + 4], poses[i + 5], poses[i + 6]);
      root.matrix.copy(new Matrix4().compose(at, rotation, ONE));
      root.matrixWorldNeedsUpdate = true;
    }
  }

  /** Distances between equal bodies, the largest first: a list of {name, body, distance_m}. */
  distances(X_WB) {
    const place = new Vector3();
    return this.ghosts.filter(({root}) => root.visible)
        .map(({body, at}) => ({
               name: body.name,
               body: body.index,
               distance_m: place.setFromMatrixPosition(X_WB[body.index]).distanceTo(at),
             }))
        .sort((a, b) => b.distance_m - a.distance_m);
  }
}
