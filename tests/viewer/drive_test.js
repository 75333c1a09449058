// SPDX-License-Identifier: BSD-3-Clause
// Driving by hand and the forms of the live page, in Chromium against the mock server.
import assert from 'node:assert/strict';
import {after, before, describe, it} from 'node:test';

import {requestText, yamlText} from '../../viewer/page/forms.js';

import {faultsOf, launch, open, until} from './browser.js';
import {MockServer} from './mock_server.js';
import * as scenes from './scenes.js';

/** What a server sends about a world: two of its vehicles can be driven. */
const FORMS = {
  op: 'forms',
  actions: [
    {
      word: 'clear_fault',
      meaning: 'ends all faults of a device',
      main: 'device',
      main_alone: true,
      keys: [{key: 'device', type: 'text', meaning: 'VEHICLE/DEVICE', required: true}]
    },
    {
      word: 'fault',
      meaning: 'sets a fault of a device',
      main: 'device',
      main_alone: false,
      keys: [
        {key: 'device', type: 'text', meaning: 'VEHICLE/DEVICE', required: true},
        {key: 'kind', type: 'text', meaning: 'kind', required: true, choices: ['stuck', 'silent', 'biased', 'dead']},
        {key: 'quantity', type: 'text', meaning: 'key of its noise', required: false},
        {key: 'bias', type: 'number', meaning: 'added', required: false}
      ]
    },
    {
      word: 'log',
      meaning: 'writes a line',
      main: 'text',
      main_alone: true,
      keys: [{key: 'text', type: 'text', meaning: 'the line', required: true}]
    },
    {
      word: 'trigger',
      meaning: 'fires an event',
      main: 'event',
      main_alone: true,
      keys: [{key: 'event', type: 'text', meaning: 'the event', required: true}]
    }
  ],
  types: {lidar: {faults: ['stuck', 'silent', 'biased'], quantities: ['range']}},
  events: ['storm', '<b>night</b>'],
  objects: ['crate'],
  actors: [],
  drives: {
    rover1: [{kind: 'twist', axes: ['forward', 'turn']}, {kind: 'joints', axes: ['waist', 'elbow']}],
    rover2: [{kind: 'twist', axes: ['forward', 'turn']}]
  }
};

let browser;

before(async () => {
  browser = await launch();
});
after(async () => {
  await browser.close();
});

async function withPage(test, {fragment = '#t=secret', hello = {}} = {}) {
  const script = {...scenes.land(), forms: structuredClone(FORMS)};
  script.hello = {...script.hello, ...hello};
  const server = await new MockServer(script).listen();
  const page = await open(browser, server.url + fragment);
  try {
    await until(page, (p) => p.scene !== null && p.frames > 0, 'the first frame');
    await page.evaluate(() => window.shoal.select('rover1'));
    await test(page, server);
    assert.deepEqual(await faultsOf(page), []);
  } finally {
    await page.close();
    await server.close();
  }
}

/** Waits until a condition of what the server received holds. */
async function arrives(holds, what) {
  for (let i = 0; i < 1200; ++i) {
    if (holds()) return;
    await new Promise((resolve) => {
      setTimeout(resolve, 50);
    });
  }
  assert.fail(`waited for ${what}`);
}

const drivesOf = (server) => server.received.filter(({op}) => op === 'drive');
const lastOf = (server) => drivesOf(server).at(-1)?.values;

/** Holds Shift and a key, and waits until the server knows. */
async function driveAhead(page, server) {
  await page.click('#drive-on');
  await page.keyboard.down('Shift');
  await page.keyboard.down('ArrowUp');
  await arrives(() => lastOf(server)?.forward === 0.5, 'forward');
}

describe('drive', () => {
  it('sends the keys while the dead-man key is held, and stops when it is released', async () => {
    await withPage(async (page, server) => {
      await page.click('#drive-on');
      // Without the dead-man key nothing is sent.
      await page.keyboard.down('KeyW');
      await page.keyboard.up('KeyW');
      assert.equal(drivesOf(server).length, 0);
      await page.keyboard.down('Shift');
      await page.keyboard.down('ArrowUp');
      await page.keyboard.down('KeyA');
      await arrives(() => lastOf(server)?.turn === 0.5, 'forward and turn');
      const {vehicle, kind, values} = drivesOf(server).at(-1);
      assert.deepEqual({vehicle, kind, values}, {vehicle: 'rover1', kind: 'twist', values: {forward: 0.5, turn: 0.5}});
      // It continues without further keys.
      const count = drivesOf(server).length;
      await arrives(() => drivesOf(server).length > count + 3, 'repeated messages');
      await page.keyboard.up('ArrowUp');
      await arrives(() => lastOf(server).forward === 0, 'no more forward');
      await page.keyboard.up('Shift');
      await arrives(() => Object.keys(lastOf(server)).length === 0, 'the release');
      const released = drivesOf(server).length;
      await page.waitForFunction(() => document.getElementById('drive-state').textContent === 'stopped');
      await page.evaluate(() => new Promise((resolve) => {
                            setTimeout(resolve, 200);
                          }));
      assert.equal(drivesOf(server).length, released);
      // The keys of the page are free again once driving is off.
      await page.click('#drive-on');
      assert.equal(await page.$eval('#drive-controls', (one) => one.hidden), true);
    });
  });

  it('lets go when the page loses the focus', async () => {
    await withPage(async (page, server) => {
      await driveAhead(page, server);
      await page.evaluate(() => window.dispatchEvent(new Event('blur')));
      await arrives(() => Object.keys(lastOf(server)).length === 0, 'the release');
    });
  });

  it('lets go when another vehicle is selected', async () => {
    await withPage(async (page, server) => {
      await driveAhead(page, server);
      await page.evaluate(() => window.shoal.select('rover2'));
      await arrives(() => Object.keys(lastOf(server)).length === 0, 'the release');
      assert.equal(drivesOf(server).at(-1).vehicle, 'rover1');
      assert.equal(await page.$eval('#drive-on', (one) => one.getAttribute('aria-pressed')), 'false');
    });
  });

  it('drives while the button on the page is held, and one joint of several', async () => {
    await withPage(async (page, server) => {
      await page.click('#drive-on');
      await page.select('#drive-kind', 'joints');
      await page.select('#drive-joint', 'elbow');
      await page.evaluate(() => document.activeElement.blur());
      await page.keyboard.down('KeyS');
      await page.evaluate(() => document.getElementById('drive-hold').scrollIntoView());
      const button = await page.$('#drive-hold');
      await button.hover();
      await page.mouse.down();
      await arrives(() => lastOf(server)?.elbow === -0.5, 'the joint');
      assert.equal(drivesOf(server).at(-1).kind, 'joints');
      await page.mouse.up();
      await arrives(() => Object.keys(lastOf(server)).length === 0, 'the release');
    });
  });

  it('takes a gamepad while its shoulder button is held', async () => {
    await withPage(async (page, server) => {
      await page.evaluate(() => {
        window.pad = {
          connected: true,
          buttons: Array.from({length: 16}, () => ({pressed: false})),
          axes: [0, -1, 0.55, 0]
        };
        navigator.getGamepads = () => [null, window.pad];
      });
      await page.click('#drive-on');
      await page.evaluate(() => {
        window.pad.buttons[4].pressed = true;
      });
      await arrives(() => lastOf(server)?.forward === 1, 'the stick');
      // Beyond the dead band of 0.1: (0.55 - 0.1) / 0.9 to the right.
      assert.ok(Math.abs(lastOf(server).turn + 0.5) < 1e-9, String(lastOf(server).turn));
      await page.evaluate(() => {
        window.pad.buttons[4].pressed = false;
      });
      await arrives(() => Object.keys(lastOf(server)).length === 0, 'the release');
    });
  });

  it('ends and says why when the server refuses', async () => {
    await withPage(async (page, server) => {
      await driveAhead(page, server);
      const {id} = drivesOf(server).at(-1);
      server.send({op: 'reply', id, ok: false, text: 'vehicle \'rover1\' is driven by another page'});
      await page.waitForFunction(() => /another page/.test(document.getElementById('toasts').textContent));
      assert.equal(await page.$eval('#drive-on', (one) => one.getAttribute('aria-pressed')), 'false');
    });
  });

  it('does not exist on a page that may not steer', async () => {
    await withPage(async (page, server) => {
      assert.equal(await page.$eval('#drive', (one) => one.hidden), true);
      assert.equal(await page.$eval('#tab-act', (one) => one.hidden), true);
      await page.keyboard.down('Shift');
      await page.keyboard.down('ArrowUp');
      assert.equal(drivesOf(server).length, 0);
    }, {fragment: '#t=wrong'});
  });
});

describe('forms', () => {
  it('makes the texts of `shoal control do`', () => {
    const action = (word) => FORMS.actions.find((one) => one.word === word);
    // The examples of `shoal control --help` and of docs/guides.
    assert.equal(
        requestText(action('fault'), {device: 'rover1/lidar', kind: 'stuck', bias: ''}),
        '{fault: {device: rover1/lidar, kind: stuck}}');
    assert.equal(requestText(action('trigger'), {event: 'storm'}), '{trigger: storm}');
    assert.equal(requestText(action('clear_fault'), {device: 'rover1/lidar'}), '{clear_fault: rover1/lidar}');
    assert.equal(requestText(action('log'), {text: 'a: "b" }'}), '{log: "a: \\"b\\" }"}');
    for (const [text, yaml] of [
             ['true', '"true"'], ['12', '"12"'], ['a b', '"a b"'], ['rover_1-a.b/c', 'rover_1-a.b/c']])
      assert.equal(yamlText(text), yaml);
  });

  it('sends a fault that the device takes', async () => {
    await withPage(async (page, server) => {
      await page.click('#tab-act');
      await page.select('#act-word', 'fault');
      await page.select('#act-fields [name="device"]', 'rover1/lidar');
      // A lidar is not an actuator: it cannot be dead.
      const kinds = await page.$$eval('#act-fields [name="kind"] option', (all) => all.map((one) => one.value));
      assert.deepEqual(kinds, ['stuck', 'silent', 'biased']);
      assert.equal(await page.$eval('#act-fields [name="bias"]', (one) => one.checkVisibility()), false);
      await page.select('#act-fields [name="kind"]', 'biased');
      await page.select('#act-fields [name="quantity"]', 'range');
      await page.type('#act-fields [name="bias"]', '0.5');
      const text = '{fault: {device: rover1/lidar, kind: biased, quantity: range, bias: 0.5}}';
      assert.equal(await page.$eval('#act-text', (one) => one.textContent), `shoal control do '${text}'`);
      await page.click('#act-send');
      await arrives(() => server.received.some(({op}) => op === 'control'), 'the request');
      const {command, text: sent} = server.received.find(({op}) => op === 'control');
      assert.deepEqual([command, sent], ['do', text]);
      await page.waitForFunction(() => document.getElementById('act-result').textContent === 'done');
    });
  });

  it('show the command that they send, also where nothing was touched', async () => {
    await withPage(async (page, server) => {
      const controls = () => server.received.filter(({op}) => op === 'control');
      await page.click('#tab-act');
      for (const [i, [word, text]] of [
               ['trigger', '{trigger: storm}'], ['fault', '{fault: {device: rover1/lidar, kind: stuck}}'],
               ['clear_fault', '{clear_fault: rover1/lidar}']]
               .entries()) {
        if (i > 0) await page.select('#act-word', word);
        // What was chosen stays while another tab is shown, and when vehicles come or go.
        await page.click('#tab-events');
        server.send(server.script.forms);
        server.send(server.script.scene);
        await page.waitForFunction(() => document.querySelectorAll('#act-fields [name]').length > 0);
        await page.click('#tab-act');
        assert.equal(await page.$eval('#act-text', (one) => one.textContent), `shoal control do '${text}'`);
        await page.click('#act-send');
        await arrives(() => controls().length === i + 1, 'the request');
        assert.deepEqual([controls()[i].command, controls()[i].text], ['do', text]);
        assert.equal(await page.$eval('#act-text', (one) => one.textContent), `shoal control do '${text}'`);
      }
    });
  });

  it('fires events by their names, also strange ones, and adds a vehicle', async () => {
    await withPage(async (page, server) => {
      await page.click('#tab-act');
      assert.equal(await page.$eval('#act-word', (one) => one.value), 'trigger');
      await page.select('#act-fields [name="event"]', '<b>night</b>');
      await page.click('#act-send');
      await page.select('#act-word', 'spawn');
      await page.type('#act-fields [name="name"]', 'rover7');
      await page.type('#act-fields [name="file"]', 'rover.yaml');
      await page.type('#act-fields [name="position_m"]', '[2, 0, 0]');
      await page.click('#act-send');
      await arrives(() => server.received.filter(({op}) => op === 'control').length === 2, 'two requests');
      const sent = server.received.filter(({op}) => op === 'control').map(({command, text}) => [command, text]);
      assert.deepEqual(
          sent,
          [['do', '{trigger: "<b>night</b>"}'], ['spawn', '{name: rover7, file: rover.yaml, position_m: [2, 0, 0]}']]);
    });
  });
});
