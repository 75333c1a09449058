// SPDX-License-Identifier: BSD-3-Clause
// Forms for events, faults, actions, new vehicles: they make the texts that `shoal control do` and `spawn` take.

const $ = (id) => document.getElementById(id);

/** Keys of a fault besides device and kind. */
const FAULT_KEYS = {
  biased: ['quantity', 'bias'],
  degraded: ['quantity', 'noise_factor', 'dropout'],
  partial: ['effectiveness']
};
/** A vehicle to be added; its keys are those of `vehicles:` in a world. */
const SPAWN = {
  word: 'spawn',
  meaning: 'adds a vehicle',
  keys: [
    {key: 'name', type: 'text', required: true, meaning: 'name of the vehicle'},
    {key: 'file', type: 'text', required: true, meaning: 'vehicle file, such as rover.yaml'},
    {key: 'position_m', type: '[x, y, z]', meaning: 'place in the world'},
    {key: 'rpy_deg', type: '[x, y, z]', meaning: 'roll, pitch, yaw'},
  ]
};
/** Longest list that is offered as a choice; longer ones are typed. */
const CHOICES_MAX = 500;

/** Writes a text as YAML: as it is where it is not a number, word or sign of YAML, else in quotes. */
export function yamlText(text) {
  const plain = /^[A-Za-z_][\w/.-]*$/.test(text) && !/^(true|false|null|yes|no|on|off|y|n)$/i.test(text);
  return plain ? text : JSON.stringify(text);
}

/** Writes the value of a field: of a text key quoted where needed, of others as it was typed. */
function valueText(key, value) { return key.type === 'text' || key.choices ? yamlText(value) : value.trim(); }

/**
 * Text of an action for `shoal control do`, or of a vehicle for `spawn`; values: {KEY: text}, empty ones are left out.
 */
export function requestText(action, values) {
  const given = action.keys.filter(({key}) => (values[key] ?? '') !== '');
  const pairs = given.map((key) => `${key.key}: ${valueText(key, values[key.key])}`);
  if (action.word === SPAWN.word) return `{${pairs.join(', ')}}`;
  const alone = action.main_alone && given.length === 1 && given[0].key === action.main;
  return `{${action.word}: ${alone ? valueText(given[0], values[action.main]) : `{${pairs.join(', ')}}`}}`;
}

/** The tab of the forms. */
export class Forms {
  constructor(connection) {
    this.connection = connection;
    this.forms = {actions: [], types: {}, events: [], objects: [], actors: []};
    this.vehicles = [];
    this.ids = new Map();
    this.control = false;
    $('act-word').addEventListener('change', () => this.build());
    $('act-form').addEventListener('input', () => this.update());
    $('act-form').addEventListener('submit', (event) => {
      event.preventDefault();
      this.send();
    });
  }

  setHello(hello) {
    this.control = hello.control === true && hello.source === 'run';
    this.show();
  }

  /** Takes a message `forms`. */
  setForms(message) {
    this.forms = {...this.forms, ...message};
    this.show();
  }

  /** Takes the vehicles of a scene, with their devices. */
  setVehicles(vehicles) {
    this.vehicles = vehicles;
    this.show();
  }

  show() {
    $('tab-act').hidden = !this.control || this.forms.actions.length === 0;
    if ($('tab-act').hidden) {
      if ($('tab-act').getAttribute('aria-selected') === 'true') $('tab-vehicle').click();
      return;
    }
    const chosen = $('act-word').value;
    const first = ['trigger', 'fault', 'clear_fault', 'remove'];
    const actions = this.forms.actions.filter((one) => one.word !== 'trigger' || this.forms.events.length > 0);
    const order = (one) => (first.includes(one.word) ? first.indexOf(one.word) : first.length);
    this.actions = [...actions, SPAWN].sort((a, b) => order(a) - order(b));
    $('act-word').replaceChildren(...this.actions.map((one) => new Option(`${one.word}: ${one.meaning}`, one.word)));
    if (this.actions.some((one) => one.word === chosen)) $('act-word').value = chosen;
    this.build(this.values());
  }

  get action() { return this.actions?.find((one) => one.word === $('act-word').value); }

  /** Type of a device `VEHICLE/DEVICE`: what it takes. */
  typeOf(device) {
    const cut = device.indexOf('/');
    const vehicle = this.vehicles.find(({name}) => name === device.slice(0, cut));
    const type = vehicle?.devices.find(({name}) => name === device.slice(cut + 1))?.type;
    return type !== undefined && Object.hasOwn(this.forms.types, type) ? this.forms.types[type] : null;
  }

  /** Names that a key takes; null: anything. */
  choicesOf(word, key, values) {
    if (key.key === 'device')
      return this.vehicles.flatMap((vehicle) => vehicle.devices.map(({name}) => `${vehicle.name}/${name}`));
    if (word === 'fault' && key.key === 'kind') return this.typeOf(values.device ?? '')?.faults ?? key.choices;
    if (word === 'fault' && key.key === 'quantity') return this.typeOf(values.device ?? '')?.quantities ?? null;
    if (word === 'trigger' && key.key === 'event') return this.forms.events;
    if (word === 'actor' && key.key === 'name') return this.forms.actors;
    if (['move', 'remove'].includes(word) && key.key === 'name')
      return [...this.vehicles.map(({name}) => name), ...this.forms.objects];
    return key.choices ?? (key.type === 'bool' ? ['true', 'false'] : null);
  }

  /** Makes the fields of the chosen action. */
  build(values = {}) {
    const action = this.action;
    $('act-fields').replaceChildren(...action.keys.map((key) => {
      const choices = this.choicesOf(action.word, key, values);
      const label = document.createElement('label'), name = document.createElement('span');
      name.textContent = key.key;
      label.title = [key.meaning, key.rule].filter(Boolean).join('; ');
      label.className = 'row';
      const listed = choices && choices.length > 0 && choices.length <= CHOICES_MAX;
      const field = document.createElement(listed ? 'select' : 'input');
      if (listed) field.append(...[...(key.required ? [] : ['']), ...choices].map((one) => new Option(one, one)));
      field.name = key.key;
      field.required = key.required === true;
      if (!listed) field.placeholder = key.type;
      if ((values[key.key] ?? '') !== '' && (!listed || choices.includes(values[key.key])))
        field.value = values[key.key];
      label.append(name, field);
      return label;
    }));
    this.update();
  }

  values() {
    return Object.fromEntries([...$('act-fields').querySelectorAll('input, select')]
                                  .filter((field) => !field.parentElement.hidden)
                                  .map((field) => [field.name, field.value]));
  }

  /** Brings what depends on other fields in line, and shows the request. */
  update() {
    const word = this.action.word;
    if (word === 'fault') {
      const before = this.values();
      if (before.device !== this.device) {
        this.device = before.device;
        return this.build(before);
      }
      for (const field of $('act-fields').querySelectorAll('[name]'))
        field.parentElement.hidden =
            !['device', 'kind'].includes(field.name) && !(FAULT_KEYS[before.kind] ?? []).includes(field.name);
    }
    $('act-text').textContent = `shoal control ${this.command()} '${this.text().replaceAll('\'', '\'\\\'\'')}'`;
    return undefined;
  }

  command() { return this.action === SPAWN ? 'spawn' : 'do'; }
  text() { return requestText(this.action, this.values()); }

  send() {
    const text = this.text();
    this.ids.set(this.connection.control(this.command(), 0, text), text);
    $('act-result').textContent = '…';
  }

  /** Takes the answer to a request; returns false if it is not of this. */
  reply(message) {
    if (!this.ids.has(message.id)) return false;
    this.ids.delete(message.id);
    $('act-result').textContent = message.ok ? message.text || 'done' : message.text;
    $('act-result').className = message.ok ? 'holds' : 'fails';
    return true;
  }
}
