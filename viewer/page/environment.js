// SPDX-License-Identifier: BSD-3-Clause
// Light, sky and water between the camera and what it sees: uniforms that all materials share, and the sky itself.
// The sky is that of Shoal's own renderer (sim/camera/renderer.cpp).
import {
  Color,
  DirectionalLight,
  Matrix4,
  Mesh,
  PlaneGeometry,
  ShaderMaterial,
  Vector3,
  Vector4
} from './vendor/three.js';

/** Uniforms shared, by reference, by all materials of the scene. */
export const env = {
  toSun: {value: new Vector3(0.5, -0.4, 0.7).normalize()},
  sunColor: {value: new Color(1, 0.97, 0.91)},
  skyStrength: {value: 0.4},
  zenith: {value: new Color('#5b8fd6')},
  horizon: {value: new Color('#d6e4f0')},
  /** x: level of the water, relative to the origin; y: 1 with water; z: attenuation in 1/m; w: 1 with shadows */
  water: {value: new Vector4(0, 0, 0.02, 0)},
  waterColor: {value: new Color(0.030, 0.150, 0.215)},
  haze_m: {value: 6000},
  /** simulated time, for what moves with the waves; from 0 again every 1000 s */
  seconds: {value: 0},
};

/** Declarations and functions of the shaders: skyColor(direction), throughWater(color, position), toneOut. */
export const ENV_GLSL = /* glsl */ `
uniform vec3 toSun, sunColor, zenith, horizon, waterColor;
uniform float skyStrength, haze_m, seconds;
uniform vec4 water;
float raisedTo64(float x) { x *= x; x *= x; x *= x; x *= x; x *= x; return x * x; }
vec3 waterGlow(float z) { return waterColor * (0.35 + 0.75 * exp(min(0.0, z - water.x) / 45.0)); }
vec3 airColor(vec3 d) {
  vec3 color = horizon + (d.z >= 0.0 ? sqrt(d.z) * (zenith - horizon) : d.z * (horizon - vec3(0.181, 0.175, 0.156)));
  float toward = dot(d, toSun);
  if (toSun.z <= 0.0 || d.z < 0.0) return color;
  if (toward > 0.99996) return sunColor * 1.5;
  if (toward > 0.9) color += (raisedTo64(raisedTo64(toward)) + 0.15 * raisedTo64(toward)) * sunColor;
  return color;
}
// Share of a footprint that lines of some width at the whole numbers cover.
float lineShare(float x, float footprint, float width) {
  float seen = max(footprint, 0.25 * width);
  return clamp((0.5 * (width + seen) - abs(x - round(x))) / seen, 0.0, min(1.0, width / seen));
}
vec3 skyColor(vec3 d) {
  if (water.y < 0.5 || cameraPosition.z > water.x) return airColor(d);
  return waterGlow(cameraPosition.z) * (1.0 + 0.9 * d.z * abs(d.z));
}
// Attenuates a color by the water on the straight line from a position to the camera.
vec3 throughWater(vec3 color, vec3 p) {
  if (water.y < 0.5) return color;
  float a = cameraPosition.z - water.x, b = p.z - water.x;
  float low = min(a, b), high = max(a, b);
  if (low >= 0.0) return color;
  float wet = distance(cameraPosition, p) * (high <= 0.0 ? 1.0 : -low / (high - low));
  vec3 rest = exp(-vec3(1.7, 1.0, 0.8) * water.z * wet);
  vec3 glow = cameraPosition.z > water.x ? waterGlow(p.z) : skyColor(normalize(p - cameraPosition));
  return mix(glow, color, rest);
}
`;

const SKY_VERTEX = /* glsl */ `
varying vec3 vFar;
uniform mat4 unproject;
void main() {
  vec4 far = unproject * vec4(position.xy, 1.0, 1.0);
  vFar = far.xyz / far.w;
  gl_Position = vec4(position.xy, 1.0, 1.0);
}`;
const SKY_FRAGMENT = /* glsl */ `
${ENV_GLSL}
varying vec3 vFar;
void main() {
  gl_FragColor = vec4(skyColor(normalize(vFar - cameraPosition)), 1.0);
  #include <colorspace_fragment>
}`;

/** Sky behind everything, and the sun with its shadows. */
export class Environment {
  constructor(scene) {
    // The sky: a rectangle on the far plane, drawn after the bodies, so that only the pixels it is seen in cost time.
    this.unproject = {value: new Matrix4()};
    const material = new ShaderMaterial({
      uniforms: {...env, unproject: this.unproject},
      vertexShader: SKY_VERTEX,
      fragmentShader: SKY_FRAGMENT,
      depthWrite: false,
    });
    this.sky = new Mesh(new PlaneGeometry(2, 2), material);
    this.sky.frustumCulled = false;
    this.sky.renderOrder = 1000;
    scene.add(this.sky);
    // The sun, for shadows only: materials compute their light themselves.
    this.sun = new DirectionalLight(0xffffff, 1);
    this.sun.shadow.mapSize.set(2048, 2048);
    this.sun.shadow.bias = -0.0004;
    this.sun.shadow.radius = 2;
    scene.add(this.sun, this.sun.target);
    this.shadowsWanted = false;
  }

  choose(get) { this.setClarity(Number(get('clarity')) >= 4 ? 0 : Number(get('clarity')) + 0.05); }

  /** Takes light and water of a scene. */
  setScene(data, {extent_m}) {
    const light = data.light;
    env.toSun.value.fromArray(light.to_sun).normalize();
    env.sunColor.value.setRGB(1, 0.97, 0.91).multiplyScalar(env.toSun.value.z > 0 ? light.sun : 0);
    env.skyStrength.value = light.sky;
    env.zenith.value.set(light.zenith);
    env.horizon.value.set(light.horizon);
    this.extent_m = extent_m;
    this.shadowsWanted = light.shadows !== false && env.toSun.value.z > 0.02 && light.sun > 0;
    const water = data.water;
    env.water.value.x = water ? water.level_m - data.origin_m[2] : 0;
    env.water.value.y = water ? 1 : 0;
    env.haze_m.value = Math.max(3000, 12 * extent_m);
  }

  /** Sets the height of the water, relative to the origin of the scene. */
  setLevel(z_m) { env.water.value.x = z_m; }

  /** Sets how far one sees in the water, relative to the size of the scene; 0: perfectly clear. */
  setClarity(clarity) { env.water.value.z = clarity > 0 ? 1 / (clarity * Math.max(40, 3 * (this.extent_m ?? 50))) : 0; }

  /** Moves sky and shadows with the camera; `focus` is what it looks at. */
  update({time_us, camera, focus, distance_m, shadows}) {
    env.seconds.value = (time_us * 1e-6) % 1000;
    this.unproject.value.multiplyMatrices(camera.matrixWorld, camera.projectionMatrixInverse);
    const on = shadows && this.shadowsWanted;
    env.water.value.w = on ? 1 : 0;
    this.sun.castShadow = on;
    if (!on) return;
    // Shadows are fine near the focus and end some way around it.
    const reach_m = Math.min(400, Math.max(6, 1.3 * distance_m));
    const step = reach_m / 64;
    const at = this.sun.target.position;
    at.set(Math.round(focus.x / step) * step, Math.round(focus.y / step) * step, Math.round(focus.z / step) * step);
    this.sun.position.copy(at).addScaledVector(env.toSun.value, 3 * reach_m);
    const eye = this.sun.shadow.camera;
    if (eye.right !== reach_m) {
      eye.left = eye.bottom = -reach_m;
      eye.right = eye.top = reach_m;
      eye.near = 0.1;
      eye.far = 6 * reach_m;
      eye.updateProjectionMatrix();
      this.sun.shadow.normalBias = reach_m / 500;
    }
    this.sun.target.updateMatrixWorld();
  }
}
