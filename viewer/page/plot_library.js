// SPDX-License-Identifier: BSD-3-Clause
// The library of plots, which is loaded with the first plot: it is a tenth of the page.
let library = null;
let waiting = null;

/** Returns the class of plots; null while it is loaded, after which `ready` is called. */
export function plotLibrary(ready) {
  if (library) return library;
  if (!waiting) {
    waiting = [];
import('./vendor/uplot.js').then((module) => {library = module.default; for (const call of waiting) call();});
  }
  waiting.push(ready);
  return null;
}
