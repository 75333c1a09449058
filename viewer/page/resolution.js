// SPDX-License-Identifier: BSD-3-Clause
// Resolution of the drawing: half of it while frames take long, which the page says.

/** Frames that take longer are drawn with half the resolution. */
const SLOW_MS = 160;
/** Longer intervals are not between frames that follow each other. */
const PAUSE_MS = 2000;
/** Nothing has moved for this long: a sharp image may take its time. */
const IDLE_MS = 400;

/** Is WebGL drawn by the processor?  Then shadows and fine water are off. */
export function isSoftware(gl) {
  const info = gl.getExtension('WEBGL_debug_renderer_info');
  return /swiftshader|llvmpipe|software/i.test(info ? gl.getParameter(info.UNMASKED_RENDERER_WEBGL) : '');
}

/** Sets the pixel ratio of a renderer. */
export class Resolution {
  constructor(renderer, software) {
    this.renderer = renderer;
    this.software = software;
    this.changed_ms = performance.now();
    this.reset();
  }

  /** Draws sharply, until frames turn out to take long. */
  reset() {
    this.sharp = true;
    this.interval_ms = 0;
    this.apply();
  }

  apply() {
    const full = Math.min(devicePixelRatio, this.software ? 1 : 2);
    this.renderer.setPixelRatio(this.sharp ? full : 0.5 * full);
    document.getElementById('coarse').hidden = this.sharp;
  }

  /** Takes whether this frame differs from the one before; returns whether it must be drawn for another resolution. */
  adapt(changes, now_ms) {
    if (changes) {
      const interval_ms = now_ms - this.changed_ms;
      if (interval_ms < PAUSE_MS) this.interval_ms += 0.2 * (interval_ms - this.interval_ms);
      this.changed_ms = now_ms;
    }
    const idle = now_ms - this.changed_ms > IDLE_MS;
    const sharp = idle || this.interval_ms < (this.sharp ? SLOW_MS : SLOW_MS / 4);
    if (sharp === this.sharp) return false;
    this.sharp = sharp;
    this.apply();
    return true;
  }
}
