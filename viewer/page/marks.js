// SPDX-License-Identifier: BSD-3-Clause
// Marks over the time line: events, and where branches or logs differ first.

const MARKS_MAX = 300;
const $ = (id) => document.getElementById(id);

/** Marks of the time line; goTo(time_us) is called for one that is clicked. */
export class Marks {
  constructor(goTo) {
    this.items = [];
    this.differences = [];
    $('marks').addEventListener('click', (event) => {
      const mark = event.target.closest('button');
      if (mark) goTo(Number(mark.dataset.time));
    });
  }

  /** Adds events of the protocol. */
  add(items) {
    for (const {time_us, kind, who, text} of items)
      if (Number.isFinite(time_us))
        this.items.push({time_us, kind: String(kind), text: [who, text || kind].filter(Boolean).join(': ')});
    this.items.splice(0, Math.max(0, this.items.length - MARKS_MAX));
    this.drawn = null;
  }

  /** Sets the first differences: a list of {time_us, text}. */
  setDifferences(list) {
    this.differences = list.map((one) => ({...one, kind: 'difference'}));
    this.drawn = null;
  }

  clearEvents() {
    this.items = [];
    this.drawn = null;
  }

  clear() {
    this.clearEvents();
    this.differences = [];
  }

  /** Places the marks on a line from start to end; cheap while nothing changes. */
  draw(start_us, end_us) {
    const key = `${start_us} ${Math.round(100 * Math.log(Math.max(1, end_us - start_us)))}`;  // within 1 %
    if (key === this.drawn) return;
    this.drawn = key;
    const buttons = [...this.items, ...this.differences].map(({time_us, kind, text}) => {
      const mark = document.createElement('button');
      mark.type = 'button';
      mark.tabIndex = -1;  // the list of events has the same for the Tab key
      mark.className = kind;
      mark.dataset.time = time_us;
      mark.title = `${(time_us / 1e6).toFixed(2)} s: ${text}`;
      // The thumb of the line is 16 px wide.
      const share = Math.min(1, Math.max(0, (time_us - start_us) / Math.max(1, end_us - start_us)));
      mark.style.left = `calc(8px + ${share} * (100% - 16px))`;
      return mark;
    });
    $('marks').replaceChildren(...buttons);
  }
}
