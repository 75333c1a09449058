// SPDX-License-Identifier: BSD-3-Clause
// Images and films of what the page draws: a PNG file, or a WebM file by the MediaRecorder of the browser.

const $ = (id) => document.getElementById(id);
const FRAMES_HZ = 30;
const BITS_PER_S = 8e6;
const TYPES = ['video/webm;codecs=vp9', 'video/webm;codecs=vp8', 'video/webm'];

/** Offers a file to the user. */
function download(blob, name) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

/** The buttons "Save image" and "Record". */
export class Recorder {
  constructor(app) {
    this.app = app;
    this.canvas = document.createElement('canvas');
    this.recorder = null;
    this.last = null;
    $('save-image').addEventListener('click', () => this.saveImage());
    for (const id of ['record', 'stop']) $(id).addEventListener('click', () => this.toggle());
    if (typeof MediaRecorder === 'undefined') $('record').disabled = true;
  }

  /** Name of a file: world and time. */
  name(ending) {
    const world = String(this.app.data?.world || 'shoal').replace(/[^\w.-]+/g, '_').slice(0, 60);
    return `${world}_${(this.app.playback.time_us / 1e6).toFixed(2)}s.${ending}`;
  }

  keep(blob, name) {
    this.last = {name, bytes: blob.size, type: blob.type};
    download(blob, name);
  }

  /** Copies the scene and what is written over it; only right after the scene was drawn. */
  copy() {
    const {renderer, labels} = this.app, from = renderer.domElement;
    // A film keeps the size of its first frame.
    if (!this.recorder) [this.canvas.width, this.canvas.height] = [innerWidth, innerHeight];
    const c = this.canvas.getContext('2d');
    c.drawImage(from, 0, 0, this.canvas.width, this.canvas.height);
    c.drawImage(labels.canvas, 0, 0, this.canvas.width, this.canvas.height);
  }

  saveImage() {
    if (!this.app.data) return;
    this.app.draw();
    this.copy();
    const name = this.name('png');
    this.canvas.toBlob((blob) => this.keep(blob, name), 'image/png');
  }

  toggle() {
    if (this.recorder)
      this.stop();
    else
      this.start();
  }

  start() {
    if (!this.app.data) return;
    this.app.draw();
    this.copy();
    const mimeType = TYPES.find((type) => MediaRecorder.isTypeSupported(type));
    const recorder =
        new MediaRecorder(this.canvas.captureStream(FRAMES_HZ), {mimeType, videoBitsPerSecond: BITS_PER_S});
    const parts = [], name = this.name('webm');
    recorder.ondataavailable = (event) => parts.push(event.data);
    recorder.onstop = () => this.keep(new Blob(parts, {type: 'video/webm'}), name);
    recorder.start(1000);
    this.recorder = recorder;
    this.started_ms = performance.now();
    this.show();
  }

  stop() {
    const {recorder} = this;
    this.recorder = null;
    for (const track of recorder.stream.getTracks()) track.stop();
    if (recorder.state !== 'inactive') recorder.stop();
    this.show();
  }

  show() {
    const on = this.recorder !== null;
    $('record').setAttribute('aria-pressed', on);
    $('record').textContent = on ? 'Stop' : 'Record';
    $('stop').hidden = !on;
  }

  /** A frame was drawn. */
  frame() {
    if (!this.recorder) return;
    this.copy();
    const text = `■ ${((performance.now() - this.started_ms) / 1000).toFixed(0)} s`;
    if ($('stop').textContent !== text) $('stop').textContent = text;
  }
}
