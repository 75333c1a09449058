// SPDX-License-Identifier: BSD-3-Clause
// The panel of data below the scene: tabs for plots, images, clocks, traffic, water; each shows its own view.
import {element} from './panels.js';

const $ = (id) => document.getElementById(id);

/** Makes a button. */
export function button(text, title, click) {
  const made = element('button', text);
  made.type = 'button';
  made.title = title;
  made.addEventListener('click', click);
  return made;
}

/** Makes a labeled list of choices. */
export function choice(label, change) {
  const made = document.createElement('select');
  made.setAttribute('aria-label', label);
  made.addEventListener('change', () => change(made.value));
  return made;
}

/** Replaces the choices of a list, [value, text] each, and keeps the chosen one; touches nothing that is equal. */
export function setChoices(list, choices) {
  const key = JSON.stringify(choices);
  if (list.dataset.key === key) return;
  const chosen = list.value;
  list.dataset.key = key;
  list.replaceChildren(...choices.map(([value, text]) => new Option(text, value)));
  if (choices.some(([value]) => value === chosen)) list.value = chosen;
}

/** Fills the body of a table with rows of texts or elements; the first of each row is its head. */
export function fillTable(table, rows) {
  table.tBodies[0].replaceChildren(...rows.map((cells) => {
    const line = document.createElement('tr');
    cells.forEach((cell, i) => {
      const made = element(i === 0 ? 'th' : 'td');
      if (i === 0) made.scope = 'row';
      made.append(cell);
      line.append(made);
    });
    return line;
  }));
}

/** Makes a table with a head. */
export function table(label, heads) {
  const made = document.createElement('table');
  made.setAttribute('aria-label', label);
  const line = made.createTHead().insertRow();
  for (const head of heads) {
    const cell = element('th', head);
    cell.scope = 'col';
    line.append(cell);
  }
  made.createTBody();
  return made;
}

/**
 * The panel.  A view has {name, title, root, setOpen(open), update(now_ms)}, and changed() if the list of
 * channels matters to it.
 */
export class Dock {
  constructor(views, changed) {
    this.views = views;
    this.changed = changed;
    this.open = null;
    this.last = views[0].name;
    this.tabs = views.map((view) => this.makeTab(view));
    $('dock-tabs').append(...this.tabs);
    $('dock-body').append(...views.map((view) => view.root));
    $('data').addEventListener('click', () => this.toggle());
    $('close-dock').addEventListener('click', () => {
      this.show(null);
      $('data').focus();
    });
    this.show(null);
  }

  makeTab(view) {
    const tab = button(view.title, '', () => this.show(view.name));
    tab.id = `tab-${view.name}`;
    tab.setAttribute('role', 'tab');
    tab.setAttribute('aria-controls', `dock-${view.name}`);
    view.root.id = `dock-${view.name}`;
    view.root.setAttribute('role', 'tabpanel');
    view.root.setAttribute('aria-labelledby', tab.id);
    tab.addEventListener('keydown', (event) => {
      const step = {ArrowRight: 1, ArrowLeft: -1}[event.key];
      if (!step) return;
      const next = (this.tabs.indexOf(tab) + step + this.tabs.length) % this.tabs.length;
      this.show(this.views[next].name);
      this.tabs[next].focus();
      event.stopPropagation();
    });
    return tab;
  }

  /** The open view; null: none. */
  get view() { return this.views.find((view) => view.name === this.open) ?? null; }

  toggle() { this.show(this.open === null ? this.last : null); }

  /** Shows a view; null: closes the panel. */
  show(name) {
    this.open = this.views.some((view) => view.name === name) ? name : null;
    if (this.open) this.last = this.open;
    $('dock').hidden = this.open === null;
    $('data').setAttribute('aria-expanded', this.open !== null);
    document.body.classList.toggle('with-dock', this.open !== null);
    this.views.forEach((view, i) => {
      const open = view.name === this.open;
      this.tabs[i].setAttribute('aria-selected', open);
      view.root.hidden = !open;
      view.setOpen(open);
    });
    this.changed();
  }

  /** Lets the open view draw. */
  update(now_ms) { this.view?.update(now_ms); }
}
