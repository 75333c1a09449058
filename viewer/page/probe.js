// SPDX-License-Identifier: BSD-3-Clause
// window.shoal.probe(): what the tests of the page read.
import {Vector3} from './vendor/three.js';

/** Numbers of what a page draws, for tests: positions in the world, pixels, sizes. */
export function probe(app) {
  const sorted = [...app.cpu_ms].sort((a, b) => a - b);
  const origin = new Vector3(...(app.data?.origin_m ?? [0, 0, 0]));
  const world = (point) => point.clone().add(origin).toArray();
  const place = new Vector3();
  return {
    frames: app.drawn,
    ticks: app.frames,
    cpu_ms: sorted[sorted.length >> 1] ?? null,
    software: app.software,
    draw_calls: app.renderer.info.render.calls,
    triangles: app.renderer.info.render.triangles,
    scene: app.data && {world: app.data.world, revision: app.data.revision},
    tape: app.picking.text(),
    placed: app.playback.version > 0,
    time_us: app.playback.time_us,
    epoch_us: app.timeBar.hello.epoch_us ?? 0,
    connected: app.connection.isOpen,
    banner: document.getElementById('banner').textContent,
    control: app.timeBar.hello.control === true,
    selected: app.selected,
    labels: app.labels.used.map((box) => box[3]),
    camera: {
      mode: app.cameras.mode,
      position: world(app.camera.position),
      target: world(app.cameras.focus),
      fov_deg: app.camera.fov,
    },
    bodies: app.bodies.X_WB.map((X, i) => ({
                                  name: app.bodies.list[i].name,
                                  position: world(place.setFromMatrixPosition(X)),
                                  pixel: app.labels.project(place, app.camera),
                                })),
    shapes: {
      which: app.bodies.shapes,
      parts: app.bodies.groups.reduce((sum, group) => sum + group.instances.length, 0),
      wire: app.bodies.groups.filter((group) => group.mesh.material.wireframe).length,
      groups: app.bodies.groups.length,
      planes: app.bodies.planes.filter(({mesh}) => !mesh.material.wireframe).length,
    },
    vehicles: app.vehicles.map((vehicle, i) => ({
                                 name: vehicle.name,
                                 position: world(vehicle.at),
                                 radius_m: vehicle.radius_m,
                                 pixel: app.pixelOf(vehicle),
                                 trail: app.trails.describe(i),
                               })),
    sides: app.sides.probe(world),
    past: app.past.shown,
    newest_us: app.newest_us,
    ghosts: app.ghosts.ghosts.filter((ghost) => ghost.root.visible)
                .map((ghost) => ({name: ghost.body.name, position: world(ghost.at)})),
    estimates: app.estimates.vehicles.filter((one) => one.estimate).map((one) => ({
                                                                          vehicle: one.name,
                                                                          error_m: one.error_m,
                                                                          axes_m: one.axes?.lengths_m ?? null,
                                                                          axes: one.axes?.vectors ?? null,
                                                                        })),
    ...app.ownLayers.probe(world),
    sounds: app.sounds.rings.map((ring) => ({
                                   id: ring.sound.id,
                                   outer_m: ring.outer_m,
                                   inner_m: ring.inner_m,
                                   slowness: ring.slowness,
                                   center: world(ring.sound.at),
                                 })),
    fittings: app.fittings.probe(world),
    depths: app.depths.probe(world),
    currents: app.currents.arrows.slice(0, 500),
    level_m: app.data?.water?.level_m ?? null,
    ...app.instruments.probe(),
    sound_lines: app.sounds.lines.map(
        ({from, to, left, mark}) => ({from: world(from), to: world(to), left, outcome: mark.outcome})),
    marks: (app.sounds.visibleMarks ?? []).map((mark) => ({outcome: mark.outcome, position: world(mark.at)})),
  };
}
