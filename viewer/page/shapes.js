// SPDX-License-Identifier: BSD-3-Clause
// Geometries of parts, and the assets (meshes, height grids, images) that the server sends for them.
import {
  BoxGeometry,
  BufferAttribute,
  BufferGeometry,
  CapsuleGeometry,
  CylinderGeometry,
  SphereGeometry,
} from './vendor/three.js';

/** Samples of a height grid drawn along one side; finer grids are thinned out. */
const GRID_MAX = 1025;
const ASSET_MAX_BYTES = 256 << 20;

/** Error of an asset that is cut off or of an unknown kind. */
export class AssetError extends Error {}

function readMesh(view) {
  const vertices = view.getUint32(4, true), triangles = view.getUint32(8, true);
  if (view.byteLength !== 12 + 12 * (vertices + triangles)) throw new AssetError('mesh: wrong length');
  const points = new Float32Array(view.buffer, 12, 3 * vertices);
  const corners = new Uint32Array(view.buffer, 12 + 12 * vertices, 3 * triangles);
  if (corners.some((corner) => corner >= vertices)) throw new AssetError('mesh: a corner beyond its vertices');
  if (points.some((value) => !(Math.abs(value) < 1e9)))
    throw new AssetError('mesh: a vertex that is not finite, or too far');
  // Every face has its own normal, as in the renderer.
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(points.slice(), 3));
  geometry.setIndex(new BufferAttribute(corners.slice(), 1));
  const faces = geometry.toNonIndexed();
  faces.computeVertexNormals();
  return faces;
}

function readHeights(view) {
  const columns = view.getUint32(4, true), rows = view.getUint32(8, true);
  if (view.byteLength !== 28 + 4 * columns * rows || columns < 2 || rows < 2)
    throw new AssetError('height grid: wrong length');
  const [x0, y0, dx, dy] = [12, 16, 20, 24].map((at) => view.getFloat32(at, true));
  const heights = new Float32Array(view.buffer, 28, columns * rows);
  // Thin out, but keep the last row and column.
  const every = Math.ceil(Math.max(columns, rows) / GRID_MAX);
  const pick = (count) => {
    const picked = [];
    for (let i = 0; i < count - 1; i += every) picked.push(i);
    picked.push(count - 1);
    return picked;
  };
  const is = pick(columns), js = pick(rows);
  const points = new Float32Array(3 * is.length * js.length);
  const corners = new Uint32Array(6 * (is.length - 1) * (js.length - 1));
  let at = 0;
  for (const j of js)
    for (const i of is) {
      points[at++] = x0 + i * dx;
      points[at++] = y0 + j * dy;
      points[at++] = heights[j * columns + i];
    }
  at = 0;
  for (let j = 0; j + 1 < js.length; ++j)
    for (let i = 0; i + 1 < is.length; ++i) {
      const a = j * is.length + i, b = a + is.length;
      corners.set([a, a + 1, b + 1, a, b + 1, b], at);
      at += 6;
    }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(points, 3));
  geometry.setIndex(new BufferAttribute(corners, 1));
  geometry.computeVertexNormals();
  // Height at a place of the part, between the samples; NaN: outside.
  geometry.userData.heightAt = (x, y) => {
    const u = (x - x0) / dx, v = (y - y0) / dy;
    if (!(u >= 0 && v >= 0 && u <= columns - 1 && v <= rows - 1)) return NaN;
    const i = Math.min(columns - 2, Math.floor(u)), j = Math.min(rows - 2, Math.floor(v));
    const at = (k, l) => heights[(j + l) * columns + i + k], east = u - i, north = v - j;
    const low = at(0, 0) + east * (at(1, 0) - at(0, 0)), high = at(0, 1) + east * (at(1, 1) - at(0, 1));
    return low + north * (high - low);
  };
  return geometry;
}

/** Assets of the server, or of source(hash) where it is set, each fetched once. */
export class Assets {
  constructor(base, problem, changed) {
    this.base = base;
    this.problem = problem;
    this.changed = changed;
    this.bytes = new Map();
    this.geometries = new Map();
  }

  fetch(hash) {
    if (!this.bytes.has(hash)) this.bytes.set(hash, this.load(hash));
    return this.bytes.get(hash);
  }

  async download(hash) {
    const response = await fetch(`${this.base}/${hash}`);
    if (!response.ok) throw new AssetError(`HTTP ${response.status}`);
    return response.arrayBuffer();
  }

  async load(hash) {
    try {
      const buffer = this.source ? this.source(hash) : await this.download(hash);
      if (!buffer) throw new AssetError('is missing');
      if (buffer.byteLength < 8 || buffer.byteLength > ASSET_MAX_BYTES) throw new AssetError('wrong length');
      return buffer;
    } catch (error) {
      this.bytes.delete(hash);  // another scene may try again
      this.problem(`asset ${hash}: ${error.message}`);
      return null;
    }
  }

  /** Returns the geometry of a mesh or height grid; null if it cannot be read. */
  geometry(hash) {
    if (!this.geometries.has(hash)) this.geometries.set(hash, this.makeGeometry(hash));
    return this.geometries.get(hash);
  }

  async makeGeometry(hash) {
    const buffer = await this.fetch(hash);
    if (!buffer) {
      this.geometries.delete(hash);
      return null;
    }
    try {
      const view = new DataView(buffer), kind = view.getUint32(0, true);
      if (kind === 1) return readMesh(view);
      if (kind === 2) return readHeights(view);
      throw new AssetError(`kind ${kind} has no shape`);
    } catch (error) {
      this.problem(`asset ${hash}: ${error.message}`);
      return null;
    }
  }

  /** Returns an image, upside down as textures are; null if it cannot be read. */
  async image(hash) {
    const buffer = await this.fetch(hash);
    if (!buffer) return null;
    try {
      const options = {imageOrientation: 'flipY', colorSpaceConversion: 'none'};
      return await createImageBitmap(new Blob([new Uint8Array(buffer, 4)]), options);
    } catch (error) {
      this.problem(`asset ${hash}: ${error.message}`);
      return null;
    }
  }

  /** Forgets what a scene does not name. */
  keep(hashes) {
    for (const map of [this.bytes, this.geometries])
      for (const hash of map.keys())
        if (!hashes.has(hash)) map.delete(hash);
  }
}

/** Rounds up to 1, 2 or 5 times a power of ten. */
export function roundUp(x) {
  const ten = Math.pow(10, Math.floor(Math.log10(x)));
  return ten * [1, 2, 5, 10].find((one) => one * ten >= x);
}

/** Returns a disc of triangles about the origin whose rings are close together near the center. */
export function radialGrid(rings, sectors, first_m, last_m) {
  const points = new Float32Array(3 * (1 + rings * sectors)), corners = [];
  const growth = Math.pow(last_m / first_m, 1 / (rings - 1));
  for (let ring = 0, at = 3; ring < rings; ++ring)
    for (let i = 0; i < sectors; ++i, at += 3) {
      const radius_m = first_m * Math.pow(growth, ring), angle = 2 * Math.PI * (i + 0.5 * (ring % 2)) / sectors;
      points[at] = radius_m * Math.cos(angle), points[at + 1] = radius_m * Math.sin(angle);
    }
  for (let i = 0; i < sectors; ++i) corners.push(0, 1 + i, 1 + (i + 1) % sectors);
  for (let ring = 0; ring + 1 < rings; ++ring)
    for (let i = 0; i < sectors; ++i) {
      const a = 1 + ring * sectors, b = a + sectors, next = (i + 1) % sectors;
      // Odd rings are turned by half a sector.
      if (ring % 2 === 0)
        corners.push(a + i, b + i, a + next, a + next, b + i, b + next);
      else
        corners.push(a + i, b + i, b + next, a + i, b + next, a + next);
    }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(points, 3));
  const normals = new Float32Array(points.length);
  for (let i = 2; i < normals.length; i += 3) normals[i] = 1;
  geometry.setAttribute('normal', new BufferAttribute(normals, 3));
  geometry.setIndex(corners);
  return geometry;
}

const geometries = new Map();

/** Returns the geometry of a simple part and the scale of an instance of it; `coarse`: with fewer faces. */
export function simpleShape(part, coarse = false) {
  const share = (name, make) => {
    const key = name + coarse;
    if (!geometries.has(key)) geometries.set(key, make(coarse ? 0.5 : 1));
    return geometries.get(key);
  };
  if (part.shape === 'box') return {key: 'box', geometry: share('box', () => new BoxGeometry()), scale: part.size_m};
  const r = part.radius_m, l = part.length_m;
  if (part.shape === 'sphere')
    return {key: 'sphere', geometry: share('sphere', (n) => new SphereGeometry(1, 40 * n, 24 * n)), scale: [r, r, r]};
  if (part.shape === 'cylinder') {
    const make = (n) => new CylinderGeometry(1, 1, 1, 48 * n).rotateX(Math.PI / 2);
    return {key: 'cylinder', geometry: share('cylinder', make), scale: [r, r, l]};
  }
  // The caps of a capsule would be squeezed by a scale.
  const key = `capsule ${r} ${l}`;
  return {
    key,
    geometry: share(key, (n) => new CapsuleGeometry(r, l, 12 * n, 32 * n).rotateX(Math.PI / 2)),
    scale: [1, 1, 1]
  };
}
