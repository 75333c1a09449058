// SPDX-License-Identifier: BSD-3-Clause
// Chromium for tests: a page on which every console error, page error, refused or failed request is recorded.
import {existsSync} from 'node:fs';
import puppeteer from 'puppeteer-core';

const CHROMIUM = process.env.CHROMIUM ?? '/usr/bin/chromium';
const FLAGS = ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-dev-shm-usage'];
/**
 * Only WebGL needs a GPU, for which SwiftShader stands in.  All else is composed without it, so that a page takes about
 * half of the processor time.
 */
const COMPOSED_WITHOUT_GPU = ['--disable-gpu-compositing', '--disable-gpu-rasterization'];

/** Starts Chromium without a screen. */
export async function launch(more = COMPOSED_WITHOUT_GPU) {
  if (!existsSync(CHROMIUM)) throw new Error(`${CHROMIUM} is missing: apt-get install chromium, or set CHROMIUM`);
  return puppeteer.launch(
      {executablePath: CHROMIUM, headless: true, args: [...FLAGS, ...more], protocolTimeout: 180000});
}

/** Opens a URL; page.faults has everything that should not happen, but for texts that match `allowed`. */
export async function open(browser, url, {width = 960, height = 600, dark = false, allowed = null} = {}) {
  const page = await browser.newPage();
  // Generous: a machine that compiles at the same time is slow.
  page.setDefaultTimeout(60000);
  page.setDefaultNavigationTimeout(120000);
  page.faults = [];
  const fault = (text) => {
    if (!allowed?.test(text)) page.faults.push(text);
  };
  const origin = /^https?:/.test(url) ? new URL(url).origin : null;
  page.on('console', (message) => {
    if (['error', 'warn'].includes(message.type()) && !/GPU stall|GL Driver Message/.test(message.text()))
      fault(`console: ${message.text()}`);
  });
  page.on('pageerror', (error) => fault(`error: ${error.message}\n${error.stack}`));
  page.on('request', (request) => {
    const at = request.url();
    if (/^https?:/.test(at) && new URL(at).origin !== origin) fault(`foreign request: ${at}`);
  });
  page.on('response', (response) => {
    if (response.status() >= 400) fault(`HTTP ${response.status()}: ${response.url()}`);
  });
  page.on('requestfailed', (request) => fault(`failed: ${request.url()} ${request.failure()?.errorText}`));
  await page.setViewport({width, height, deviceScaleFactor: 1});
  await page.emulateMediaFeatures([{name: 'prefers-color-scheme', value: dark ? 'dark' : 'light'}]);
  // Reports of the content security policy.
  await page.evaluateOnNewDocument(() => {
    window.policyReports = [];
    document.addEventListener('securitypolicyviolation', (event) => {
      window.policyReports.push(`${event.violatedDirective}: ${event.blockedURI}`);
    });
  });
  await page.goto(url);
  return page;
}

/** Waits until a function of the probe gives true; returns the probe. */
export async function until(page, holds, what = String(holds), timeout = 90000) {
  try {
    await page.waitForFunction(`window.shoal && (${holds})(window.shoal.probe())`, {timeout, polling: 50});
  } catch (error) {
    throw new Error(`waited for ${what}: ${error.message}; faults: ${page.faults.join('; ')}; probe: ${
        JSON.stringify(await page.evaluate(() => window.shoal?.probe())).slice(0, 1500)}`);
  }
  return page.evaluate(() => window.shoal.probe());
}

/** Everything that should not have happened on a page. */
export async function faultsOf(page) { return [...page.faults, ...(await page.evaluate(() => window.policyReports))]; }
