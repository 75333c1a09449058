// SPDX-License-Identifier: BSD-3-Clause
// The view of images: up to four channels of cameras and sonars, with the value under the mouse.
import {button, choice, setChoices} from './dock.js';
import {decodeImage} from './images.js';
import {element, formatNumber, formatTime} from './panels.js';
import {FanImage, Waterfall} from './sonar_images.js';

const TYPES = ['image_t', 'sonar_image_t', 'side_scan_t'];
const IMAGES_MAX = 4;
const RATE_HZ = 10;

/** One image. */
class ImageView {
  constructor(channel, remove) {
    this.channel = channel;
    this.root = element('figure');
    this.canvas = document.createElement('canvas');
    this.canvas.setAttribute('role', 'img');
    this.canvas.setAttribute('aria-label', `Image of ${channel}`);
    this.caption = element('figcaption', 'waiting for an image …');
    const close = button('✕', `Close ${channel}`, remove);
    close.setAttribute('aria-label', `Close ${channel}`);
    const head = element('div', '', 'row');
    const name = element('strong', channel);
    name.title = channel;
    head.append(name, close);
    this.root.append(head, this.canvas, this.caption);
    this.canvas.addEventListener('pointermove', (event) => this.point(event));
    this.canvas.addEventListener('pointerleave', () => this.describe());
    this.fan = new FanImage();
    this.waterfall = new Waterfall();
  }

  /** Decodes a message and draws it; one that arrives while another is decoded waits, and only the newest does. */
  async take(message) {
    this.waiting = message;
    if (this.busy) return;
    this.busy = true;
    while (this.waiting) {
      const next = this.waiting;
      this.waiting = null;
      try {
        this.show(await this.decode(next), next.time_us);
      } catch (error) {
        this.caption.textContent = `this message ${error.message}`;
        this.caption.className = 'fails';
      }
    }
    this.busy = false;
  }

  decode({type, fields, time_us}) {
    if (type === 'sonar_image_t') return this.fan.decode(fields);
    if (type === 'side_scan_t') return this.waterfall.decode(fields, time_us);
    return decodeImage(fields);
  }

  show(image, time_us) {
    this.image = image;
    this.time_us = time_us;
    [this.canvas.width, this.canvas.height] = [image.width, image.height];
    this.canvas.style.setProperty('--aspect', image.width / image.height);
    this.canvas.getContext('2d', {willReadFrequently: true})
        .putImageData(new ImageData(image.rgba, image.width, image.height), 0, 0);
    this.caption.className = '';
    this.describe();
  }

  describe(pointed = '') {
    if (!this.image) return;
    const {width, height, low, high, unit, note} = this.image;
    const range = Number.isFinite(low) ? ` · ${formatNumber(low)} to ${formatNumber(high)} ${unit ?? ''}` : '';
    this.caption.textContent =
        `${formatTime(this.time_us)} · ${width} × ${height}${range}${note ? ` · ${note}` : ''}${pointed}`;
  }

  /** Writes the value at the mouse. */
  point(event) {
    if (!this.image) return;
    const box = this.canvas.getBoundingClientRect(), {width, height, values, rgba, unit} = this.image;
    const u = Math.floor((event.clientX - box.left) / box.width * width);
    const v = Math.floor((event.clientY - box.top) / box.height * height);
    if (u < 0 || v < 0 || u >= width || v >= height) return;
    const i = v * width + u;
    const value = values ? `${formatNumber(+values[i])} ${unit ?? ''}` : [...rgba.slice(4 * i, 4 * i + 3)].join(', ');
    this.describe(` · (${u}, ${v}): ${value}`);
  }
}

/** The view. */
export class Images {
  constructor(app) {
    this.app = app;
    this.name = 'images';
    this.title = 'Images';
    this.views = [];
    this.root = element('div');
    this.list = choice('Channel of images', () => this.choose());
    this.empty = element('p', 'No camera or sonar of this run has sent an image yet.', 'quiet');
    this.grid = element('div', '', 'image-grid');
    const form = element('div', '', 'form');
    form.append(this.list);
    this.root.append(form, this.empty, this.grid);
    this.changed();
  }

  setOpen(open) {
    this.open = open;
    this.changed();
  }

  /** Takes the list of channels; the first image comes by itself. */
  changed() {
    const rows = this.app.channels.ofTypes(TYPES);
    const closed = rows.filter((row) => this.views.every((one) => one.channel !== row.name));
    setChoices(this.list, [['', 'show …'], ...closed.map((row) => [row.name, row.name])]);
    this.list.disabled = closed.length === 0 || this.views.length >= IMAGES_MAX;
    this.empty.hidden = rows.length > 0;
    if (this.open && !this.touched && this.views.length === 0 && rows.length > 0) this.add(rows[0].name);
    this.subscribe();
  }

  choose() {
    if (this.list.value) this.add(this.list.value);
    this.list.value = '';
  }

  /** Shows a channel. */
  add(channel) {
    this.touched = true;
    if (this.views.length >= IMAGES_MAX || this.views.some((one) => one.channel === channel)) return;
    const view = new ImageView(channel, () => this.remove(view));
    this.views.push(view);
    this.grid.append(view.root);
    this.changed();
  }

  remove(view) {
    view.root.remove();
    this.views = this.views.filter((one) => one !== view);
    this.changed();
    this.list.focus();
  }

  subscribe() {
    const names = this.open ? this.views.map((view) => view.channel) : [];
    this.app.channels.want('images', names, RATE_HZ, (message) => {
      this.views.find((view) => view.channel === message.channel)?.take(message);
    });
  }

  update() {}

  text() { return this.views.map((view) => encodeURIComponent(view.channel)).join(','); }

  setText(text) {
    for (const channel of text.split(',').slice(0, IMAGES_MAX)) this.add(decodeURIComponent(channel));
  }
}
