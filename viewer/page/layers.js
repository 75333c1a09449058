// SPDX-License-Identifier: BSD-3-Clause
// Everything that is drawn, and the switches for it.
import {Bodies} from './bodies.js';
import {Cameras} from './cameras.js';
import {CurrentArrows} from './currents.js';
import {Environment} from './environment.js';
import {Estimates} from './estimates.js';
import {Labels} from './labels.js';
import {Dots, FieldsOfView, SelectionRing, Zones} from './overlays.js';
import {isSoftware} from './resolution.js';
import {Assets} from './shapes.js';
import {Sounds} from './sounds.js';
import {Trails} from './trails.js';
import {NoToneMapping, PCFShadowMap, Scene, WebGLRenderer} from './vendor/three.js';
import {Water} from './water.js';

const TRAILS_MAX_S = 3600;

/** Makes the parts that draw.  `problem` is called with a text, `changed` when there is something new to draw. */
export function makeLayers(canvas, problem, changed) {
  const renderer = new WebGLRenderer({canvas, antialias: true, powerPreference: 'high-performance'});
  const software = isSoftware(renderer.getContext());
  renderer.toneMapping = NoToneMapping;
  renderer.shadowMap.enabled = true;
  renderer.shadowMap.type = PCFShadowMap;
  document.documentElement.classList.toggle('software', software);
  const scene = new Scene(), assets = new Assets('asset', problem, changed);
  const common = {
    environment: new Environment(scene),
    bodies: new Bodies(scene, assets),
    water: new Water(scene, software),
    zones: new Zones(scene),
  };
  return {
    renderer,
    software,
    scene,
    assets,
    ...common,
    shared: new Set(scene.children),  // what two branches have in common
    sounds: new Sounds(scene),
    estimates: new Estimates(scene, assets),
    otherEstimates: new Estimates(scene, assets),
    trails: new Trails(scene),
    estimateTrails: new Trails(scene),
    views: new FieldsOfView(scene),
    currents: new CurrentArrows(scene),
    dots: new Dots(scene),
    ring: new SelectionRing(scene),
    labels: new Labels(document.getElementById('labels')),
    cameras: new Cameras(canvas, (x, y) => common.bodies.groundAt(x, y)),
  };
}

/** Takes the switches under "Show". */
export function applyOptions(layers, options) {
  const get = (name) => options.get(name);
  layers.water.shown = get('water');
  layers.sounds.shown = get('sounds');
  for (const estimates of [layers.estimates, layers.otherEstimates]) {
    estimates.showGhosts = get('ghosts');
    estimates.showEllipsoids = get('ellipsoids');
  }
  if (layers.paths) layers.paths.root.visible = get('paths');
  layers.zones.root.visible = get('zones');
  layers.bodies.setShapes(get('shapes'));
  layers.currents.which = get('currents');
  layers.currents.depth_m = Math.max(0, Number(get('current-depth')) || 0);
  layers.views.which = get('sensors');
  const length_s = Math.min(TRAILS_MAX_S, Math.max(0, Number(get('trails')) || 0));
  layers.trails.length_s = layers.estimateTrails.length_s = length_s;
  layers.estimateTrails.lines.visible = get('ghosts');
  layers.environment.setClarity(Number(get('clarity')) >= 4 ? 0 : Number(get('clarity')) + 0.05);
}
