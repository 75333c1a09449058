// SPDX-License-Identifier: BSD-3-Clause
// The material of bodies: light and textures as in Shoal's own renderer (sim/camera/renderer.cpp), so that the page
// and `shoal snap` look alike.
import {env, ENV_GLSL} from './environment.js';
import {
  Color,
  DoubleSide,
  LinearFilter,
  LinearMipmapLinearFilter,
  RepeatWrapping,
  ShaderMaterial,
  SRGBColorSpace,
  Texture,
  UniformsLib,
  UniformsUtils,
  Vector3,
} from './vendor/three.js';

/** Default colors: of fixed parts, of planes, and of the movable parts of each vehicle in turn. */
const FIXED_COLOR = '#b2aa9c';
const PLANE_COLOR = '#c4c6c4';
const GROUP_COLORS = ['#4678be', '#d66a3e', '#5c9c58', '#be4a60', '#8666b0', '#3a969e', '#d2aa46', '#7c7064'];

const VERTEX = /* glsl */ `
#include <common>
#include <shadowmap_pars_vertex>
varying vec3 vP, vNormalP, vWorld, vNormalW, vColor;
uniform vec3 offset;
void main() {
  // Instances are scaled: positions in meters in the frame of the part.
  vec3 size = vec3(1.0);
  mat4 toWorld = modelMatrix;
  #ifdef USE_INSTANCING
    toWorld = modelMatrix * instanceMatrix;
    size = vec3(length(instanceMatrix[0].xyz), length(instanceMatrix[1].xyz), length(instanceMatrix[2].xyz));
  #endif
  vP = position * size + offset;
  vNormalP = normal / size;
  vec4 worldPosition = toWorld * vec4(position, 1.0);
  vWorld = worldPosition.xyz;
  vNormalW = mat3(toWorld) * (normal / (size * size));
  #ifdef USE_INSTANCING_COLOR
    vColor = instanceColor;
  #else
    vColor = vec3(0.6);
  #endif
  vec4 mvPosition = viewMatrix * worldPosition;
  vec3 transformedNormal = normalize(mat3(viewMatrix) * vNormalW);
  gl_Position = projectionMatrix * mvPosition;
  #include <shadowmap_vertex>
}`;

const FRAGMENT = /* glsl */ `
#include <common>
#include <bsdfs>
#include <lights_pars_begin>
#include <shadowmap_pars_fragment>
#include <shadowmask_pars_fragment>
${ENV_GLSL}
varying vec3 vP, vNormalP, vWorld, vNormalW, vColor;
uniform vec3 color0, color1;
uniform float textureSize_m, gloss, opacity, contour_m;
uniform sampler2D image;

float integral(float t) { float whole = floor(t / 2.0); return whole + max(0.0, t - 2.0 * whole - 1.0); }
// Share of the second color in a footprint, where fields of length 1 alternate.
float shareOfSecond(float x, float w) {
  w = max(w, 1e-4);
  x = mod(x, 64.0);
  return clamp((integral(x + 0.5 * w) - integral(x - 0.5 * w)) / w, 0.0, 1.0);
}
vec3 albedo() {
  vec3 n = abs(vNormalP);
  bool alongX = n.x >= n.y && n.x >= n.z, alongZ = !alongX && n.z >= n.y;
  vec2 uv = vec2(alongX ? vP.y : vP.x, alongZ ? vP.y : vP.z);
  vec2 footprint = max(fwidth(vP.xy), fwidth(vP.yz));
  #ifdef CHECKER
    float w = max(footprint.x, footprint.y) / textureSize_m;
    float a = shareOfSecond(uv.x / textureSize_m, w), b = shareOfSecond(uv.y / textureSize_m, w);
    return mix(color0, color1, a * (1.0 - b) + b * (1.0 - a));
  #endif
  #ifdef STRIPES
    float w = max(footprint.x, footprint.y) / textureSize_m;
    return mix(color0, color1, shareOfSecond(uv.x / textureSize_m, w));
  #endif
  #ifdef IMAGE
    ivec2 pixels = textureSize(image, 0);
    return texture2D(image, vec2(uv.x, uv.y * float(pixels.x) / float(pixels.y)) / textureSize_m).rgb;
  #endif
  #ifdef GRID
    vec2 f = fwidth(vP.xy);
    float fine = max(lineShare(vP.x, f.x, 0.02), lineShare(vP.y, f.y, 0.02));
    float coarse = max(lineShare(vP.x / 10.0, f.x / 10.0, 0.02), lineShare(vP.y / 10.0, f.y / 10.0, 0.02));
    if (water.y > 0.5 && vWorld.z < water.x) {
      // Under water the lines are farther apart: fine ones are lost in the distance.
      vec2 at = vP.xy / (4.0 * contour_m), wide = fwidth(at);
      return vColor * (1.0 - 0.4 * max(lineShare(at.x, wide.x, 0.02), lineShare(at.y, wide.y, 0.02)));
    }
    return vColor * (1.0 - 0.35 * fine) * (1.0 - 0.25 * coarse * smoothstep(0.02, 0.08, max(f.x, f.y)));
  #endif
  #ifdef CONTOUR
    // Contour lines: one and a half pixels wide, every contour_m.
    float level = vP.z / contour_m, width = max(fwidth(level), 1e-5);
    float line = 1.0 - smoothstep(0.6, 1.5, abs(level - round(level)) / width);
    // Each fifth line is stronger.
    float strength = mod(abs(round(level)), 5.0) < 0.5 ? 0.45 : 0.25;
    return vColor * (1.0 - strength * line * clamp(0.35 / width, 0.0, 1.0));
  #endif
  return vColor;
}
#ifdef GROUND
// The ground under water: paler where it is shallow and bluer where it is deep, as on a chart.
vec3 tinted(vec3 own, float depth_m) {
  float deep = 1.0 - exp(-depth_m / 30.0);
  return own * mix(vec3(1.12, 1.06, 0.92), vec3(0.34, 0.56, 0.70), deep);
}
// Bright lines of the light that waves bundle on the ground, at most 1.
float caustics(vec2 p, float t) {
  vec2 q = p + 0.6 * vec2(sin(0.9 * p.y + 0.8 * t), sin(1.1 * p.x - 0.7 * t));
  q += 0.35 * vec2(sin(2.3 * q.y - 1.1 * t), sin(2.1 * q.x + 0.9 * t));
  float bright = 1.0 - min(abs(sin(1.3 * q.x)), abs(sin(1.3 * q.y + 0.6 * q.x)));
  bright *= bright;
  return bright * bright * bright;
}
#endif
void main() {
  vec3 own = albedo();
  #ifdef GROUND
    float depth_m = water.y > 0.5 ? water.x - vWorld.z : 0.0;
    if (depth_m > 0.0) own = tinted(own, depth_m);
  #endif
  vec3 toEye = normalize(cameraPosition - vWorld);
  vec3 normal = normalize(vNormalW);
  if (dot(normal, toEye) < 0.0) normal = -normal;
  vec3 light = own * (skyStrength * (0.45 + 0.275 * (1.0 + normal.z)));
  float toward = dot(normal, toSun);
  if (toSun.z > 0.0 && toward > 0.0) {
    float lit = getShadowMask();
    light += lit * own * sunColor * toward;
    if (gloss > 0.0) light += lit * sunColor * gloss * raisedTo64(max(0.0, dot(normal, normalize(toSun + toEye))));
  }
  #ifdef GROUND
    // Only where the waves are near, and where a pixel is finer than the pattern.
    float sharp = 1.0 - smoothstep(0.05, 0.3, max(fwidth(vWorld.x), fwidth(vWorld.y)));
    float bundled = toward > 0.0 && depth_m > 0.0 && depth_m < 25.0 ? sharp * exp(-depth_m / 7.0) : 0.0;
    if (bundled > 0.02) light += own * sunColor * toward * bundled * (1.1 * caustics(vWorld.xy, seconds) - 0.2);
  #endif
  #ifdef GRID
    // The infinite plane ends in the colors of the horizon.
    float far = distance(cameraPosition, vWorld) / haze_m;
    light = mix(light, airColor(normalize(vec3(-toEye.xy, max(-toEye.z, 0.0)))), smoothstep(0.15, 1.0, far));
  #endif
  gl_FragColor = vec4(throughWater(light, vWorld), opacity);
  #include <colorspace_fragment>
}`;

/** Returns the default color of a part without its own color and without one of its material. */
export function defaultColor(body, part, group) {
  if (!body.fixed) return GROUP_COLORS[group % GROUP_COLORS.length];
  return part.shape === 'plane' ? PLANE_COLOR : FIXED_COLOR;
}

/** Materials of surfaces, one for each kind of pattern. */
export class Surfaces {
  constructor(assets) {
    this.assets = assets;
    this.contour_m = {value: 1};
    this.wire = false;  // only edges, but for planes
    this.clear();
  }

  /** Forgets all materials: another scene. */
  clear() {
    for (const material of this.materials?.values() ?? []) material.dispose();
    this.materials = new Map();
  }

  /** Returns a name of the look of a part: parts with the same name share a material. */
  static key(part) {
    const texture = part.color ? null : part.material.texture;
    return JSON.stringify([texture ?? 0, part.material.gloss ?? 0]);
  }

  /** Returns the material of a part. */
  get(part, {contours = false} = {}) {
    const texture = part.color ? null : part.material.texture ?? null;
    const plane = part.shape === 'plane';
    const wireframe = this.wire && !plane;
    const key = [Surfaces.key(part), plane, contours, wireframe].join();
    const known = this.materials.get(key);
    if (known) return known;
    // Choose the code of the shader by the pattern.
    const defines = {};
    if (texture)
      defines[texture.pattern.toUpperCase()] = 1;
    else if (plane)
      defines.GRID = 1;
    if (contours && !texture) defines.CONTOUR = 1;
    if (plane || contours) defines.GROUND = 1;
    const material = new ShaderMaterial({
      defines,
      lights: true,
      side: DoubleSide,
      wireframe,
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      uniforms: {
        ...UniformsUtils.merge([UniformsLib.lights]),
        ...env,
        color0: {value: new Color(texture?.colors?.[0] ?? '#ffffff')},
        color1: {value: new Color(texture?.colors?.[1] ?? '#202020')},
        textureSize_m: {value: texture?.size_m ?? 1},
        gloss: {value: part.material.gloss ?? 0},
        opacity: {value: 1},
        contour_m: this.contour_m,
        image: {value: null},
        offset: {value: new Vector3()},
      },
    });
    if (texture?.pattern === 'image') this.loadImage(texture.asset, material);
    this.materials.set(key, material);
    return material;
  }

  async loadImage(hash, material) {
    const bitmap = await this.assets.image(hash);
    if (!bitmap) return;
    const image = new Texture(bitmap);
    image.wrapS = image.wrapT = RepeatWrapping;
    image.colorSpace = SRGBColorSpace;
    image.flipY = false;  // the bitmap is made upside down already
    image.minFilter = LinearMipmapLinearFilter;
    image.magFilter = LinearFilter;
    image.anisotropy = 4;
    image.needsUpdate = true;
    material.uniforms.image.value = image;
    this.assets.changed();
  }
}
