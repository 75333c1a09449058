// SPDX-License-Identifier: BSD-3-Clause
// Which body each pixel shows, for tests that compare the page with `shoal snap`.
import {DoubleSide, InstancedBufferAttribute, ShaderMaterial, Vector3, WebGLRenderTarget} from './vendor/three.js';

const VERTEX = /* glsl */ `
varying vec3 vId, vEye;
void main() {
  vId = instanceColor;
  vec4 eye = viewMatrix * modelMatrix * instanceMatrix * vec4(position, 1.0);
  vEye = eye.xyz;
  gl_Position = projectionMatrix * eye;
}`;
const FRAGMENT = /* glsl */ `
varying vec3 vId, vEye;
void main() {
  if (length(vEye) > 10000.0) discard;  // the far plane of the renderer
  gl_FragColor = vec4(vId, 1.0);
}`;

/** Colors of the instances of a mesh that say the number of their body, from 1. */
function idsOf(bodies) {
  const colors = new Float32Array(3 * bodies.length);
  bodies.forEach((body, i) => {
    const id = body + 1;
    colors.set([(id & 255) / 255, ((id >> 8) & 255) / 255, ((id >> 16) & 255) / 255], 3 * i);
  });
  return new InstancedBufferAttribute(colors, 3);
}

/**
 * Number of the body at each pixel, from 1 and row by row from the top; 0: none.  It is seen from `eye` to `look` in
 * the world; fov_deg: horizontal.
 */
export async function bodyMask(app, {eye, look, fov_deg, width, height}) {
  // Meshes may still be on their way; bodies take them when they are there.
  await Promise.all(app.assets.geometries.values());
  await new Promise((done) => setTimeout(done));
  const origin = app.data.origin_m;
  app.setView(`orbit,${eye.map((x, i) => x - origin[i]).join()},${look.map((x, i) => x - origin[i]).join()}`);
  const camera = app.camera.clone();
  camera.aspect = width / height;
  camera.fov = 2 * Math.atan(Math.tan(fov_deg * Math.PI / 360) / camera.aspect) * 180 / Math.PI;
  camera.updateProjectionMatrix();
  app.bodies.follow(camera, camera.position.distanceTo(app.cameras.focus));
  // The same meshes with another material; everything else is hidden.
  const material = new ShaderMaterial({
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    side: DoubleSide,
    uniforms: {offset: {value: new Vector3()}},  // which the planes set
  });
  const meshes = app.bodies.pickable, kept = [];
  for (const mesh of meshes) {
    kept.push([mesh.material, mesh.instanceColor]);
    mesh.material = material;
    mesh.instanceColor = idsOf(mesh.userData.bodies);
  }
  const shown = app.scene.children.filter((child) => child.visible);
  for (const child of shown) child.visible = meshes.includes(child) || child === app.bodies.root;
  const target = new WebGLRenderTarget(width, height, {samples: 0});
  const bytes = new Uint8Array(4 * width * height);
  const shadows = app.renderer.shadowMap.autoUpdate;
  app.renderer.shadowMap.autoUpdate = false;
  app.renderer.setClearColor(0x000000, 0);
  app.renderer.setRenderTarget(target);
  app.renderer.clear();
  app.renderer.render(app.scene, camera);
  app.renderer.readRenderTargetPixels(target, 0, 0, width, height, bytes);
  app.renderer.setRenderTarget(null);
  app.renderer.shadowMap.autoUpdate = shadows;
  // Restore the previous state.
  meshes.forEach((mesh, i) => {
    [mesh.material, mesh.instanceColor] = kept[i];
  });
  for (const child of shown) child.visible = true;
  target.dispose();
  material.dispose();
  app.dirty = true;
  // WebGL has the last row first.
  const ids = [];
  for (let row = height - 1; row >= 0; --row)
    for (let at = 4 * row * width; at < 4 * (row + 1) * width; at += 4)
      ids.push(bytes[at] + 256 * bytes[at + 1] + 65536 * bytes[at + 2]);
  return ids;
}
