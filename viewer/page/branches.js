// SPDX-License-Identifier: BSD-3-Clause
// The list of branches of a run, or of the two logs that are compared: which one is shown as ghosts, where it differs
// first, and how far apart its bodies are.
import {element, formatNumber, formatTime} from './panels.js';

const $ = (id) => document.getElementById(id);

/** Names of what the differences are found by. */
const BY = {
  'poses': 'poses that the server kept, ten per second',
  'sim.hash': 'hashes of the state',
};

/** The list; show(branch) shows it as ghosts, goTo(time_us) shows a time. */
export class Branches {
  constructor(show, goTo) {
    this.show = show;
    this.goTo = goTo;
    this.items = [];
    this.ghost = null;
    $('branch-list').addEventListener('click', (event) => {
      const button = event.target.closest('button');
      if (!button) return;
      if (button.dataset.time)
        this.goTo(Number(button.dataset.time));
      else
        this.choose(Number(button.dataset.branch));
    });
  }

  /** Takes a message `branches`. */
  set(message) {
    this.items = (Array.isArray(message.items) ? message.items : []).filter((item) => Number.isInteger(item.branch));
    this.present = message.present;
    this.by = BY[message.by] ?? '';
    const known = this.items.some((item) => item.branch === this.ghost && item.branch !== this.present);
    if (this.ghost !== null && !known) this.choose(this.ghost);
    // A second log is shown at once.
    if (this.ghost === null && this.items.some((item) => item.name && item.branch !== this.present) && !this.chosen)
      this.choose(1);
    this.draw();
  }

  /** Shows a branch as ghosts, or no longer. */
  choose(branch) {
    this.chosen = true;
    this.ghost = this.ghost === branch ? null : branch;
    this.show(this.ghost);
    this.draw();
  }

  nameOf(item) { return item.name ? String(item.name) : `Branch ${item.branch}`; }

  /** Name of a branch and what its programs do. */
  titleOf(item) { return this.nameOf(item) + (item.programs ? ` (${item.programs})` : ''); }

  /** First differences, for the time line: a list of {time_us, text}. */
  differences() {
    return this.items.filter((item) => Number.isFinite(item.differs_us))
        .map((item) => ({time_us: item.differs_us, text: `first difference from ${this.nameOf(item)}`}));
  }

  draw() {
    $('branches').hidden = this.items.length < 2;
    const depth = (item) => {
      const parent = this.items.find((one) => one.branch === item.parent);
      return parent && parent !== item ? Math.min(6, 1 + depth(parent)) : 0;
    };
    $('branch-list').replaceChildren(...this.items.map((item) => this.line(item, depth(item))));
  }

  line(item, depth) {
    const line = document.createElement('li'), present = item.branch === this.present;
    line.style.paddingLeft = `${10 * depth}px`;
    const end = Number.isFinite(item.end_us) ? formatTime(item.end_us) : 'now';
    line.append(element('span', this.nameOf(item), 'branch-name'));
    line.append(element('span', `${formatTime(item.start_us)} – ${end}`, 'quiet'));
    if (item.programs) line.append(element('span', String(item.programs), 'badge'));
    if (present) {
      line.append(element('span', item.name ? 'shown' : 'present', 'badge'));
      return line;
    }
    const button = element('button', 'Ghosts');
    button.type = 'button';
    button.dataset.branch = item.branch;
    button.title = 'Show it over the scene at the same time';
    button.setAttribute('aria-pressed', this.ghost === item.branch);
    line.append(button);
    if (Number.isFinite(item.differs_us)) {
      const step = Number.isInteger(item.differs_step) ? ` (step ${item.differs_step})` : '';
      const jump = element('button', `differs from ${formatTime(item.differs_us)}${step}`);
      jump.type = 'button';
      jump.dataset.time = item.differs_us;
      jump.title = `Show the first difference; found by ${this.by}`;
      line.append(jump);
    } else {
      line.append(element('span', 'no difference', 'quiet'));
    }
    return line;
  }

  /** Shows how far bodies are from their ghosts: the selected vehicle, else the farthest. */
  setDistances(distances, selected) {
    const one = distances.find((item) => item.body === selected) ?? distances[0];
    const text = this.ghost === null ? '' :
        one                          ? `${one.name}: ${formatNumber(one.distance_m)} m apart` :
                                       'no body has a ghost at this time';
    if ($('branch-distance').textContent !== text) $('branch-distance').textContent = text;
  }

  clear() {
    this.items = [];
    this.chosen = false;
    this.ghost = null;
    this.show(null);
    this.draw();
  }
}
