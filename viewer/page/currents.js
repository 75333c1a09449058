// SPDX-License-Identifier: BSD-3-Clause
// Tides and currents: computed from the entries of the scene as the simulator does, and drawn as arrows at a depth or
// at the vehicles.
import {roundUp} from './shapes.js';
import {
  BufferAttribute,
  BufferGeometry,
  DoubleSide,
  DynamicDrawUsage,
  InstancedMesh,
  Matrix4,
  MeshBasicMaterial,
  Quaternion,
  Vector3,
} from './vendor/three.js';

/** Arrows on each side of the focus; 2 GRID + 1 along each axis. */
const GRID = 5;
const ARROWS_MAX = (2 * GRID + 1) ** 2 + 400;
/** Pale, to stay behind the vehicles. */
const COLOR = '#d7eef2';
/** Slower water has no arrow. */
const STILL_MPS = 1e-4;
/** The random part of a current is published once per second. */
const FRESH_US = 1.5e6;
const RANDOM_MAX = 100;
/** Peak of r -> (1 - exp(-a r^2)) / r is at r = 1. */
const LAMB_OSEEN = 1.2564312086261697;
const LEVEL_STEP_M = 1e-3;

const level = (speed, direction_rad) => [speed * Math.cos(direction_rad), speed * Math.sin(direction_rad), 0];
const angleOf = (tide, time_us) => 2 * Math.PI * time_us * 1e-6 / tide.period_s + tide.phase_rad;

function ofProfile(rows, depth_m) {
  const below = rows.findIndex(([depth]) => depth > depth_m);
  if (below === 0) return rows[0].slice(1);
  if (below < 0) return rows[rows.length - 1].slice(1);
  const a = rows[below - 1], b = rows[below], share = (depth_m - a[0]) / (b[0] - a[0]);
  return [1, 2, 3].map((k) => a[k] + (b[k] - a[k]) * share);
}

function ofVortex({center_m, peak_speed_mps, core_radius_m, core}, x, y) {
  const rx = x - center_m[0], ry = y - center_m[1], ratio = Math.hypot(rx, ry) / core_radius_m;
  if (ratio < 1e-9) return [0, 0, 0];
  const relative = core === 'rankine' ? Math.min(ratio, 1 / ratio) :
                                        (1 + 0.5 / LAMB_OSEEN) / ratio * -Math.expm1(-LAMB_OSEEN * ratio * ratio);
  const scale = peak_speed_mps * relative / (ratio * core_radius_m);
  return [-scale * ry, scale * rx, 0];
}

function ofGrid({low_m, high_m, columns, rows, outside, velocities_mps}, x, y) {
  if (outside !== 'edge' && (x < low_m[0] || y < low_m[1] || x > high_m[0] || y > high_m[1])) return [0, 0, 0];
  const place = (at, k, count) =>
      Math.max(0, Math.min(count - 1, (at - low_m[k]) / (high_m[k] - low_m[k]) * (count - 1)));
  const u = place(x, 0, columns), v = place(y, 1, rows);
  const i = Math.min(Math.floor(u), columns - 2), j = Math.min(Math.floor(v), rows - 2), a = u - i, b = v - j;
  const at = (di, dj) => velocities_mps[(j + dj) * columns + i + di];
  const mixed = [0, 1].map(
      (k) => (1 - b) * ((1 - a) * at(0, 0)[k] + a * at(1, 0)[k]) + b * ((1 - a) * at(0, 1)[k] + a * at(1, 1)[k]));
  return [...mixed, 0];
}

/** Velocity of an entry that depends on the place; null: it does not. */
function localPart(entry, x, y, depth_m) {
  switch (entry.type) {
    case 'profile':
      return ofProfile(entry.rows, depth_m);
    case 'power_law': {
      const share = Math.max(0, Math.min(1, 1 - depth_m / entry.water_depth_m));
      return level(share > 0 ? entry.speed_mps * share ** entry.exponent : 0, entry.direction_rad);
    }
    case 'wind_driven':
      return level(
          entry.speed_mps * Math.max(0, Math.min(1, 1 - depth_m / entry.reference_depth_m)), entry.direction_rad);
    case 'vortex':
      return ofVortex(entry, x, y);
    case 'grid':
      return ofGrid(entry, x, y);
    default:
      return null;
  }
}

const add = (a, b) => a.map((part, k) => part + b[k]);
const isNumbers = (values) => values.every(Number.isFinite);

/** Entries of which all numbers are there; others are left out, as those of a later version. */
function readCurrents(entries) {
  const needs = {
    constant: (one) => isNumbers(one.velocity_mps) && one.velocity_mps.length === 3,
    gauss_markov: (one) => isNumbers([one.speed_mps, one.direction_rad]),
    profile: (one) => one.rows.length > 0 && one.rows.every((row) => row.length === 4 && isNumbers(row)),
    power_law: (one) => isNumbers([one.speed_mps, one.direction_rad, one.water_depth_m, one.exponent]),
    wind_driven: (one) => isNumbers([one.speed_mps, one.direction_rad, one.reference_depth_m]),
    vortex: (one) => isNumbers([...one.center_m, one.peak_speed_mps, one.core_radius_m]) && one.core_radius_m > 0,
    grid: (one) => one.columns >= 2 && one.rows >= 2 && one.velocities_mps.length === one.columns * one.rows &&
        isNumbers([...one.low_m, ...one.high_m, ...one.velocities_mps.flat()]),
  };
  return (Array.isArray(entries) ? entries : []).filter((one) => {
    try {
      return Object.hasOwn(needs, one.type) && needs[one.type](one);
    } catch {
      return false;
    }
  });
}

/** Tides and currents of a scene. */
export class WaterMotion {
  /** `water`: of the scene; its level and its profile of the sound speed follow the tide from now on. */
  constructor(water) {
    this.water = water;
    this.currents = readCurrents(water?.currents);
    this.tides =
        (Array.isArray(water?.tides) ? water.tides : []).filter((one) => isNumbers([
                                                                  one?.amplitude_m, one?.period_s, one?.phase_rad,
                                                                  one?.current_mps, one?.current_direction_rad,
                                                                  one?.current_lead_rad
                                                                ]));
    this.mean_level_m = Number.isFinite(water?.mean_level_m) ? water.mean_level_m : water?.level_m ?? 0;
    this.random = [];  // messages `current`, by time
  }

  get moves() { return this.currents.length > 0 || this.tides.some((tide) => tide.current_mps > 0); }

  get isRandom() { return this.currents.some((entry) => entry.type === 'gauss_markov'); }

  /** Takes a message `current`: what is the same at all places, with the random parts. */
  take({time_us, velocity_mps}) {
    const whole = Number.isFinite(time_us) && Array.isArray(velocity_mps) && velocity_mps.length === 3;
    if (!whole || !isNumbers(velocity_mps)) return;
    this.random = this.random.filter((one) => one.time_us < time_us).slice(-RANDOM_MAX);
    this.random.push({time_us, velocity_mps});
  }

  /** Height of the tide over the mean level. */
  tideAt(time_us) {
    return this.tides.reduce((sum, tide) => sum + tide.amplitude_m * Math.cos(angleOf(tide, time_us)), 0);
  }

  /** The message `current` nearest to a time; null: none is near. */
  randomAt(time_us) {
    const away = (one) => Math.abs(one.time_us - time_us);
    const near = this.random.reduce((a, b) => (a && away(a) <= away(b) ? a : b), null);
    return near && away(near) <= FRESH_US ? near : null;
  }

  /** Is the random part of this time known? */
  knows(time_us) { return !this.isRandom || this.randomAt(time_us) !== null; }

  /** Velocity that is the same at all places; with the means of random parts that are not known. */
  uniformAt(time_us) {
    const known = this.isRandom ? this.randomAt(time_us) : null;
    if (known) return known.velocity_mps;
    let sum = [0, 0, 0];
    for (const entry of this.currents) {
      if (entry.type === 'constant') sum = add(sum, entry.velocity_mps);
      if (entry.type === 'gauss_markov') sum = add(sum, level(entry.speed_mps, entry.direction_rad));
    }
    for (const tide of this.tides)
      sum = add(
          sum,
          level(
              tide.current_mps * Math.cos(angleOf(tide, time_us) + tide.current_lead_rad), tide.current_direction_rad));
    return sum;
  }

  /** Velocity of the current at a position in the world, without the motion in waves. */
  velocityAt([x, y, z], time_us) {
    const depth_m = this.mean_level_m + this.tideAt(time_us) - z;
    let sum = this.uniformAt(time_us);
    for (const entry of this.currents) {
      const part = localPart(entry, x, y, depth_m);
      if (part) sum = add(sum, part);
    }
    return sum;
  }

  /** Sets level and profile of the sound speed of the scene to those of a time; returns true if they have changed. */
  setTime(time_us) {
    if (this.tides.length === 0) return false;
    const level_m = this.mean_level_m + this.tideAt(time_us), rise_m = level_m - this.water.level_m;
    if (Math.abs(rise_m) < LEVEL_STEP_M) return false;
    this.water.level_m = level_m;
    this.water.sound_speed = (this.water.sound_speed ?? []).map(([z, speed]) => [z + rise_m, speed]);
    return true;
  }
}

/** An arrow of length 1 along x, flat, with its tail at the origin. */
function arrowGeometry() {
  const flat = [[0, 0.012], [0, -0.012], [0.84, -0.012], [0, 0.012], [0.84, -0.012], [0.84, 0.012]];
  const head = [[0.8, 0.06], [0.8, -0.06], [1, 0]];
  // Two blades across each other: visible from everywhere.
  const level = [...flat, ...head].flatMap(([x, y]) => [x, y, 0]),
        upright = [...flat, ...head].flatMap(([x, z]) => [x, 0, z]);
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(new Float32Array([...level, ...upright]), 3));
  return geometry;
}

/** Distance between arrows for a distance of the camera. */
const spacingFor = (distance_m) => roundUp(Math.max(0.1, distance_m / 8));

/** Arrows of the current: on a grid around the focus at a depth, or at the vehicles. */
export class CurrentArrows {
  constructor(scene) {
    this.mesh = new InstancedMesh(
        arrowGeometry(),
        new MeshBasicMaterial({color: COLOR, side: DoubleSide, transparent: true, opacity: 0.7, depthWrite: false}),
        ARROWS_MAX);
    this.mesh.instanceMatrix.setUsage(DynamicDrawUsage);
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = 13;
    this.mesh.count = 0;
    scene.add(this.mesh);
    this.which = 'off';
    this.depth_m = 1;
    this.arrows = [];
    this.setScene({water: null, origin_m: [0, 0, 0]});
  }

  choose(get) {
    this.which = get('currents');
    this.depth_m = Math.max(0, Number(get('current-depth')) || 0);
  }

  /** Takes the water of a scene. */
  setScene({water, origin_m}) {
    const {random} = this.motion ?? {};
    this.motion = new WaterMotion(water);
    if (random && this.motion.isRandom) this.motion.random = random;
    this.origin_m = origin_m;
  }

  /** Positions in the world of the arrows that are wanted. */
  places(focus, distance_m, vehicles) {
    const [ox, oy, oz] = this.origin_m;
    const level_m = this.motion.water.level_m;
    if (this.which === 'vehicles')
      return vehicles.slice(0, 400).map(({at}) => [at.x + ox, at.y + oy, at.z + oz]).filter(([, , z]) => z <= level_m);
    // A grid that stays where it is while the camera moves.
    const step_m = spacingFor(distance_m), all = [];
    const middle = (x) => Math.round(x / step_m) * step_m;
    for (let i = -GRID; i <= GRID; ++i)
      for (let j = -GRID; j <= GRID; ++j)
        all.push([middle(focus.x + ox) + i * step_m, middle(focus.y + oy) + j * step_m, level_m - this.depth_m]);
    return all;
  }

  /** Places the arrows; the longest one is that of the fastest water. */
  update({time_us, focus, distance_m, vehicles}) {
    this.arrows = [];
    this.mesh.count = 0;
    if (this.which === 'off' || !this.motion.water || !this.motion.moves) return;
    this.arrows = this.places(focus, distance_m, vehicles).map((position) => {
      const velocity_mps = this.motion.velocityAt(position, time_us);
      return {position, velocity_mps, speed_mps: Math.hypot(...velocity_mps)};
    });
    const fastest_mps = Math.max(0, ...this.arrows.map((arrow) => arrow.speed_mps));
    const max_m = (this.which === 'vehicles' ? 1.2 : 0.9) * spacingFor(distance_m);
    const X = new Matrix4(), turn = new Quaternion(), east = new Vector3(1, 0, 0), scale = new Vector3();
    for (const arrow of this.arrows) {
      if (arrow.speed_mps < STILL_MPS) continue;
      const size_m = max_m * arrow.speed_mps / fastest_mps;
      turn.setFromUnitVectors(east, new Vector3(...arrow.velocity_mps).divideScalar(arrow.speed_mps));
      const at = new Vector3(...arrow.position.map((x, k) => x - this.origin_m[k]));
      this.mesh.setMatrixAt(this.mesh.count++, X.compose(at, turn, scale.setScalar(size_m)));
    }
    this.mesh.instanceMatrix.needsUpdate = true;
  }

  /** Writes the speed at the fastest arrow, or at each vehicle. */
  annotate(labels, time_us) {
    const shown = this.arrows.filter((arrow) => arrow.speed_mps >= STILL_MPS);
    if (shown.length === 0) return;
    const mean = this.motion.knows(time_us) ? '' : ' (mean)';
    const fastest = shown.reduce((a, b) => (b.speed_mps > a.speed_mps ? b : a));
    const named = this.which === 'vehicles' ? shown.slice(0, 12) : [fastest];
    for (const arrow of named)
      labels.text(
          new Vector3(...arrow.position.map((x, k) => x - this.origin_m[k])),
          `→ current ${arrow.speed_mps.toFixed(2)} m/s${mean}`, {color: COLOR, dy: 28});
  }
}
