// SPDX-License-Identifier: BSD-3-Clause
// The bodies of the scene: parts of the same shape and look are instances of one mesh.
import {defaultColor, Surfaces} from './materials.js';
import {radialGrid, roundUp, simpleShape} from './shapes.js';
import {
  Box3,
  Color,
  DynamicDrawUsage,
  Group,
  InstancedMesh,
  Matrix4,
  Mesh,
  Quaternion,
  Vector3,
} from './vendor/three.js';

const ONE = new Vector3(1, 1, 1);
const PLANE_REACH_M = 30000;
const COLLISION_COLORS = {
  movable: '#4fb477',
  fixed: '#8b97a3'
};

/** Returns the matrix of a pose [x, y, z, qw, qx, qy, qz]. */
export function matrixOf(pose, scale = ONE) {
  return new Matrix4().compose(
      new Vector3(pose[0], pose[1], pose[2]), new Quaternion(pose[4], pose[5], pose[6], pose[3]), scale);
}

/** All bodies of a scene, drawn; X_WB has the matrix of each body by its number. */
export class Bodies {
  constructor(scene, assets) {
    this.surfaces = new Surfaces(assets);
    this.assets = assets;
    this.root = new Group();
    scene.add(this.root);
    this.shapes = 'drawn';
    this.painted = new Map();
    this.onShape = () => {};  // a mesh or terrain has come
    this.clear();
  }

  /** Removes all bodies. */
  clear() {
    this.removeMeshes();
    this.list = [];
    this.X_WB = [];
    this.boxes = new Map();
  }

  removeMeshes() {
    this.root.traverse((object) => object.dispose?.());
    this.root.clear();
    this.surfaces.clear();
    this.groups = [];
    this.planes = [];
  }

  /** What is drawn: 'drawn', the shapes with their looks; 'collision', those that collide; 'wire', their edges. */
  setShapes(shapes) {
    if (shapes === this.shapes) return;
    this.shapes = shapes;
    this.surfaces.wire = shapes === 'wire';
    this.removeMeshes();
    this.gather();
    this.update(null);
  }

  /** Parts of a body as they are drawn. */
  partsOf(body) {
    if (this.shapes !== 'collision') return body.parts;
    const color = body.fixed ? COLLISION_COLORS.fixed : COLLISION_COLORS.movable;
    return body.parts.filter((part) => part.collides !== false)
        .map((part) => (part.shape === 'plane' ? part : {...part, color}));
  }

  /** Builds the bodies of a checked scene. */
  setScene(data) {
    this.clear();
    this.list = data.bodies;
    this.origin = new Vector3(...data.origin_m);
    // Vehicles differ in their default color.
    const owners = new Map();
    this.groupOf = data.bodies.map((body) => {
      if (!owners.has(body.owner)) owners.set(body.owner, owners.size);
      return owners.get(body.owner);
    });
    this.movable = data.bodies.filter((body) => !body.fixed).map((body) => body.index);
    this.X_WB = data.bodies.map((body) => this.relative(matrixOf(body.pose)));
    this.gather();
    this.update(null);
  }

  relative(X_W) {
    X_W.elements[12] -= this.origin.x, X_W.elements[13] -= this.origin.y, X_W.elements[14] -= this.origin.z;
    return X_W;
  }

  /** Sorts the parts into groups of instances, and loads the shapes that come as assets. */
  gather() {
    const groups = new Map();
    for (const body of this.list)
      for (const [number, part] of this.partsOf(body).entries()) {
        if (part.shape === 'plane') this.addPlane(body, part);
        const shape = ['mesh', 'terrain'].includes(part.shape) ? {key: part.asset, scale: [1, 1, 1]} :
            part.shape === 'plane'                             ? null :
                                                                 simpleShape(part, this.list.length > 60);
        if (!shape) continue;
        const key = `${shape.key} ${Surfaces.key(part)} ${body.fixed}`;
        if (!groups.has(key)) groups.set(key, {part, fixed: body.fixed, geometry: shape.geometry, instances: []});
        const X_BP = matrixOf(part.pose, new Vector3(...shape.scale));
        const name = `${body.name}/${part.name || number + 1}`;
        groups.get(key).instances.push({body: body.index, X_BP, name, color: this.colorOf(body, part)});
      }
    for (const group of groups.values())
      if (group.geometry)
        this.addGroup(group);
      else
        this.loadGroup(group, this.groups);
  }

  colorOf(body, part) {
    const color = part.color || part.material.color || defaultColor(body, part, this.groupOf[body.index]);
    return new Color(color);
  }

  async loadGroup(group, groups) {
    const geometry = await this.assets.geometry(group.part.asset);
    if (!geometry || groups !== this.groups) return;  // another scene, or other shapes
    group.geometry = geometry;
    geometry.computeBoundingBox();
    this.boxes.set(group.part.asset, geometry.boundingBox);
    this.onShape();
    this.addGroup(group);
    this.assets.changed();
  }

  addGroup(group) {
    const contours = group.part.shape === 'terrain';
    const mesh = new InstancedMesh(group.geometry, this.surfaces.get(group.part, {contours}), group.instances.length);
    mesh.instanceMatrix.setUsage(DynamicDrawUsage);
    this.paintGroup(mesh, group.instances);
    mesh.frustumCulled = false;
    mesh.castShadow = this.shapes !== 'wire';
    mesh.receiveShadow = true;
    mesh.matrixAutoUpdate = false;
    mesh.userData.bodies = group.instances.map((instance) => instance.body);
    group.mesh = mesh;
    this.root.add(mesh);
    this.groups.push(group);
    this.place(group);
  }

  paintGroup(mesh, instances) {
    const color = new Color();
    instances.forEach(({name, color: own}, i) => {
      const painted = this.shapes === 'collision' ? undefined : this.painted.get(name);
      mesh.setColorAt(i, painted === undefined ? own : color.setHex(painted));
    });
    mesh.instanceColor.needsUpdate = true;
  }

  /** Sets the colors, 0xrrggbb, of some parts by name, in place of all that were set before. */
  paint(colors) {
    const names = new Set([...colors.keys(), ...this.painted.keys()]);
    this.painted = new Map(colors);
    for (const {mesh, instances} of this.groups)
      if (instances.some(({name}) => names.has(name))) this.paintGroup(mesh, instances);
  }

  /** Present color of a part by its name, 0xrrggbb; null: it is not drawn. */
  presentColor(name) {
    for (const {mesh, instances} of this.groups) {
      const i = instances.findIndex((instance) => instance.name === name), color = new Color();
      if (i < 0) continue;
      mesh.getColorAt(i, color);
      return color.getHex();
    }
    return null;
  }

  addPlane(body, part) {
    const mesh = new InstancedMesh(radialGrid(40, 64, 0.5, PLANE_REACH_M), this.surfaces.get(part), 1);
    mesh.setColorAt(0, this.colorOf(body, part));
    mesh.frustumCulled = false;
    mesh.receiveShadow = true;
    mesh.userData = {bodies: [body.index], offset: new Vector3()};
    mesh.onBeforeRender = () => {
      mesh.material.uniforms.offset.value.copy(mesh.userData.offset);
      mesh.material.uniformsNeedUpdate = true;
    };
    this.planes.push({mesh, body: body.index, X_BP: matrixOf(part.pose)});
    this.root.add(mesh);
  }

  /** Sets the matrices of the movable bodies from poses x, y, z, qx, qy, qz, qw; null: only redraws. */
  update(poses) {
    if (poses) {
      const count = Math.min(this.movable.length, poses.length / 7);
      for (let i = 0; i < count; ++i) setMatrix(this.X_WB[this.movable[i]].elements, poses, 7 * i);
    }
    for (const group of this.groups)
      if (!group.fixed || !poses) this.place(group);
  }

  place(group) {
    const to = group.mesh.instanceMatrix.array;
    for (let i = 0; i < group.instances.length; ++i) {
      const {body, X_BP} = group.instances[i];
      multiplyAffine(this.X_WB[body].elements, X_BP.elements, to, 16 * i);
    }
    group.mesh.instanceMatrix.needsUpdate = true;
    group.mesh.boundingSphere = null;
  }

  /** Keeps the infinite planes under the camera, and contour lines apart for a view from some distance. */
  follow(camera, distance_m) {
    this.surfaces.contour_m.value = roundUp(Math.max(0.05, 0.03 * distance_m));
    for (const {mesh, body, X_BP} of this.planes) {
      const X_WP = this.X_WB[body].clone().multiply(X_BP);
      const at = camera.position.clone().applyMatrix4(X_WP.clone().invert());
      mesh.userData.offset.set(Math.round(at.x), Math.round(at.y), 0);
      const {x, y} = mesh.userData.offset;
      mesh.setMatrixAt(0, X_WP.multiply(new Matrix4().makeTranslation(x, y, 0)));
      mesh.instanceMatrix.needsUpdate = true;
      mesh.boundingSphere = null;
    }
  }

  /** Returns the box around movable bodies, or around all if none moves, without planes. */
  boundingBox() {
    const box = new Box3(), moving = this.list.filter((body) => !body.fixed);
    for (const body of moving.length ? moving : this.list)
      for (const part of body.parts) {
        const own = this.boxOf(part), X_WP = this.X_WB[body.index].clone().multiply(matrixOf(part.pose));
        if (!own) continue;
        // A sphere does not grow when it turns.
        box.union(own.applyMatrix4(part.shape === 'sphere' ? new Matrix4().copyPosition(X_WP) : X_WP));
      }
    return box.isEmpty() ? new Box3(new Vector3(-5, -5, 0), new Vector3(5, 5, 5)) : box;
  }

  /** Box around a part in its frame; of a mesh that is still on its way 1 m about its origin, null: it has none. */
  boxOf(part) {
    if (part.shape === 'plane') return null;
    if (part.shape === 'terrain') return this.boxes.get(part.asset)?.clone() ?? null;
    if (part.shape === 'mesh' && this.boxes.has(part.asset)) return this.boxes.get(part.asset).clone();
    const cap_m = part.shape === 'capsule' ? part.radius_m : 0, r_m = part.radius_m;
    const half_m = {
      box: part.size_m?.map((size) => size / 2),
      sphere: [r_m, r_m, r_m],
      mesh: [1, 1, 1],
    }[part.shape] ??
        [r_m, r_m, part.length_m / 2 + cap_m];
    const half = new Vector3(...half_m);
    return new Box3(half.clone().negate(), half);
  }

  /** Height of the ground, of planes and terrains, at a place; -Infinity: there is none. */
  groundAt(x, y) {
    const heights = this.planes.map(({body, X_BP}) => planeHeight(this.X_WB[body].clone().multiply(X_BP), x, y));
    for (const {geometry, instances} of this.groups)
      if (geometry.userData.heightAt)
        for (const {body, X_BP} of instances) {
          const X_WP = this.X_WB[body].clone().multiply(X_BP);
          const at = new Vector3(x, y, 0).applyMatrix4(X_WP.clone().invert());
          heights.push(at.setZ(geometry.userData.heightAt(at.x, at.y)).applyMatrix4(X_WP).z);
        }
    return Math.max(-Infinity, ...heights.filter(Number.isFinite));
  }

  /** Returns objects for rays of the mouse. */
  get pickable() { return [...this.groups.map((group) => group.mesh), ...this.planes.map((plane) => plane.mesh)]; }
}

/** Height of a plane at a place; -Infinity: it is steeper than ground is. */
function planeHeight(X_WP, x, y) {
  const [nx, ny, nz] = X_WP.elements.slice(8, 11), [px, py, pz] = X_WP.elements.slice(12, 15);
  return nz > 0.5 ? pz - (nx * (x - px) + ny * (y - py)) / nz : -Infinity;
}

/** Radius of the sphere around the origin of a body that contains its parts; 1 m for meshes. */
export function radiusOf(body) {
  let radius_m = 0.05;
  for (const part of body.parts) {
    if (part.shape === 'plane' || part.shape === 'terrain') continue;
    const own_m = part.shape === 'box' ? 0.5 * Math.hypot(...part.size_m) :
        part.shape === 'mesh'          ? 1 :
                                         part.radius_m + 0.5 * (part.length_m ?? 0);
    radius_m = Math.max(radius_m, Math.hypot(part.pose[0], part.pose[1], part.pose[2]) + own_m);
  }
  return radius_m;
}

/** Writes the matrix of the pose at poses[at] into 16 elements. */
function setMatrix(to, poses, at) {
  const x = poses[at + 3], y = poses[at + 4], z = poses[at + 5], w = poses[at + 6];
  to[0] = 1 - 2 * (y * y + z * z), to[1] = 2 * (x * y + w * z), to[2] = 2 * (x * z - w * y);
  to[4] = 2 * (x * y - w * z), to[5] = 1 - 2 * (x * x + z * z), to[6] = 2 * (y * z + w * x);
  to[8] = 2 * (x * z + w * y), to[9] = 2 * (y * z - w * x), to[10] = 1 - 2 * (x * x + y * y);
  to[12] = poses[at], to[13] = poses[at + 1], to[14] = poses[at + 2];
}

/** Multiplies two affine matrices into to[at], ... */
function multiplyAffine(a, b, to, at) {
  for (let column = 0; column < 16; column += 4) {
    const x = b[column], y = b[column + 1], z = b[column + 2], w = column === 12 ? 1 : 0;
    to[at + column] = a[0] * x + a[4] * y + a[8] * z + a[12] * w;
    to[at + column + 1] = a[1] * x + a[5] * y + a[9] * z + a[13] * w;
    to[at + column + 2] = a[2] * x + a[6] * y + a[10] * z + a[14] * w;
    to[at + column + 3] = w;
  }
}

/** Returns transparent copies of the parts of a body: a mesh for each, in the frame of the body. */
export function ghostOf(body, assets, material) {
  const ghost = new Group();
  for (const part of body.parts) {
    if (part.shape === 'plane' || part.shape === 'terrain') continue;
    const add = (geometry, scale) => {
      const mesh = new Mesh(geometry, material);
      mesh.matrixAutoUpdate = false;
      mesh.matrix.copy(matrixOf(part.pose, new Vector3(...scale)));
      ghost.add(mesh);
    };
    if (part.shape === 'mesh')
      assets.geometry(part.asset).then((geometry) => geometry && add(geometry, [1, 1, 1]));
    else
      add(simpleShape(part).geometry, simpleShape(part).scale);
  }
  ghost.matrixAutoUpdate = false;
  return ghost;
}
