// SPDX-License-Identifier: BSD-3-Clause
// Everything that is drawn, and the switches for it.
import {Bodies} from './bodies.js';
import {Cameras} from './cameras.js';
import {CurrentArrows} from './currents.js';
import {Depths} from './depths.js';
import {Environment} from './environment.js';
import {Estimates} from './estimates.js';
import {Fittings} from './fittings.js';
import {Labels} from './labels.js';
import {Dots, FieldsOfView, SelectionRing, Zones} from './overlays.js';
import {OwnLayers} from './own_layers.js';
import {ESTIMATE_COLOR} from './palette.js';
import {isSoftware} from './resolution.js';
import {Assets} from './shapes.js';
import {Sounds} from './sounds.js';
import {trailColor, Trails} from './trails.js';
import {NoToneMapping, PCFShadowMap, Scene, WebGLRenderer} from './vendor/three.js';
import {Water} from './water.js';

// A layer has those of these functions that it needs:
//   choose(get)          takes the switches under "Show": get(name) is the value of one
//   setScene(data, app)  another scene; app has its vehicles and extent_m, half of its size
//   rewind(time_us)      another time: what belongs to a later one, or to any other one, goes
//   update(view)         before a frame; App.view has what depends on the time and the camera

/** Layers of the scene, in the order of the calls. */
export class Layers {
  constructor(layers) { this.layers = layers; }

  /** Calls a function of those that have it. */
  tell(hook, ...words) {
    for (const layer of this.layers) layer[hook]?.(...words);
  }
}

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
  common.fittings = new Fittings(scene, common.bodies);
  const shared = new Set(scene.children);  // what two branches have in common
  const drawn = {
    sounds: new Sounds(scene),
    estimates: new Estimates(scene, assets),
    trails: new Trails(scene, ({color}) => trailColor(color)),
    estimateTrails: new Trails(scene, () => trailColor(ESTIMATE_COLOR), 'ghosts'),
    views: new FieldsOfView(scene),
    currents: new CurrentArrows(scene),
    depths: new Depths(scene),
    dots: new Dots(scene),
    ring: new SelectionRing(scene),
    ownLayers: new OwnLayers(),
  };
  const otherEstimates = new Estimates(scene, assets);
  const {environment, water, zones, fittings} = common;
  return {
    renderer,
    software,
    scene,
    assets,
    ...common,
    shared,
    ...drawn,
    otherEstimates,
    layers: new Layers([environment, water, zones, fittings, ...Object.values(drawn)]),
    labels: new Labels(document.getElementById('labels')),
    cameras: new Cameras(canvas, (x, y) => common.bodies.groundAt(x, y)),
  };
}
