// The controls, the legend and the note about a clicked element, as plain elements of the page. Everything is made anew
// when the state changes, except a slider that is being moved.
import { coloursOf, css, gradientOf, labelName, MAPS } from './colour.js';

/// element('button', { class: 'x', onclick }, children...)
export function element(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith('on')) node.addEventListener(name.slice(2), value);
    else if (value === true) node.setAttribute(name, '');
    else if (value !== false && value !== null && value !== undefined) node.setAttribute(name, value);
  }
  node.append(...children.filter((child) => child !== null));
  return node;
}

/// At most four digits, without an exponent where that is short.
export function textOf(value) {
  if (!Number.isFinite(value)) return 'none';
  if (Number.isInteger(value) && Math.abs(value) < 1e15) return grouped(value);
  return String(Number(value.toPrecision(4))).replace('-', '−').replace(/e\+?/, 'e');
}
export function grouped(count) {
  return String(count).replace('-', '−').replace(/\B(?=(\d{3})+$)/g, ' ');
}

function pick(options, current, choose, label) {
  return element('div', { class: 'pick', role: 'group', 'aria-label': label }, ...options.map(([value, text]) =>
    element('button', { 'aria-pressed': String(value === current), onclick: () => choose(value) }, text)));
}

function check(text, on, change, before = null) {
  const box = element('input', { type: 'checkbox', onchange: (event) => change(event.target.checked) });
  box.checked = on;
  return element('label', { class: 'check' }, element('span', {}, ...(before ? [before] : []), text), box);
}

function slider(value, label, change) {
  const node = element('input', { type: 'range', min: 0, max: 1, step: 0.002, 'aria-label': label, oninput: (event) => change(Number(event.target.value)) });
  node.value = value;
  return node;
}

function section(title, ...children) {
  return element('section', {}, element('h2', {}, title), ...children);
}

function countRows(model) {
  const { counts } = model;
  const rows = model.entry.overlay ? [['boxes', counts.boxes], ['clusters', counts.clusters]] : [['vertices', counts.vertices], ['added', counts.added], [counts.triangles === counts.polygons ? 'triangles' : 'polygons', counts.polygons],
    ['quads', counts.quads], ['facets', counts.facets], ['segments', counts.segments], ['tetrahedra', counts.tetrahedra], ['regions', counts.regions > 1 ? counts.regions : 0],
    ['umbilics', counts.umbilics], ['protecting balls', counts.balls], ['shield edges', counts.shields]];
  return rows.filter(([, count]) => count > 0).flatMap(([name, count]) => [element('dt', {}, name), element('dd', {}, grouped(count))]);
}

const PLACES = { vertices: 'per vertex', polygons: 'per face', segments: 'per segment', tetrahedra: 'per tetrahedron' };

/// `app`: resolved choice and `set(changes)`.
export class Panel {
  constructor(root, app) {
    this.root = root;
    this.app = app;
  }

  render() {
    const held = document.activeElement;
    if (held?.type === 'range' && this.root.contains(held) && this.dragging) return;
    const focus = this.root.contains(held) ? held.getAttribute('aria-label') || held.textContent : null;
    const scroll = this.root.scrollTop;
    const { choice, set } = this.app;
    this.root.classList.toggle('closed', !choice.panel);
    this.root.replaceChildren(this.bar(choice, set), ...(choice.panel ? this.sections(choice, set) : []));
    this.root.scrollTop = scroll;
    if (focus)
      [...this.root.querySelectorAll('button,input,select')].find((node) => (node.getAttribute('aria-label') || node.textContent) === focus)?.focus();
  }

  bar(choice, set) {
    return element('div', { class: 'bar' },
      element('button', { title: 'Frame the model (R)', onclick: () => this.app.frame() }, 'frame'),
      element('button', { title: 'Light or dark (D)', onclick: () => set({ theme: choice.theme === 'dark' ? 'light' : 'dark' }) },
        choice.theme === 'dark' ? 'light' : 'dark'),
      element('button', { 'aria-expanded': String(choice.panel), title: 'Controls (H)', onclick: () => set({ panel: !choice.panel }) },
        choice.panel ? 'hide' : 'controls'));
  }

  sections(choice, set) {
    const { model } = choice;
    return [
      element('section', {}, element('dl', {}, ...countRows(model)), model.remark ? element('p', { class: 'remark' }, model.remark) : null),
      this.showSection(choice, set),
      this.colourSection(choice, set),
      this.directionSection(choice, set),
      this.clipSection(choice, set),
      element('p', { class: 'keys' }, 'Drag turns, right drag moves, wheel zooms, a click names the element. Keys: r frame, e edges, c clip, d dark, h hide',
        this.app.page.models.length > 1 ? ', n next file.' : '.'),
    ].filter(Boolean);
  }

  showSection(choice, set) {
    const { model } = choice;
    return section('Show',
      model.hasSolid && model.hasSurface
        ? element('div', { class: 'row' }, pick([['solid', 'tetrahedra'], ['facets', 'facets']], choice.solid ? 'solid' : 'facets', (show) => set({ show }), 'What is shown'))
        : null,
      model.hasSolid || model.hasSurface || choice.ground
        ? element('div', { class: 'row' }, 'Edges', pick([['none', 'none'], ['sharp', 'sharp'], ['all', 'all']], choice.edges, (edges) => set({ edges }), 'Edges'))
        : null,
      model.counts.segments > 0 ? check('Segments', choice.segments, (segments) => set({ segments })) : null,
      model.balls ? check('Protecting balls', choice.balls, (balls) => set({ balls })) : null,
      check('Vertices', choice.points, (points) => set({ points })),
      ...this.groundRows(choice, set),
      element('div', { class: 'row' }, 'Upwards', pick([['y', 'y'], ['z', 'z']], choice.up, (up) => set({ up }), 'Upwards')));
  }

  /// Which other file is drawn under this one, and how.
  groundRows({ model, ground, groundAs }, set) {
    const others = this.app.page.models.filter((one) => one !== model && !one.wantsGround);
    if (others.length === 0) return [];
    const list = element('select', { 'aria-label': 'Surface underneath', onchange: (event) => set({ ground: Number(event.target.value) }) },
      element('option', { value: 0 }, 'nothing'), ...others.map((one) => element('option', { value: one.index + 1 }, one.name)));
    list.value = ground ? ground.index + 1 : 0;
    const row = (text, node) => element('div', { class: 'row' }, text, node);
    return [row('Under it', list), ground ? row('as', pick([['solid', 'solid'], ['glass', 'glass']], groundAs, (as) => set({ groundAs: as }), 'How it is drawn')) : null];
  }

  colourSection(choice, set) {
    const { model, field } = choice;
    const usable = model.fields.filter((one) => one.components === 1);
    if (usable.length === 0) return null;
    const list = element('select', { 'aria-label': 'Colour by', onchange: (event) => set({ colour: event.target.value, range: null, map: null }) },
      element('option', { value: 'plain' }, 'plain'),
      ...usable.map((one) => element('option', { value: one.key }, `${one.name}, ${PLACES[one.location]}`)));
    list.value = field ? field.key : 'plain';
    if (!field || field.isLabel) return section('Colour', list);
    const bound = (i, label) => element('input', {
      type: 'text', inputmode: 'decimal', 'aria-label': label, value: String(Number(choice.range[i].toPrecision(6))),
      onchange: (event) => {
        const range = [...choice.range];
        range[i] = Number(event.target.value.replace('−', '-'));
        if (event.target.value.trim() !== '' && Number.isFinite(range[i]) && range[0] < range[1]) set({ range });
        else event.target.classList.add('wrong');
      },
    });
    const maps = element('select', { 'aria-label': 'Colour map', onchange: (event) => set({ map: event.target.value }) },
      ...Object.keys(MAPS).map((name) => element('option', { value: name }, name)));
    maps.value = choice.map;
    const full = choice.range[0] === field.min && choice.range[1] === field.max;
    return section('Colour', list,
      element('div', { class: 'row' }, 'Range', bound(0, 'Lowest value'), bound(1, 'Highest value')),
      element('div', { class: 'row' }, 'Map', maps),
      field.min < field.max
        ? element('div', { class: 'row' }, pick([[false, 'most values'], [true, 'all values']], full ? true : choice.automaticRange ? false : null,
          (all) => set({ range: all ? [field.min, field.max] : null }), 'Range'))
        : null);
  }

  directionSection(choice, set) {
    const vectors = choice.model.fields.filter((one) => one.isVector && one.location === 'vertices');
    if (vectors.length === 0) return null;
    const chosen = choice.directions.filter(Boolean).map((one) => one.key);
    return section('Directions',
      ...vectors.map((one) => {
        const slot = choice.directions.indexOf(one);
        const dash = element('span', { class: 'dash' });
        dash.style.background = slot >= 0 ? css(this.app.stage.directionColours(choice)[slot]) : 'transparent';
        return check(one.name, slot >= 0, (on) => set({ directions: on ? [...chosen, one.key].slice(-3) : chosen.filter((key) => key !== one.key) }), dash);
      }),
      chosen.length > 0 ? slider(choice.density, 'Density of directions', (density) => this.drag({ density })) : null);
  }

  clipSection(choice, set) {
    const { clip } = choice;
    const axis = clip ? (/^-?[xyz]$/.test(clip.axis) ? clip.axis.replace('-', '') : 'view') : 'off';
    const choose = (name) => {
      if (name === 'off') set({ clip: false });
      else set({ clip: { axis: name === 'view' ? this.app.viewAxis() : name, at: clip ? clip.at : 0.5 } });
    };
    const flipped = () => {
      const turned = clip.axis.includes('/') ? clip.axis.split('/').map((x) => -Number(x)).join('/') : clip.axis.startsWith('-') ? clip.axis.slice(1) : `-${clip.axis}`;
      return { clip: { axis: turned, at: 1 - clip.at } };
    };
    return section('Clip',
      element('div', { class: 'row' }, pick(['off', 'x', 'y', 'z', 'view'].map((name) => [name, name]), axis, choose, 'Clip along')),
      clip ? slider(clip.at, 'Place of the clipping plane', (at) => this.drag({ clip: { ...this.app.choice.clip, at } })) : null,
      clip ? element('div', { class: 'row' }, element('span', {}, 'Other side'), element('div', { class: 'pick' }, element('button', { onclick: () => set(flipped()) }, 'flip'))) : null);
  }

  /// Follows a slider once per frame: it may move faster than large models can.
  drag(changes) {
    const waits = this.wanted !== undefined;
    this.wanted = { ...this.wanted, ...changes };
    if (waits) return;
    requestAnimationFrame(() => {
      const { wanted } = this;
      this.wanted = undefined;
      this.dragging = true;
      this.app.set(wanted);
      this.dragging = false;
    });
  }
}

/// Round numbers within [low, high], three to five of them, with the ends.
function ticksOf(low, high) {
  const span = high - low;
  const power = 10 ** Math.floor(Math.log10(span / 3));
  const step = [1, 2, 2.5, 5, 10].map((m) => m * power).find((s) => span / s <= 4) ?? 10 * power;
  const ticks = [low];
  for (let i = Math.ceil(low / step); i * step < high; ++i) {
    const value = Number((i * step).toPrecision(12));
    if (value - low > 0.24 * span && high - value > 0.24 * span) ticks.push(value);
  }
  return [...ticks, high];
}

function rampLegend(choice) {
  const { field, range: [low, high] } = choice;
  const ramp = element('div', { class: 'ramp' });
  ramp.style.background = gradientOf(choice.map);
  const ticks = ticksOf(low, high).map((value) => {
    const node = element('span', {}, textOf(value));
    node.style.left = `${(100 * (value - low)) / (high - low)}%`;
    return node;
  });
  const beyond = field.min < low || field.max > high ? [element('p', { class: 'beyond' }, `values from ${textOf(field.min)} to ${textOf(field.max)}`)] : [];
  return [ramp, element('div', { class: 'ticks' }, ...ticks), ...beyond];
}

function swatch(colour, shape = 'i') {
  const node = shape === 'i' ? element('i') : element('span', { class: shape });
  node.style.background = css(colour);
  return node;
}

function labelLegend(field, theme) {
  const most = 24, colours = coloursOf(field, theme.directions);
  const shape = { segments: 'dash', vertices: 'dot' }[field.location] ?? 'i';
  const items = [...field.categories.subarray(0, most)].flatMap((value, i) =>
    (field.hides === value ? [] : [element('li', {}, swatch(colours[i], shape), labelName(field, value) ?? String(value))]));
  const more = field.categories.length - Math.min(most, field.categories.length);
  return [element('ul', { class: 'labels' }, ...items), ...(more > 0 ? [element('p', { class: 'beyond' }, `and ${grouped(more)} more`)] : [])];
}

const TITLES = { sign: 'critical clusters', family: 'lines of curvature', umbilic_half_turns: 'umbilics', source_kind: 'added points', cluster: 'critical clusters', reason: 'undecided boxes' };

export function renderLegend(root, choice, theme, directionColours) {
  const parts = [];
  const { field, marks, model } = choice;
  // Places of boxes have the boxes' colours.
  const shown = [field, choice.points && !(model.entry.overlay && field) ? marks : null];
  for (const one of new Set(shown)) {
    if (!one) continue;
    const title = TITLES[one.name];
    parts.push(element('h2', {}, title ?? one.name, ...(title ? [] : [' ', element('span', {}, PLACES[one.location])])));
    parts.push(...(one.isLabel ? labelLegend(one, theme) : rampLegend(choice)));
  }
  const more = choice.directions.flatMap((one, i) => (one ? [element('li', {}, swatch(directionColours[i], 'dash'), one.name)] : []));
  if (choice.balls) {
    more.push(element('li', {}, swatch(theme.ball, 'dot'), 'protecting ball'));
    if (model.counts.shields > 0) more.push(element('li', {}, swatch(theme.shield, 'dash'), 'shield edge'));
  }
  if (more.length > 0) parts.push(element('ul', { class: 'labels directions' }, ...more));
  if (choice.ground) parts.push(element('p', { class: 'beyond' }, `on ${choice.ground.name}`));
  root.replaceChildren(...parts);
}

export function renderProbe(root, rows, x, y) {
  root.hidden = false;
  root.replaceChildren(element('dl', {}, ...rows.flatMap(([name, value]) => [element('dt', {}, name), element('dd', {}, value)])));
  const box = root.getBoundingClientRect();
  root.style.left = `${Math.min(x + 14, window.innerWidth - box.width - 8)}px`;
  root.style.top = `${Math.min(y + 14, window.innerHeight - box.height - 8)}px`;
}
