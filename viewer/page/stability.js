// SPDX-License-Identifier: BSD-3-Clause
// How a vehicle stands at present: the margins of a metric `stability` as bars, negative ones in red.
import {element} from './panels.js';

/** Figures of the metric, and what they are the margin of. */
const MARGINS = [
  ['static_m', 'static', 'Center of mass, seen from above, to the edge of the support'],
  ['zmp_m', 'zero-moment point', 'Mean of the contacts by their forces, to the edge of the support'],
  ['capture_m', 'capture point', 'Where a step would bring it to rest, to the edge of the support'],
];
/** Length of a whole bar, until a margin is longer, m. */
const WHOLE_M = 0.05;
const $ = (id) => document.getElementById(id);

/** Writes a margin in mm. */
export function marginText(margin_m) {
  return typeof margin_m === 'number' ? `${(1000 * margin_m).toFixed(0)} mm` : 'no support';
}

/** Share of the bar that a margin fills. */
export function marginShare(margin_m, whole_m) {
  return typeof margin_m === 'number' ? Math.min(1, Math.abs(margin_m) / whole_m) : 0;
}

/** The bars. */
export class Stability {
  constructor() { this.clear(); }

  clear() {
    this.whole_m = WHOLE_M;
    $('stability').replaceChildren();
  }

  /** Takes the metrics of a message `scores`. */
  set(metrics) {
    const standing = metrics.filter(({figures}) => figures && MARGINS.every(([figure]) => figure in figures));
    for (const {figures} of standing)
      for (const [figure] of MARGINS) this.whole_m = Math.max(this.whole_m, Math.abs(figures[figure] ?? 0));
    $('stability')
        .replaceChildren(...standing.flatMap(
            ({name, figures}) =>
                [element('h3', name),
                 ...MARGINS.map(([figure, meaning, title]) => this.bar(meaning, title, figures[figure])),
    ]));
  }

  bar(meaning, title, margin_m) {
    const line = element('div', '', margin_m > 0 ? 'margin' : 'margin outside');
    line.title = title;
    const bar = document.createElement('i');
    bar.style.width = `${100 * marginShare(margin_m, this.whole_m)}%`;
    const track = element('span', '', 'track');
    track.append(bar);
    line.append(element('span', meaning), track, element('span', marginText(margin_m), 'quiet'));
    return line;
  }
}
