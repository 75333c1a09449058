// SPDX-License-Identifier: BSD-3-Clause
// A view of the panel of data whose part of the page is loaded when it is opened first.
import {element} from './panels.js';

export class LazyView {
  /** `load`: returns a promise of the view. */
  constructor(name, title, load) {
    this.name = name;
    this.title = title;
    this.load = load;
    this.root = element('div');
    this.view = null;
    this.waiting = new Map();  // work for the view as soon as it is there, by kind
  }

  /** Does something with the view: at once, or when it is loaded; then only the last of each kind. */
  apply(kind, work) {
    if (this.view)
      work(this.view);
    else
      this.waiting.set(kind, work);
  }

  async setOpen(open) {
    this.open = open;
    if (open && !this.loading) {
      this.loading = this.load();
      const view = await this.loading;
      this.root.append(view.root);
      this.view = view;
      for (const work of this.waiting.values()) work(view);
    }
    this.view?.setOpen(this.open);
  }

  changed() { this.view?.changed?.(); }

  update(now_ms) { this.view?.update(now_ms); }
}
