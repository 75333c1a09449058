// SPDX-License-Identifier: BSD-3-Clause
// The view of the distances between two logs; its plot is loaded with the first ones.
import {element} from './panels.js';

/** The view. */
export class Distances {
  constructor(app) {
    this.app = app;
    this.name = 'distances';
    this.title = 'Distances';
    this.root = element('div');
    this.note = element('p', 'Two logs, compared by shoal view A.lcm B.lcm, have distances.', 'quiet');
    this.root.append(this.note);
  }

  /** Takes a message `distances`. */
  async set(message) {
    const {DistancePlot} = await import('./distance_plot.js');
    this.plot ??= new DistancePlot(this.app, this.root, this.note);
    this.plot.set(message);
  }

  clear() { this.plot?.clear(); }

  setOpen() { this.plot?.setOpen(); }

  update(now_ms) { this.plot?.update(now_ms); }

  /** Numbers for tests. */
  probe() { return this.plot?.probe() ?? {differs_s: null, traces: []}; }
}
