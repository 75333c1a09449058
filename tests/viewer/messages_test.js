// SPDX-License-Identifier: BSD-3-Clause
// Messages of channels on the page: decoding, broken ones, who wants what.
import assert from 'node:assert/strict';
import {describe, it} from 'node:test';

import {until} from './browser.js';
import {encodeMessage} from './mock_server.js';
import * as scenes from './scenes.js';
import {show, useBrowser, withPage} from './with_page.js';

useBrowser();

const FIELDS = {
  utime: 5000000,
  count: 3,
  position_m: [1.5, NaN, -2],
  x_m: Float32Array.from({length: 20}, (_, i) => i / 4),
  bytes: Uint8Array.from({length: 17}, (_, i) => 240 + i),
  times: BigInt64Array.from({length: 18}, (_, i) => -BigInt(i) * 1000000000000n),
  items: [{range_m: 2, name: 'a'}, {range_m: 3, name: 'b'}],
  valid: true,
};

describe('messages', () => {
  it('are decoded, with the paths and units of their numbers', async () => {
    await withPage(scenes.land(), async (page) => {
      const bytes = [...encodeMessage({channel: 'a.b', type: 'shoal.some_t', time_us: 123456789012, fields: FIELDS})];
      const got = await page.evaluate(async (data) => {
        const {decodeMessage, numericFields, numberAt, unitOf} = await import('/messages.js');
        const message = decodeMessage(Uint8Array.from(data).buffer);
        const {channel, type, time_us, fields} = message, paths = numericFields(fields);
        return {
          channel,
          type,
          time_us,
          x_m: [...fields.x_m],
          bytes: [...fields.bytes],
          times: [...fields.times],
          paths,
          last: numberAt(fields, 'items[1].range_m'),
          none: [numberAt(fields, 'items[2].range_m'), numberAt(fields, 'constructor')].map(Number.isNaN),
          units: ['position_m[1]', 'items[1].range_m', 'turn_radps', 'level_dB', 'm', 'count'].map(unitOf),
        };
      }, bytes);
      assert.deepEqual([got.channel, got.type, got.time_us], ['a.b', 'some_t', 123456789012]);
      assert.deepEqual(got.x_m, [...FIELDS.x_m]);
      assert.deepEqual(got.bytes, [...FIELDS.bytes]);
      assert.deepEqual(got.times, [...FIELDS.times].map(Number));
      for (const path of ['utime', 'position_m[1]', 'x_m[19]', 'items[1].range_m', 'valid'])
        assert.ok(got.paths.includes(path), path);
      assert.ok(!got.paths.includes('items[0].name'));
      assert.equal(got.last, 3);
      assert.deepEqual(got.none, [true, true]);
      assert.deepEqual(got.units, ['m', 'm', 'rad/s', 'dB', '', '']);
    }, {width: 400, height: 300});
  });

  it('that are broken give one error and nothing else', async () => {
    await withPage(scenes.land(), async (page, server) => {
      const whole = [...encodeMessage({channel: 'a', type: 'shoal.some_t', time_us: 1, fields: FIELDS})];
      // Changed at random places, by a fixed sequence; each decodes or is refused.
      const other = await page.evaluate(async (data) => {
        const {decodeMessage} = await import('/messages.js');
        let seed = 1;
        const random = (below) => (seed = seed * 16807 % 2147483647) % below;
        const wrong = [];
        let refused = 0;
        for (let round = 0; round < 4000; ++round) {
          const bytes = Uint8Array.from(data).slice(0, random(4) ? data.length : random(data.length));
          for (let i = random(6); i >= 0 && bytes.length; --i) bytes[random(bytes.length)] = random(256);
          try {
            decodeMessage(bytes.buffer);
          } catch (error) {
            ++refused;
            if (error.constructor.name !== 'ProtocolError') wrong.push(String(error));
          }
        }
        return {wrong, refused};
      }, whole);
      assert.deepEqual(other.wrong, []);
      assert.ok(other.refused > 1000);
      const [client] = server.clients;
      client.socket.send(Buffer.from(whole.slice(0, 60)));
      for (const junk of ['{"op":"channels"}', '{"op":"channels","items":[null,{"name":1}]}', '{"op":"series","id":1}'])
        client.socket.send(junk);
      server.sendPairs([null]);
      server.sendPairs();
      await page.waitForFunction(() => /message: header must fit/.test(document.getElementById('events').textContent));
      await show(page, server, 2);
    }, {width: 400, height: 300});
  });

  it('are subscribed only for what is open and selected', async () => {
    await withPage(scenes.land(), async (page, server) => {
      const subscribed = () => server.received.findLast((message) => message.op === 'subscribe')?.channels ?? [];
      const settle = async (names) => {
        for (let i = 0; i < 3000 && subscribed().map((one) => one.name).sort().join() !== names; ++i)
          await new Promise((resolve) => {
            setTimeout(resolve, 20);
          });
        assert.equal(subscribed().map((one) => one.name).sort().join(), names);
      };
      await settle('');
      await page.evaluate(() => window.shoal.select('rover1'));
      await settle('rover1.lidar');
      assert.ok(subscribed()[0].rate_hz > 0 && subscribed()[0].rate_hz <= 30);
      server.sendChannels(1e6, [['rover1.front', 'shoal.image_t', 'rover1'], ['rover1.lidar', 'shoal.planar_lidar_t']]);
      await page.click('#data');
      await page.click('#tab-images');
      await until(page, (p) => p.images.length === 1, 'the first image opens');
      await settle('rover1.front,rover1.lidar');
      await page.click('#close-dock');
      await page.evaluate(() => window.shoal.select(null));
      await settle('');
    });
  });
});
