// SPDX-License-Identifier: BSD-3-Clause
// The water surface with the waves of the run: elevation = sum of a cos(k (x cos d + y sin d) - omega t + phase).
import {env, ENV_GLSL} from './environment.js';
import {radialGrid, roundUp} from './shapes.js';
import {
  DataTexture,
  DoubleSide,
  FloatType,
  Mesh,
  NearestFilter,
  OrthographicCamera,
  PlaneGeometry,
  RGBAFormat,
  Scene,
  ShaderMaterial,
  Vector3,
  WebGLRenderTarget,
} from './vendor/three.js';

const REACH_M = 25000;
/** Waves are shaded as if the standard deviation of their slope were at least this, but at most by some factor. */
const SLOPE_SEEN = 0.25;
const GAIN_MAX = 6;

const WAVE_GLSL = /* glsl */ `
uniform sampler2D waves;  // for each wave: k cos d, k sin d, phase now, amplitude; sorted by k
uniform int waveCount;
// Returns slope x, slope y and elevation at a position; waves that the cells are too coarse for are left out.
vec3 waveAt(vec2 p, float cell_m) {
  vec3 sum = vec3(0.0);
  for (int i = 0; i < waveCount; ++i) {
    vec4 wave = texelFetch(waves, ivec2(i, 0), 0);
    float fade = 1.0 - smoothstep(1.0, 2.0, length(wave.xy) * cell_m);
    if (fade <= 0.0) break;
    float phase = dot(wave.xy, p) + wave.z, a = fade * wave.w;
    sum.z += a * cos(phase);
    sum.xy -= a * sin(phase) * wave.xy;
  }
  return sum;
}`;

const VERTEX = /* glsl */ `
${WAVE_GLSL}
uniform vec3 center;
uniform float cells;
varying vec3 vWorld;
varying vec3 vWave;
void main() {
  vec2 p = position.xy + center.xy;
  float cell_m = cells * length(position.xy);
  vWave = waveAt(p, cell_m);
  vWorld = vec3(p, center.z + vWave.z);
  gl_Position = projectionMatrix * viewMatrix * vec4(vWorld, 1.0);
}`;

const FRAGMENT = /* glsl */ `
${ENV_GLSL}
varying vec3 vWorld;
varying vec3 vWave;
uniform float gain, line_m, bottomless;
// Patches without a pattern, from 0 to 1.
float patches(vec2 p) {
  p += 0.8 * vec2(sin(1.7 * p.y), sin(1.3 * p.x));
  return 0.5 + 0.25 * (sin(2.9 * p.x + 1.1 * p.y) + sin(1.9 * p.y - 2.3 * p.x));
}
void main() {
  vec3 normal = normalize(vec3(-vWave.xy, 1.0));
  // A grid of lines: without it a flat sea could be sky.  They go where they are closer than a few pixels.
  vec2 at = vWorld.xy / line_m, footprint = fwidth(at);
  float line = max(lineShare(at.x, footprint.x, 0.006), lineShare(at.y, footprint.y, 0.006));
  line *= 1.0 - smoothstep(0.08, 0.3, max(footprint.x, footprint.y));
  // Foam: where the surface is steep near a crest.
  float steep = length(vWave.xy);
  float foam = vWave.z > 0.0 ? smoothstep(0.16, 0.34, steep) * smoothstep(0.35, 0.75, patches(vWorld.xy)) : 0.0;
  vec3 toEye = normalize(cameraPosition - vWorld);
  float distance_m = distance(cameraPosition, vWorld);
  vec4 color;
  if (cameraPosition.z > vWorld.z) {
    // From above: reflected sky by Fresnel's law (Schlick), and the color of the water.
    float cosine = max(dot(normal, toEye), 0.02);
    float fresnel = 0.02 + 0.98 * pow(1.0 - cosine, 5.0);
    vec3 mirrored = reflect(-toEye, normal);
    mirrored.z = abs(mirrored.z);
    // Light scattered back by the water: more where the surface faces the sun or the viewer.
    // Small slopes are shaded as if they were larger, so that one sees them.
    float facing = gain * dot(normal.xy, toSun.xy);
    float lit = clamp(0.55 + 2.2 * facing + 0.8 * vWave.z / (abs(vWave.z) + 1.0), 0.15, 1.4);
    vec3 body = waterColor * vec3(0.55, 0.75, 0.9) * (0.35 + lit);
    color.rgb = mix(body, airColor(mirrored), fresnel);
    float glint = raisedTo64(max(0.0, dot(mirrored, toSun)));
    color.rgb += sunColor * 0.5 * glint;
    color.a = clamp(mix(0.38, 0.8, bottomless) + fresnel + glint, 0.0, 1.0);
    color = mix(color, vec4(0.80, 0.93, 0.95, 1.0), 0.24 * line);
    color = mix(color, vec4(vec3(0.92, 0.95, 0.95) * (skyStrength + sunColor), 1.0), 0.85 * foam);
    float far = smoothstep(0.1, 1.0, distance_m / haze_m);
    color = mix(color, vec4(airColor(normalize(vec3(-toEye.xy, 0.0))), 1.0), far);
  } else {
    // From below: light through the surface above the viewer, total reflection beyond the critical angle.
    float cosine = abs(dot(normal, toEye));
    float window = smoothstep(0.60, 0.72, cosine);
    vec3 light = mix(waterGlow(water.x) * 1.15, vec3(0.35, 0.62, 0.70), window);
    // Waves bundle and spread the light from above; foam is dark from below.
    light *= clamp(1.0 + 1.5 * gain * dot(normal.xy, toSun.xy) - 0.4 * foam, 0.6, 1.7);
    light = mix(light, vec3(0.75, 0.92, 0.95), 0.35 * line);
    color = vec4(throughWater(light, vWorld), 0.85);
  }
  gl_FragColor = color;
  #include <colorspace_fragment>
}`;

const PROBE_FRAGMENT = /* glsl */ `
${WAVE_GLSL}
uniform sampler2D points;
void main() { gl_FragColor = vec4(waveAt(texelFetch(points, ivec2(gl_FragCoord.xy), 0).xy, 0.0), 1.0); }`;

/** The surface of the water of a scene. */
export class Water {
  constructor(scene, coarse) {
    this.uniforms = {
      ...env,
      waves: {value: null},
      waveCount: {value: 0},
      center: {value: new Vector3()},
      cells: {value: 0},
      gain: {value: 1},
      line_m: {value: 10},
      bottomless: {value: 1},
    };
    const rings = coarse ? 140 : 240, sectors = coarse ? 160 : 256;
    const growth = Math.pow(REACH_M / 0.3, 1 / (rings - 1));
    // Size of a cell relative to its distance from the center.
    this.uniforms.cells.value = Math.min(growth - 1, 2 * Math.PI / sectors);
    const material = new ShaderMaterial({
      uniforms: this.uniforms,
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      side: DoubleSide,
      transparent: true,
      depthWrite: false,
    });
    this.mesh = new Mesh(radialGrid(rings, sectors, 0.3, REACH_M), material);
    this.mesh.frustumCulled = false;
    this.mesh.matrixAutoUpdate = false;
    this.mesh.renderOrder = 10;
    this.mesh.visible = false;
    this.waves = [];
    this.shown = true;
    scene.add(this.mesh);
  }

  choose(get) { this.shown = get('water'); }

  /** Takes the water of a scene. */
  setScene(data) {
    this.data = data.water;
    const ground = data.bodies.some(({parts}) => parts.some(({shape}) => shape === 'plane' || shape === 'terrain'));
    this.uniforms.bottomless.value = ground ? 0 : 1;
    this.origin_m = data.origin_m;
    this.waves = [...(data.water?.waves ?? [])].sort((a, b) => a.k_radpm - b.k_radpm);
    this.uniforms.waves.value?.dispose();
    const texture = new DataTexture(
        new Float32Array(4 * Math.max(1, this.waves.length)), Math.max(1, this.waves.length), 1, RGBAFormat, FloatType);
    texture.minFilter = texture.magFilter = NearestFilter;
    this.uniforms.waves.value = texture;
    this.uniforms.waveCount.value = this.waves.length;
    const slope = Math.sqrt(this.waves.reduce((sum, wave) => sum + 0.5 * (wave.amplitude_m * wave.k_radpm) ** 2, 0));
    this.uniforms.gain.value = Math.min(GAIN_MAX, Math.max(1, SLOPE_SEEN / Math.max(1e-6, slope)));
  }

  /** Moves the waves to a time, and the surface under the camera. */
  update({time_us, camera, distance_m}) {
    this.mesh.visible = this.shown && this.data !== null && this.data !== undefined;
    if (!this.mesh.visible) return;
    this.setTime(time_us);
    this.uniforms.line_m.value = roundUp(Math.max(0.5, distance_m / 8));
    const z = this.data.level_m - this.origin_m[2];
    this.uniforms.center.value.set(Math.round(camera.position.x), Math.round(camera.position.y), z);
  }

  setTime(time_us) {
    const t_s = time_us * 1e-6, to = this.uniforms.waves.value.image.data;
    this.waves.forEach((wave, i) => {
      const kx = wave.k_radpm * Math.cos(wave.direction_rad), ky = wave.k_radpm * Math.sin(wave.direction_rad);
      // The phase now in double precision: a float would lose it after hours.
      const phase = wave.phase_rad - wave.omega_radps * t_s + kx * this.origin_m[0] + ky * this.origin_m[1];
      to[4 * i] = kx, to[4 * i + 1] = ky;
      to[4 * i + 2] = phase - 2 * Math.PI * Math.floor(phase / (2 * Math.PI));
      to[4 * i + 3] = wave.amplitude_m;
    });
    this.uniforms.waves.value.needsUpdate = true;
  }

  /** Returns the heights, above the level, that the shader gives at positions in the world and a time. */
  heights(renderer, points, time_us) {
    const texels = new Float32Array(4 * points.length);
    points.forEach(([x, y], i) => texels.set([x - this.origin_m[0], y - this.origin_m[1], 0, 0], 4 * i));
    const input = new DataTexture(texels, points.length, 1, RGBAFormat, FloatType);
    input.needsUpdate = true;
    this.setTime(time_us);
    // Draw one pixel for each position into an image of floats.
    const target = new WebGLRenderTarget(points.length, 1, {type: FloatType, depthBuffer: false});
    const material = new ShaderMaterial({
      uniforms: {...this.uniforms, points: {value: input}},
      fragmentShader: PROBE_FRAGMENT,
      vertexShader: 'void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }',
    });
    const scene = new Scene();
    const mesh = new Mesh(new PlaneGeometry(2, 2), material);
    mesh.frustumCulled = false;
    scene.add(mesh);
    renderer.setRenderTarget(target);
    renderer.render(scene, new OrthographicCamera());
    const result = new Float32Array(4 * points.length);
    renderer.readRenderTargetPixels(target, 0, 0, points.length, 1, result);
    renderer.setRenderTarget(null);
    for (const object of [target, material, input]) object.dispose();
    return points.map((_, i) => result[4 * i + 2]);
  }
}
