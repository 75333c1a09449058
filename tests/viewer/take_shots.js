// SPDX-License-Identifier: BSD-3-Clause
// Takes images of the page for people, as the command line says: [FOLDER] [NAME ...]
import {mkdirSync} from 'node:fs';

import {faultsOf, launch, open, until} from './browser.js';
import {MockServer} from './mock_server.js';

/**
 * Takes the shots that were asked for.  A shot has a script for the server, a size, and `fragment` of the address;
 * `prepare(page, server, shot)` brings the page to what is shown.
 */
export async function takeShots(shots, prepare) {
  const [folder = 'screenshots', ...names] = process.argv.slice(2);
  mkdirSync(folder, {recursive: true});
  const browser = await launch();
  for (const [name, shot] of Object.entries(shots)) {
    if (names.length && !names.includes(name)) continue;
    const server = await new MockServer(shot.script).listen();
    const {width = 1200, height = 750, dark = false, fragment = ''} = shot;
    const page = await open(browser, `${server.url}#t=secret${fragment}`, {width, height, dark});
    await until(page, (p) => p.scene !== null && p.frames > 1);
    await prepare(page, server, shot);
    // A sharp frame.
    const {frames} = await page.evaluate(() => window.shoal.probe());
    await page.evaluate(() => window.dispatchEvent(new Event('resize')));
    const probe = await until(page, `(p) => p.frames >= ${frames + 2}`, 'two more frames')
                      .catch(() => page.evaluate(() => window.shoal.probe()));
    await page.screenshot({path: `${folder}/${name}.png`});
    console.log(
        name, `${probe.cpu_ms?.toFixed(1)} ms`, probe.draw_calls, 'calls', probe.triangles, 'triangles',
        await faultsOf(page));
    await page.close();
    await server.close();
  }
  await browser.close();
}
