// SPDX-License-Identifier: BSD-3-Clause
// Sound under water: each transmission is a shell that expands with the sound speed, as thick as it lasts; a mark at
// each receiver shows what became of it.
import {env, ENV_GLSL} from './environment.js';
import {
  DoubleSide,
  DynamicDrawUsage,
  InstancedBufferAttribute,
  InstancedMesh,
  Matrix4,
  ShaderMaterial,
  SphereGeometry,
  Vector3
} from './vendor/three.js';

const SOUNDS_MAX = 256;
const MARKS_MAX = 400;
/** Marks, and the lines from senders to receivers, stay for this wall time. */
const MARK_S = 2.5;
/** A run that is faster is shown as if it had this speed. */
const SPEED_MAX = 100;
/** A sound that would cross the scene in less wall time is drawn slower, so that it takes this. */
const CROSSING_S = 0.8;

/** Looks of outcomes, for people who cannot tell colors too (Okabe and Ito 2008): color, sign and text. */
export const OUTCOMES = {
  none: {color: '#009e73', sign: '✓', text: 'decoded'},
  noise: {color: '#e69f00', sign: '≈', text: 'lost in noise'},
  interference: {color: '#d55e00', sign: '✕', text: 'collision'},
  half_duplex: {color: '#cc79a7', sign: '◐', text: 'receiver was sending'},
  busy: {color: '#f0e442', sign: '■', text: 'receiver busy'},
  captured: {color: '#f0e442', sign: '▲', text: 'receiver took another'},
  doppler: {color: '#56b4e9', sign: '»', text: 'Doppler shift too large'},
  blocked: {color: '#999999', sign: '▮', text: 'path blocked'},
  out_of_water: {color: '#999999', sign: '↑', text: 'out of the water'},
  receiver_off: {color: '#999999', sign: '○', text: 'receiver off'},
  sender_off: {color: '#999999', sign: '○', text: 'sender off'},
  link: {color: '#999999', sign: '–', text: 'link down'},
  range: {color: '#999999', sign: '…', text: 'out of range'},
  shadow: {color: '#0072b2', sign: '◗', text: 'in a shadow'},
};
/** Colors of the shells by kind. */
const KINDS = {
  message: '#56b4e9',
  ping: '#f0e442',
  answer: '#009e73',
  noise: '#cc79a7'
};

const VERTEX = /* glsl */ `
attribute vec4 tint;
varying vec3 vWorld, vNormal;
varying vec4 vTint;
void main() {
  vec4 world = instanceMatrix * vec4(position, 1.0);
  vWorld = world.xyz;
  vNormal = normalize(mat3(instanceMatrix) * normal);
  vTint = tint;
  gl_Position = projectionMatrix * viewMatrix * world;
}`;
const FRAGMENT = /* glsl */ `
${ENV_GLSL}
varying vec3 vWorld, vNormal;
varying vec4 vTint;
void main() {
  // Bright at the rim; the middle stays clear.
  float rim = 1.0 - abs(dot(normalize(vNormal), normalize(cameraPosition - vWorld)));
  float alpha = vTint.a * (0.05 + 0.85 * pow(rim, 3.0));
  gl_FragColor = vec4(vTint.rgb, alpha);
  #include <colorspace_fragment>
}`;

/** Transmissions on their way, and marks of receptions. */
export class Sounds {
  constructor(scene) {
    const material = new ShaderMaterial({
      uniforms: env,
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      side: DoubleSide,
      transparent: true,
      depthWrite: false,
    });
    this.mesh = new InstancedMesh(new SphereGeometry(1, 64, 40), material, 2 * SOUNDS_MAX);
    this.mesh.instanceMatrix.setUsage(DynamicDrawUsage);
    this.tint = new InstancedBufferAttribute(new Float32Array(8 * SOUNDS_MAX), 4);
    this.mesh.geometry.setAttribute('tint', this.tint);
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = 20;
    this.mesh.count = 0;
    this.shown = true;
    scene.add(this.mesh);
    this.clear();
  }

  choose(get) { this.shown = get('sounds'); }

  rewind() { this.clear(); }

  /** How many times slower than in the run the sounds are drawn; 1: as in the run. */
  get slowness() { return Math.max(1, ...this.rings.map((ring) => ring.slowness)); }

  /** Forgets all sounds: another scene, or the time was set. */
  clear() {
    this.sounds = [];
    this.marks = [];
    this.lines = [];
    this.rings = [];
    this.mesh.count = 0;
  }

  /** Takes the size and origin of a scene. */
  setScene(data, {extent_m}) {
    this.clear();
    this.origin_m = data.origin_m;
    this.reach_m = Math.max(100, 4 * extent_m);
  }

  /** Adds transmissions. */
  add(items) {
    for (const item of items) {
      if (!Array.isArray(item.position_m) || !(item.sound_speed_mps > 0)) continue;
      const at = new Vector3(...item.position_m.map((x, i) => x - this.origin_m[i]));
      this.sounds.push({...item, at, reach_m: 0, since_ms: null});
    }
    while (this.sounds.length > SOUNDS_MAX) this.sounds.shift();
  }

  /** Adds what became of transmissions at receivers. */
  addReceptions(items) {
    for (const item of items) {
      if (!Array.isArray(item.position_m)) continue;
      const at = new Vector3(...item.position_m.map((x, i) => x - this.origin_m[i]));
      const sound = this.sounds.findLast((one) => one.id === item.id);
      const look = OUTCOMES[item.outcome] ?? {color: '#999999', sign: '?', text: item.outcome};
      this.marks.push({...item, at, look, from: sound?.at ?? null});
      // The sound is drawn up to the farthest receiver.
      if (sound) sound.reach_m = Math.max(sound.reach_m, 1.2 * sound.at.distanceTo(at));
    }
    while (this.marks.length > MARKS_MAX) this.marks.shift();
  }

  /** Radii of the two faces of the shell of a sound at a time; null when it is not drawn. */
  radii(sound, time_us) {
    const age_s = (time_us - sound.time_us) * 1e-6;
    if (age_s < 0) return null;
    const outer_m = age_s * sound.sound_speed_mps;
    const inner_m = Math.max(0, outer_m - sound.duration_us * 1e-6 * sound.sound_speed_mps);
    return {outer_m, inner_m, slowness: 1};
  }

  /** The radii as they are drawn: while the run is too fast for a sound to be seen, it expands with the wall time. */
  drawnRadii(sound, reach_m, {time_us, speed, paused, now_ms}) {
    const radii = this.radii(sound, time_us);
    const crossing_s = reach_m / sound.sound_speed_mps / speed;
    if (!radii || paused || crossing_s >= CROSSING_S) return radii;
    sound.since_ms ??= now_ms;
    const outer_m = reach_m * (now_ms - sound.since_ms) * 1e-3 / CROSSING_S;
    const thick_m = Math.min(0.15 * reach_m, Math.max(0.04 * reach_m, radii.outer_m - radii.inner_m));
    const inner_m = Math.max(0, outer_m - thick_m);
    return {outer_m, inner_m, slowness: CROSSING_S / crossing_s};
  }

  /** Draws what is on its way at a time; `speed`: simulated seconds per second, 0 or infinite: as fast as it goes. */
  update({time_us, speed: chosen, paused, now_ms}) {
    const speed = chosen > 0 && chosen < SPEED_MAX ? chosen : SPEED_MAX;
    const lasting_us = MARK_S * 1e6 * Math.max(1, speed);
    this.marks = this.marks.filter((mark) => mark.time_us > time_us - lasting_us && mark.time_us < time_us + 60e6);
    this.visibleMarks = this.shown ? this.marks.filter((mark) => mark.time_us <= time_us) : [];
    this.lines = this.visibleMarks.filter((mark) => mark.from).map((mark) => {
      return {from: mark.from, to: mark.at, look: mark.look, left: 1 - (time_us - mark.time_us) / lasting_us, mark};
    });
    this.rings = [];
    let count = 0;
    const matrix = new Matrix4();
    this.sounds = this.sounds.filter((sound) => {
      // One that is drawn slower ends at its farthest receiver, if that is known.
      const whole_m = Math.max(this.reach_m, sound.reach_m);
      const slowed_m = sound.reach_m > 0 ? sound.reach_m : this.reach_m;
      const radii = this.drawnRadii(sound, slowed_m, {time_us, speed, paused, now_ms});
      if (!radii) return sound.time_us < time_us + 60e6;
      const reach_m = radii.slowness > 1 ? slowed_m : whole_m;
      if (radii.inner_m > reach_m) return false;
      const fade = Math.max(0, 1 - radii.outer_m / (1.3 * reach_m));
      this.rings.push({sound, ...radii});
      if (!this.shown) return true;
      for (const [radius_m, strength] of [[radii.outer_m, 1], [radii.inner_m, 0.45]]) {
        if (radius_m <= 0 || count >= 2 * SOUNDS_MAX) continue;
        matrix.makeScale(radius_m, radius_m, radius_m).setPosition(sound.at);
        this.mesh.setMatrixAt(count, matrix);
        this.tint.setXYZW(count++, ...linear(KINDS[sound.kind] ?? KINDS.message), strength * (0.25 + 0.75 * fade));
      }
      return true;
    });
    this.mesh.count = count;
    this.mesh.visible = count > 0;
    if (count === 0) return;
    this.mesh.instanceMatrix.needsUpdate = true;
    this.tint.needsUpdate = true;
  }
}

/** Returns red, green and blue of #rrggbb in linear light. */
export function linear(color) {
  return [1, 3, 5].map((at) => {
    const value = parseInt(color.slice(at, at + 2), 16) / 255;
    return value <= 0.04045 ? value / 12.92 : Math.pow((value + 0.055) / 1.055, 2.4);
  });
}
