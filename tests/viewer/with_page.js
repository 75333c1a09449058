// SPDX-License-Identifier: BSD-3-Clause
// What the tests of the page share: one browser for a file, a page with a mock server, comparisons.
import assert from 'node:assert/strict';
import {after, before} from 'node:test';

import {faultsOf, launch, open, until} from './browser.js';
import {MockServer} from './mock_server.js';

/** The browser of a file that called useBrowser(). */
export let browser;

/** Starts a browser before the tests of a file and ends it after them. */
export function useBrowser() {
  before(async () => {
    browser = await launch();
  });
  after(async () => {
    await browser.close();
  });
}

/** Opens the page with a script, runs a test, and checks that nothing went wrong in the page. */
export async function withPage(script, test, {fragment = '#t=secret', ...options} = {}) {
  const server = await new MockServer(script).listen();
  const page = await open(browser, server.url + fragment, options);
  try {
    await until(page, (p) => p.scene !== null && p.frames > 0, 'the first frame');
    await test(page, server);
    assert.deepEqual(await faultsOf(page), []);
  } finally {
    await page.close();
    await server.close();
  }
}

/** Shows a time, paused, and waits until it is drawn. */
export async function show(page, server, t_s, jump = true) {
  server.show(t_s * 1e6, jump);
  return until(page, `(p) => p.time_us === ${t_s * 1e6}`);
}

export const near = (actual, expected, tolerance, what) =>
    assert.ok(Math.abs(actual - expected) <= tolerance, `${what}: ${actual}, expected ${expected} +- ${tolerance}`);

export const text = (page, selector) => page.$eval(selector, (element) => element.textContent);

/** Rows of a table as lists of texts. */
export const rowsOf = (page, selector) => page.$$eval(
    `${selector} tbody tr`, (lines) => lines.map((line) => [...line.cells].map((cell) => cell.textContent)));
