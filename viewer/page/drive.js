// SPDX-License-Identifier: BSD-3-Clause
// Drives the selected vehicle by keys, by a button on the page or by a gamepad, while a dead-man key is held.

const $ = (id) => document.getElementById(id);

/** A server stops the vehicle 0.2 s after the last message. */
const INTERVAL_MS = 50;

/** Axis and direction of keys, by their place on the keyboard. */
const KEYS = {
  ArrowUp: ['forward', 1],
  ArrowDown: ['forward', -1],
  ArrowLeft: ['turn', 1],
  ArrowRight: ['turn', -1],
  KeyW: ['forward', 1],
  KeyS: ['forward', -1],
  KeyA: ['turn', 1],
  KeyD: ['turn', -1],
  KeyF: ['dive', 1],
  KeyR: ['dive', -1],
  KeyQ: ['side', 1],
  KeyE: ['side', -1],
};

/** Axes of a gamepad in the standard layout (W3C Gamepad, section 5), and its dead-man button: the left shoulder. */
const PAD_AXES = [['side', -1], ['forward', -1], ['turn', -1], ['dive', 1]];
const PAD_HOLD = 4;
const DEAD_BAND = 0.1;

/** Positions of the axes from the keys that are down. */
export function valuesOfKeys(down, scale) {
  const values = {};
  for (const code of down) {
    const [axis, direction] = KEYS[code];
    values[axis] = (values[axis] ?? 0) + direction * scale;
  }
  return values;
}

/** Positions of the axes of a gamepad; null while its dead-man button is up. */
export function valuesOfPad(pad) {
  if (!pad?.connected || !pad.buttons[PAD_HOLD]?.pressed) return null;
  const values = {};
  PAD_AXES.forEach(([axis, direction], i) => {
    const at = pad.axes[i] ?? 0, beyond = Math.max(0, Math.abs(at) - DEAD_BAND) / (1 - DEAD_BAND);
    if (beyond > 0) values[axis] = Math.sign(at) * direction * Math.min(1, beyond);
  });
  return values;
}

const isTyping = (target) => /^(INPUT|SELECT|TEXTAREA)$/.test(target.tagName) && target.type !== 'range';

/** Controls of driving in the details of the selected vehicle.  toast(text) shows a text for some seconds. */
export class Drive {
  constructor(connection, toast) {
    this.connection = connection;
    this.toast = toast;
    this.drives = {};
    this.vehicle = null;
    this.control = false;
    this.on = false;
    this.down = new Set();
    this.shift = this.button = this.sending = false;
    this.ids = new Set();
    this.listen();
  }

  listen() {
    $('drive-on').addEventListener('click', () => this.turn(!this.on));
    $('drive-kind').addEventListener('change', () => {
      this.release();
      this.showKind();
      $('drive-kind').blur();  // the arrow keys drive
    });
    // The dead-man key and the keys of the axes, before the page takes them.
    addEventListener('keydown', (event) => this.press(event, true), true);
    addEventListener('keyup', (event) => this.press(event, false), true);
    const hold = $('drive-hold');
    hold.addEventListener('pointerdown', (event) => {
      hold.setPointerCapture(event.pointerId);
      this.button = true;
      this.tick();
    });
    for (const name of ['pointerup', 'pointercancel', 'lostpointercapture'])
      hold.addEventListener(name, () => {
        this.button = false;
        this.tick();
      });
    // Whoever looks away has let go.
    addEventListener('blur', () => this.release());
    addEventListener('pagehide', () => this.release());
    document.addEventListener('visibilitychange', () => document.hidden && this.release());
  }

  setHello(hello) {
    this.control = hello.control === true && hello.source === 'run';
    this.show();
  }

  /** Takes the vehicles that can be driven: {NAME: [{kind, axes}]}. */
  setDrives(drives) {
    this.drives = drives ?? {};
    this.show();
  }

  setVehicle(name) {
    if (name === this.vehicle) return;
    this.turn(false);
    this.vehicle = name;
    this.show();
  }

  get kinds() {
    return (this.vehicle !== null && Object.hasOwn(this.drives, this.vehicle) && this.drives[this.vehicle]) || [];
  }
  get kind() { return this.kinds.find((one) => one.kind === $('drive-kind').value) ?? this.kinds[0]; }

  /** Fills in the kinds; hidden for a page that may not steer, and for what cannot be driven. */
  show() {
    const may = this.control && this.kinds.length > 0;
    $('drive').hidden = !may;
    if (!may) return this.turn(false);
    const chosen = this.kind.kind;
    $('drive-kind').replaceChildren(...this.kinds.map(({kind}) => new Option(kind, kind)));
    $('drive-kind').value = chosen;
    return this.showKind();
  }

  showKind() {
    const joints = this.kind.kind === 'joints';
    const chosen = $('drive-joint').value;
    $('drive-joint').hidden = !joints;
    $('drive-joint').replaceChildren(...(joints ? this.kind.axes : []).map((name) => new Option(name, name)));
    if (joints && this.kind.axes.includes(chosen)) $('drive-joint').value = chosen;
  }

  /** Turns driving on or off. */
  turn(on) {
    if (on === this.on) return;
    this.on = on;
    if (!on) this.release();
    $('drive-on').setAttribute('aria-pressed', on);
    $('drive-controls').hidden = !on;
    clearInterval(this.timer);
    if (on) this.timer = setInterval(() => this.tick(), INTERVAL_MS);
  }

  press(event, down) {
    if (!this.on || isTyping(event.target)) return;
    const shift = event.key === 'Shift';
    if (!shift && (!Object.hasOwn(KEYS, event.code) || event.ctrlKey || event.metaKey || event.altKey)) return;
    event.preventDefault();
    event.stopImmediatePropagation();
    if (shift)
      this.shift = down;
    else if (down)
      this.down.add(event.code);
    else
      this.down.delete(event.code);
    if (!event.repeat) this.tick();
  }

  /** Positions of the controls; null: the driver has let go. */
  values() {
    const pads = navigator.getGamepads?.() ?? [];
    const pad = [...pads].map(valuesOfPad).find((values) => values !== null);
    if (!pad && !this.shift && !this.button) return null;
    const values = {...valuesOfKeys(this.down, Number($('drive-scale').value)), ...pad};
    const axes = this.kind.axes;
    if (this.kind.kind === 'joints') return {[$('drive-joint').value]: values.forward ?? 0};
    return Object.fromEntries(axes.map((axis) => [axis, Math.max(-1, Math.min(1, values[axis] ?? 0))]));
  }

  /** Sends the positions while the dead-man key is held, and once that it is not. */
  tick() {
    if (!this.on || !this.connection.isOpen) return this.drop();
    const values = this.values();
    if (values) {
      this.send(values);
      this.sending = true;
    } else if (this.sending) {
      this.send({});
      this.sending = false;
    }
    return this.showState(values);
  }

  showState(values) {
    const shown = Object.entries(values ?? {}).map(([axis, value]) => `${axis} ${value.toFixed(2)}`);
    $('drive-state').textContent = values ? shown.join(', ') : 'stopped';
  }

  drop() {
    this.sending = this.shift = this.button = false;
    this.down.clear();
  }

  /** Lets go of everything. */
  release() {
    const sending = this.sending;
    this.drop();
    if (sending) this.send({});
    this.showState(null);
  }

  send(values) {
    const id = this.connection.nextId++;
    this.ids.add(id);
    if (this.ids.size > 100) this.ids.delete(this.ids.values().next().value);
    this.connection.send({op: 'drive', id, vehicle: this.vehicle, kind: this.kind.kind, values});
  }

  /** Takes the refusal of a message; returns false if it is not of this. */
  reply(message) {
    if (!this.ids.has(message.id)) return false;
    if (this.on) this.toast(`drive: ${message.text}`);
    this.turn(false);
    return true;
  }
}
