// SPDX-License-Identifier: BSD-3-Clause
// Layers that are modules of their own, each loaded with the first message of its op that has items.  Such a module has
// a class Layer, made with the scene of three.js; layers.js describes its functions, and take(message) gets the
// message. The layer has a switch under "Show", its op, which hides its `root`.

/** One line for each: op of the message, label of the switch, module. */
const OWN_LAYERS = [
  {op: 'paths', label: 'Paths', load: () => import('./paths.js')},
];

/** Adds their switches. */
export function addSwitches(after) {
  for (const {op, label} of OWN_LAYERS) {
    const input = document.createElement('input'), line = document.createElement('label');
    Object.assign(input, {type: 'checkbox', id: `o-${op}`, checked: true});
    line.append(input, ` ${label}`);
    after.before(line);
  }
}

/** Those that are loaded; one of the layers of the page, app. */
export class OwnLayers {
  constructor() {
    this.loaded = new Map();
    this.newest = new Map();
  }

  /** Handlers of messages by their op. */
  handlers(message, app) {
    return Object.fromEntries(OWN_LAYERS.map(({op, load}) => [op, () => this.take(op, load, message, app)]));
  }

  async take(op, load, message, app) {
    this.newest.set(op, message);
    if (!this.loaded.has(op)) {
      if (!(message.items?.length > 0)) return;
      const {Layer} = await load();
      if (!this.loaded.has(op)) {
        const layer = new Layer(app.scene);
        this.loaded.set(op, layer);
        if (app.data) layer.setScene?.(app.data, app);
        app.applyOptions();
      }
    }
    this.loaded.get(op).take(this.newest.get(op));
    app.dirty = true;
  }

  setScene(data, app) { this.tell('setScene', data, app); }
  rewind(time_us) { this.tell('rewind', time_us); }
  update(view) { this.tell('update', view); }
  choose(get) {
    for (const [op, layer] of this.loaded) layer.root.visible = get(op);
  }

  tell(hook, ...words) {
    for (const layer of this.loaded.values()) layer[hook]?.(...words);
  }

  /** Numbers for tests, by op. */
  probe(world) { return Object.fromEntries(OWN_LAYERS.map(({op}) => [op, this.loaded.get(op)?.probe(world) ?? []])); }
}
