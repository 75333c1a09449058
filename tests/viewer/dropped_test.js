// SPDX-License-Identifier: BSD-3-Clause
// Messages that the server has dropped, because the page was too slow.
import assert from 'node:assert/strict';
import {describe, it} from 'node:test';

import * as scenes from './scenes.js';
import {text, useBrowser, withPage} from './with_page.js';

useBrowser();

describe('dropped messages', () => {
  it('are counted over the scene and in the list of events', async () => {
    await withPage(scenes.land(), async (page, server) => {
      server.send({op: 'dropped', count: 12});
      const warning = 'the server dropped 12 messages: this page is too slow';
      await page.waitForFunction(() => document.querySelector('#events .problem'));
      assert.equal(await text(page, '#events .problem'), warning);
      assert.ok((await text(page, '#toasts')).includes(warning));
    });
  });
});
