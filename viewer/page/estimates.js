// SPDX-License-Identifier: BSD-3-Clause
// Estimates of vehicles beside the truth: a ghost, ellipsoids of 1, 2 and 3 standard deviations, a line of the error.
import {ghostOf, matrixOf} from './bodies.js';
import {ESTIMATE_COLOR} from './palette.js';
import {
  BufferAttribute,
  BufferGeometry,
  DoubleSide,
  DynamicDrawUsage,
  Group,
  InstancedMesh,
  LineBasicMaterial,
  LineSegments,
  Matrix4,
  ShaderMaterial,
  SphereGeometry,
  Vector3,
} from './vendor/three.js';

const GHOSTS_MAX = 60;
const AXIS_MIN_M = 1e-3;

const VERTEX = /* glsl */ `
varying vec3 vNormal, vWorld;
void main() {
  vec4 world = modelMatrix * vec4(position, 1.0);
  vNormal = mat3(modelMatrix) * normal;
  #ifdef USE_INSTANCING
    world = instanceMatrix * vec4(position, 1.0);
    // Inverse transpose, up to a factor, for the normals of a scaled sphere.
    mat3 m = mat3(instanceMatrix);
    vNormal = mat3(cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])) * normal;
  #endif
  vWorld = world.xyz;
  gl_Position = projectionMatrix * viewMatrix * world;
}`;
const FRAGMENT = /* glsl */ `
uniform vec3 color;
uniform float opacity, rimPower;
varying vec3 vNormal, vWorld;
void main() {
  float rim = 1.0 - abs(dot(normalize(vNormal), normalize(cameraPosition - vWorld)));
  gl_FragColor = vec4(color, opacity * (0.22 + 0.78 * pow(rim, rimPower)));
  #include <colorspace_fragment>
}`;

function glass(color, opacity, rimPower) {
  return new ShaderMaterial({
    uniforms: {color: {value: new Vector3(...color)}, opacity: {value: opacity}, rimPower: {value: rimPower}},
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    transparent: true,
    depthWrite: false,
    side: DoubleSide,
  });
}

/** Returns eigenvalues and eigenvectors (columns) of a symmetric matrix, given row by row (Jacobi's method). */
export function eigen(covariance) {
  const a = [covariance.slice(0, 3), covariance.slice(3, 6), covariance.slice(6, 9)];
  const v = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
  for (let sweep = 0; sweep < 30; ++sweep) {
    const off = Math.abs(a[0][1]) + Math.abs(a[0][2]) + Math.abs(a[1][2]);
    if (off < 1e-15 * (Math.abs(a[0][0]) + Math.abs(a[1][1]) + Math.abs(a[2][2]) + 1e-300)) break;
    for (const [p, q] of [[0, 1], [0, 2], [1, 2]]) {
      if (a[p][q] === 0) continue;
      // Rotation in the plane p, q that makes a[p][q] zero.
      const theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
      const t = (theta >= 0 ? 1 : -1) / (Math.abs(theta) + Math.sqrt(theta * theta + 1));
      const c = 1 / Math.sqrt(t * t + 1), s = t * c;
      for (let k = 0; k < 3; ++k) [a[k][p], a[k][q]] = [c * a[k][p] - s * a[k][q], s * a[k][p] + c * a[k][q]];
      for (let k = 0; k < 3; ++k) [a[p][k], a[q][k]] = [c * a[p][k] - s * a[q][k], s * a[p][k] + c * a[q][k]];
      for (let k = 0; k < 3; ++k) [v[k][p], v[k][q]] = [c * v[k][p] - s * v[k][q], s * v[k][p] + c * v[k][q]];
    }
  }
  return {values: [a[0][0], a[1][1], a[2][2]].map((x) => Math.max(0, x)), vectors: v};
}

/** The newest estimate of each vehicle, drawn. */
export class Estimates {
  constructor(scene, assets) {
    this.assets = assets;
    this.root = new Group();
    scene.add(this.root);
    this.ghostMaterial = glass([0.95, 0.88, 0.3], 0.75, 1.5);
    this.clouds = [[1, 0.30], [2, 0.20], [3, 0.13]].map(([sigmas, opacity]) => {
      const mesh = new InstancedMesh(new SphereGeometry(1, 40, 24), glass([0.9, 0.8, 0.12], opacity, 2.5), 1);
      return {sigmas, opacity, mesh};
    });
    this.line =
        new LineSegments(new BufferGeometry(), new LineBasicMaterial({color: ESTIMATE_COLOR, depthTest: false}));
    this.line.frustumCulled = false;
    this.line.renderOrder = 31;
    this.showGhosts = this.showEllipsoids = true;
    this.vehicles = [];
  }

  choose(get) {
    this.showGhosts = get('ghosts');
    this.showEllipsoids = get('ellipsoids');
  }

  /** Takes the vehicles of a scene; forgets all estimates. */
  setScene(data) {
    this.root.clear();
    this.origin = new Vector3(...data.origin_m);
    this.byName = new Map(data.vehicles.map((vehicle, i) => [vehicle.name, i]));
    this.vehicles = data.vehicles.map((vehicle) => ({
                                        name: vehicle.name,
                                        body: data.bodies[vehicle.body],
                                        X_VB: matrixOf(vehicle.pose).invert(),
                                        estimate: null,
                                        ghost: null,
                                        axes: null,
                                      }));
    // Room for an ellipsoid of each size, and a line, for each vehicle.
    for (const cloud of this.clouds) {
      cloud.mesh.dispose();
      cloud.mesh = new InstancedMesh(cloud.mesh.geometry, cloud.mesh.material, Math.max(1, this.vehicles.length));
      cloud.mesh.instanceMatrix.setUsage(DynamicDrawUsage);
      cloud.mesh.frustumCulled = false;
      cloud.mesh.renderOrder = 30 - cloud.sigmas;
      cloud.mesh.count = 0;
      this.root.add(cloud.mesh);
    }
    this.line.geometry.dispose();
    this.line.geometry = new BufferGeometry();
    this.line.geometry.setAttribute('position', new BufferAttribute(new Float32Array(6 * this.vehicles.length), 3));
    this.line.geometry.setDrawRange(0, 0);
    this.root.add(this.line);
  }

  /** Takes new estimates. */
  add(items) {
    for (const item of items) {
      const vehicle = this.vehicles[this.byName?.get(item.vehicle)];
      if (!vehicle || !Array.isArray(item.pose) || item.pose.length !== 7 || !item.pose.every(Number.isFinite))
        continue;
      vehicle.estimate = item;
      vehicle.truth = null;
      vehicle.X_WV = matrixOf(item.pose);
      const e = vehicle.X_WV.elements;
      e[12] -= this.origin.x, e[13] -= this.origin.y, e[14] -= this.origin.z;
      vehicle.axes = null;
      const covariance = item.covariance_m2;
      if (Array.isArray(covariance) && covariance.length === 9 && covariance.every(Number.isFinite)) {
        const {values, vectors} = eigen(covariance);
        vehicle.axes = {lengths_m: values.map(Math.sqrt), vectors};
      }
      if (!vehicle.ghost && this.root.children.length < GHOSTS_MAX) {
        vehicle.ghost = ghostOf(vehicle.body, this.assets, this.ghostMaterial);
        vehicle.ghost.renderOrder = 25;
        this.root.add(vehicle.ghost);
      }
    }
  }

  /** Takes the estimates of a time in place of all. */
  replace(items) {
    this.rewind(-Infinity);
    this.add(items);
  }

  /** Drops estimates later than a time: the run went back. */
  rewind(time_us) {
    for (const vehicle of this.vehicles)
      if (vehicle.estimate?.time_us > time_us) {
        vehicle.estimate = vehicle.axes = null;
        if (vehicle.ghost) vehicle.ghost.visible = false;
      }
  }

  update({X_WVs, truthAt}) { this.place(X_WVs, truthAt); }

  /** Draws the estimates beside the true poses; truthAt(i, time_us) is the place of a vehicle then, null: unknown. */
  place(X_WVs, truthAt) {
    const lines = this.line.geometry.attributes.position;
    const matrix = new Matrix4();
    let ellipsoids = 0, count = 0;
    this.vehicles.forEach((vehicle, i) => {
      if (vehicle.ghost) vehicle.ghost.visible = this.showGhosts && vehicle.estimate !== null;
      if (!vehicle.estimate) return;
      const at = new Vector3().setFromMatrixPosition(vehicle.X_WV);
      // The error is that at the time of the estimate: the vehicle has moved on since.
      vehicle.truth ??= truthAt(i, vehicle.estimate.time_us);
      const truth = vehicle.truth ?? new Vector3().setFromMatrixPosition(X_WVs[i]);
      vehicle.error_m = at.distanceTo(truth);
      if (vehicle.ghost) vehicle.ghost.matrix.multiplyMatrices(vehicle.X_WV, vehicle.X_VB);
      if (this.showGhosts) {
        lines.setXYZ(count++, truth.x, truth.y, truth.z);
        lines.setXYZ(count++, at.x, at.y, at.z);
      }
      if (!vehicle.axes || !this.showEllipsoids) return;
      const {lengths_m, vectors} = vehicle.axes;
      for (const {sigmas, mesh} of this.clouds) {
        const [a, b, c] = lengths_m.map((length_m) => Math.max(AXIS_MIN_M, sigmas * length_m));
        matrix.set(
            vectors[0][0] * a, vectors[0][1] * b, vectors[0][2] * c, at.x, vectors[1][0] * a, vectors[1][1] * b,
            vectors[1][2] * c, at.y, vectors[2][0] * a, vectors[2][1] * b, vectors[2][2] * c, at.z, 0, 0, 0, 1);
        mesh.setMatrixAt(ellipsoids, matrix);
      }
      ++ellipsoids;
    });
    for (const {mesh} of this.clouds) {
      mesh.count = ellipsoids;
      mesh.visible = ellipsoids > 0;
      if (mesh.visible) mesh.instanceMatrix.needsUpdate = true;
    }
    this.line.visible = count > 0;
    this.line.geometry.setDrawRange(0, count);
    if (this.line.visible) lines.needsUpdate = true;
  }
}
