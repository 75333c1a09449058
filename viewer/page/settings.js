// SPDX-License-Identifier: BSD-3-Clause
// Choices of the user: theme, layers, keys; and the view, in the fragment of the address.
import {addSwitches} from './own_layers.js';

const $ = (id) => document.getElementById(id);
const THEME_KEY = 'shoal.theme';
/** Pages up to this width have sheets at the bottom in place of panels at the sides, as in style.css. */
export const NARROW_PX = 760;

/** Keys of the page, for the list under `?`. */
export const KEYS = [
  ['Space', 'pause or continue'],
  ['.', 'one step; with Shift: ten'],
  [', and ;', 'log: one second back, ten seconds back'],
  ['[ and ]', 'vehicle before, next vehicle'],
  ['F', 'follow the selected vehicle'],
  ['C', 'chase it: follow its heading too'],
  ['Home', 'show all vehicles'],
  ['1 … 6', 'orbit, top, follow, chase, first person, fly'],
  ['W A S D Q E', 'fly; Shift is faster'],
  ['Arrows', 'move the view'],
  ['+ and –', 'zoom'],
  ['M', 'measure between two points'],
  ['B', 'the branch or log that is shown as ghosts: overlaid, or side by side'],
  ['V', 'what is drawn'],
  ['P', 'data: plots, images, clocks, traffic, water'],
  ['L', 'names on or off'],
  ['T', 'light or dark'],
  ['/', 'search a vehicle'],
  ['Esc', 'release the vehicle, close'],
  ['?', 'this list'],
];

/** Carries out what a key stands for, unless it is typed into a field. */
export function pressKey(app, event) {
  const typing = /^(INPUT|SELECT|TEXTAREA)$/.test(event.target.tagName) && event.target.type !== 'checkbox';
  if (event.key === 'Escape') escape(app, event);
  if (typing || event.ctrlKey || event.metaKey || event.altKey || $('keys').open) return;
  const onButton = event.target.tagName === 'BUTTON';
  const next = (step) => {
    const name = app.list.neighbor(step);
    if (name !== null) app.select(name);
  };
  const actions = {
    ' ': () => onButton || app.timeBar.togglePlay(),
    '.': () => app.timeBar.step(1),
    ':': () => app.timeBar.step(10),
    '>': () => app.timeBar.step(10),
    ',': () => app.timeBar.skip(-1),
    ';': () => app.timeBar.skip(-10),
    '[': () => next(-1),
    ']': () => next(1),
    f: () => app.setMode('follow'),
    c: () => app.setMode('chase'),
    Home: () => app.fit(),
    m: () => app.measure(),
    b: () => app.toggleSides(),
    v: () => app.options.toggle(),
    p: () => app.instruments.dock.toggle(),
    t: () => app.theme.toggle(),
    l: () => app.options.set('labels', !app.options.get('labels')),
    '?': () => $('keys').showModal(),
    '+': () => app.cameras.zoom(0.8),
    '=': () => app.cameras.zoom(0.8),
    '-': () => app.cameras.zoom(1.25),
    '/': () => {
      if ($('left-body').hidden) $('fold-left').click();
      $('search').focus();
    },
  };
  ['orbit', 'top', 'follow', 'chase', 'first', 'fly'].forEach((mode, i) => {
    actions[String(i + 1)] = () => app.setMode(mode);
  });
  if (!Object.hasOwn(actions, event.key) || (app.cameras.mode === 'fly' && /^[wasdqe]$/.test(event.key))) return;
  actions[event.key]();
  if (!(event.key === ' ' && onButton)) event.preventDefault();
}

function escape(app, event) {
  if (!$('options').hidden)
    app.options.toggle(false);
  else if (app.picking.measuring)
    app.measure(false);
  else if (app.past.active)
    app.past.leave();
  else if (event.target === $('search'))
    $('view').focus();
  else if (!$('keys').open)
    app.select(null);
}

/** Remembers a choice in the browser, if it lets us. */
function remember(value) {
  try {
    localStorage.setItem(THEME_KEY, value);
  } catch {
    // Storage is off: the choice lasts as long as the page.
  }
}

function remembered() {
  try {
    return localStorage.getItem(THEME_KEY);
  } catch {
    return null;
  }
}

/** Light and dark. */
export class Theme {
  constructor(changed) {
    this.changed = changed;
    const dark = matchMedia('(prefers-color-scheme: dark)');
    dark.addEventListener('change', () => {
      if (!remembered()) this.set(dark.matches ? 'dark' : 'light');
    });
    this.set(remembered() ?? (dark.matches ? 'dark' : 'light'));
    $('theme').addEventListener('click', () => this.toggle());
  }

  set(name) {
    this.name = name === 'dark' ? 'dark' : 'light';
    document.documentElement.dataset.theme = this.name;
    this.colors = this.name === 'dark' ? {plate: 'rgba(16,25,33,0.80)', text: '#e6eef3'} :
                                         {plate: 'rgba(250,252,253,0.86)', text: '#14212b'};
    this.changed();
  }

  toggle() {
    this.set(this.name === 'dark' ? 'light' : 'dark');
    remember(this.name);
  }
}

/** Switches under "Show"; changed() is called after each change. */
export class Options {
  constructor(changed) {
    addSwitches($('o-zones').parentElement);
    for (const input of $('options').querySelectorAll('input, select')) input.addEventListener('input', changed);
    $('show').addEventListener('click', () => this.toggle());
  }

  toggle(open = $('options').hidden) {
    $('options').hidden = !open;
    $('show').setAttribute('aria-expanded', open);
    if (open) $('o-labels').focus();
  }

  /** Value of a switch. */
  get(name) {
    const input = $(`o-${name}`);
    return input.type === 'checkbox' ? input.checked : input.value;
  }

  /** Sets a switch. */
  set(name, value) {
    const input = $(`o-${name}`);
    if (input.type === 'checkbox')
      input.checked = value;
    else
      input.value = value;
    input.dispatchEvent(new Event('input'));
  }
}

function fold(side, folded) {
  const button = $(`fold-${side}`);
  $(`${side}-body`).hidden = folded;
  $(side).classList.toggle('folded', folded);
  button.setAttribute('aria-expanded', !folded);
  button.textContent = folded ? '+' : '–';
}

/** Folding of the panels at the sides; on a phone one of them is open at most. */
export function setUpFolds() {
  const narrow = () => innerWidth <= NARROW_PX;
  for (const [side, other] of [['left', 'right'], ['right', 'left']]) {
    $(`fold-${side}`).addEventListener('click', () => {
      const open = $(`${side}-body`).hidden;
      fold(side, !open);
      if (narrow()) fold(other, true);
    });
    if (narrow()) fold(side, true);
  }
}

/** Part of the page that no bar or panel covers, in CSS pixels from its upper left corner. */
export function freeArea() {
  const box = (id) => $(id).getBoundingClientRect(), narrow = innerWidth <= NARROW_PX;
  const covers = (side) => !narrow && !$(`${side}-body`).hidden;
  const below = ['bottom', ...($('dock').hidden ? [] : ['dock']), ...(narrow ? ['sheets'] : [])];
  const x = covers('left') ? box('left').right : 0, y = box('top').bottom;
  const right = covers('right') ? box('right').left : innerWidth;
  return {x, y, width: right - x, height: Math.max(80, Math.min(...below.map((id) => box(id).top)) - y)};
}

/** Which panels are open, such as "left,events"; empty as long as they are as at the start. */
export function panelsText() {
  const tab = document.querySelector('#tabs [aria-selected="true"]').id.replace('tab-', '');
  const open = [$('left-body').hidden ? 'no-left' : 'left', $('right-body').hidden ? 'no-right' : tab].join();
  return open === (innerWidth <= NARROW_PX ? 'no-left,no-right' : 'left,vehicle') ? '' : open;
}

/** Opens the panels that a text names. */
export function setPanels(text) {
  const [left, right] = text.split(',');
  fold('left', left !== 'left');
  if (right !== 'no-right') $('tabs').querySelector(`#tab-${CSS.escape(right ?? 'vehicle')}`)?.click();
  fold('right', right === 'no-right');
}

/** Tabs of the details; arrow keys go from tab to tab. */
export class Tabs {
  constructor() {
    this.tabs = [...$('tabs').children];
    for (const tab of this.tabs) {
      tab.addEventListener('click', () => this.show(tab));
      tab.addEventListener('keydown', (event) => {
        const step = {ArrowRight: 1, ArrowLeft: -1}[event.key];
        if (!step) return;
        const next = this.tabs[(this.tabs.indexOf(tab) + step + this.tabs.length) % this.tabs.length];
        this.show(next);
        next.focus();
        event.stopPropagation();
      });
    }
  }

  show(chosen) {
    for (const tab of this.tabs) {
      tab.setAttribute('aria-selected', tab === chosen);
      $(tab.getAttribute('aria-controls')).hidden = tab !== chosen;
    }
    if ($('right-body').hidden) $('fold-right').click();
  }
}

/** List of keys. */
export function setUpKeyList() {
  for (const [key, text] of KEYS) {
    const line = $('key-table').tBodies[0].insertRow();
    const head = document.createElement('th'), name = document.createElement('kbd');
    name.textContent = key;
    head.append(name);
    line.append(head);
    line.insertCell().textContent = text;
  }
  $('help').addEventListener('click', () => $('keys').showModal());
}

/** The fragment of the address: #t=TOKEN&view=...&select=...  The token stays as it is. */
export class Address {
  constructor() {
    this.values = new URLSearchParams(location.hash.slice(1));
    this.token = this.values.get('t') ?? '';
    this.written_ms = 0;
  }

  get(name) { return this.values.get(name); }

  /** May a view be written again? */
  due(now_ms) { return now_ms - this.written_ms >= 500; }

  /** Writes a view, at most twice a second: browsers refuse more. */
  write(changes, now_ms) {
    if (!this.due(now_ms)) return;
    this.written_ms = now_ms;
    for (const [name, value] of Object.entries(changes))
      if (value)
        this.values.set(name, value);
      else
        this.values.delete(name);
    const text = `#${this.values.toString().replaceAll('%2C', ',')}`;
    if (text !== location.hash && (text !== '#' || location.hash !== '')) history.replaceState(null, '', text);
  }
}
