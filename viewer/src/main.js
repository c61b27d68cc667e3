// The page: one state, kept in the address; what it leaves open is chosen from the model; everything else follows from it.
// For tests and pictures `certa.report()` tells what was drawn.
import { HOME, Turntable } from './camera.js';
import { labelName, MAPS } from './colour.js';
import { readPage } from './data.js';
import { element, Panel, renderLegend, renderProbe, textOf } from './panel.js';
import { frameOf, Stage } from './scene.js';
import { hashOf, stateOf } from './state.js';

const MANY_TRIANGLES = 200000;
const FEW_CLUSTERS = 10;
const THEMES = {
  light: {
    surface: [196, 208, 220], inside: [232, 190, 132], edge: [38, 52, 68], sharp: [40, 54, 70], segment: [26, 44, 66], point: [214, 92, 54], missing: [205, 208, 212],
    directions: [[24, 78, 148], [176, 42, 58], [40, 110, 70], [232, 132, 20], [120, 56, 160]], ball: [42, 120, 150], shield: [206, 62, 30],
    directionsOnMaps: [[24, 78, 148], [176, 42, 58], [40, 110, 70]],
  },
  dark: {
    surface: [138, 158, 178], inside: [206, 154, 90], edge: [12, 17, 23], sharp: [14, 19, 25], segment: [226, 233, 240], point: [255, 150, 100], missing: [84, 90, 97],
    directions: [[140, 200, 255], [255, 140, 132], [160, 226, 170], [255, 196, 92], [216, 160, 255]], ball: [130, 200, 224], shield: [255, 138, 96],
    directionsOnMaps: [[36, 104, 204], [208, 48, 62], [30, 136, 84]],
  },
};

const byId = (id) => document.getElementById(id);

function fail(text) {
  const message = byId('message');
  message.textContent = text;
  message.hidden = false;
  for (const id of ['panel', 'legend']) byId(id).hidden = true;
  document.documentElement.dataset.certa = JSON.stringify({ ready: false, message: text });
}

class App {
  constructor(page, stage) {
    this.page = page;
    this.stage = stage;
    this.state = stateOf(location.hash);
    this.view = new Turntable(byId('stage'), () => this.moved(), (event) => this.tapped(event));
    this.set = this.set.bind(this);
    this.panel = new Panel(byId('panel'), this);
    this.systemTheme = matchMedia('(prefers-color-scheme: dark)');
    this.systemTheme.addEventListener('change', () => this.follow());
    addEventListener('hashchange', () => this.arrive());
    addEventListener('resize', () => this.follow());
    addEventListener('keydown', (event) => this.key(event));
    stage.canvas.addEventListener('webglcontextlost', () => fail('The graphics card dropped the picture. Reload the page to draw it again.'));
    this.arrive();
  }

  /// Takes everything from the address.
  arrive() {
    if (location.hash === this.address) return;
    clearTimeout(this.pending);
    this.address = location.hash;
    this.state = stateOf(location.hash);
    this.view.reset();
    const view = this.state.view;
    if (view) {
      [this.view.yaw, this.view.pitch, this.view.distance = 1] = view;
      if (view.length === 6) this.view.target = view.slice(3);
    }
    this.follow();
  }

  set(changes) {
    Object.assign(this.state, changes);
    this.follow();
    this.remember();
  }

  /// What is shown: the state, with what it leaves open chosen.
  resolve() {
    const { state } = this;
    const model = this.page.models[Math.min(state.file, this.page.models.length - 1)];
    const up = state.up ?? this.page.up;
    const solid = model.hasSolid && !(state.show === 'facets' && model.hasSurface);
    const field = this.chosenField(model);
    const automaticRange = state.range === null || !field;
    const range = automaticRange ? this.rangeOf(field) : state.range;
    const directions = this.directionSlots(model);
    const ground = this.groundOf(model);
    const marks = field?.isLabel && field.location === 'vertices' ? field : this.marksOf(model, field);
    return {
      ground, marks, groundAs: state.groundAs ?? (model.hasSurface ? 'glass' : 'solid'), balls: model.balls !== null && state.balls !== false,
      directions, model, solid, field, range, automaticRange, up,
      clip: state.clip ?? (solid ? { axis: up === 'z' ? '-y' : 'z', at: 0.5 } : false),
      map: MAPS[state.map] ? state.map : field && this.crossesZero(field) ? 'tide' : 'dusk',
      edges: state.edges ?? (model.counts.polygons > MANY_TRIANGLES || directions.some(Boolean) || (ground && !model.hasSurface) ? 'sharp' : 'all'),
      // Where nearly every edge is a segment, drawing them says nothing.
      segments: state.segments ?? (model.entry.overlay ? !ground : model.counts.segments < 0.5 * (model.counts.polygons || Infinity)),
      points: state.points ?? (model.isPoint || marks !== null),
      density: state.density ?? 0.5,
      theme: state.theme ?? (this.systemTheme.matches ? 'dark' : 'light'),
      panel: state.panel ?? innerWidth > 640,
      bare: state.bare ?? false,
    };
  }

  /// Vertices that stand out; those of boxes in the colours of the boxes.
  marksOf(model, field) {
    const same = (one) => one.location === 'vertices' && one.isLabel && one.name === field.name;
    return (model.entry.overlay && field && model.fields.find(same)) || model.marks;
  }

  /// The file whose surface is drawn under the model: the state's, else, for lines and boxes, one of the same name, else the first.
  groundOf(model) {
    const { models } = this.page;
    const fits = (one) => one && one !== model && !one.wantsGround;
    if (this.state.ground !== null) return fits(models[this.state.ground - 1]) ? models[this.state.ground - 1] : null;
    if (!model.wantsGround) return null;
    const candidates = models.filter((one) => fits(one) && this.meet(model, one));
    return candidates.find((one) => one.stem === model.stem) ?? candidates[0] ?? null;
  }

  /// Whether the boxes of two models have a point in common.
  meet({ entry: a }, { entry: b }) {
    return [0, 1, 2].every((i) => a.lower[i] <= b.upper[i] && b.lower[i] <= a.upper[i]);
  }

  /// Three places, each with its colour: the directions of the state, dir_min and dir_max always in the same.
  directionSlots(model) {
    const slots = [null, null, null];
    for (const key of this.state.directions ?? []) {
      const field = model.field(key);
      if (!field?.isVector || field.location !== 'vertices' || slots.includes(field)) continue;
      const wanted = { dir_min: [0], dir_max: [1] }[field.name] ?? [2, 0, 1];
      const free = wanted.find((slot) => !slots[slot]);
      if (free !== undefined) slots[free] = field;
    }
    return slots;
  }

  /// The field of the state, else the mean curvature or the first numbers of vertices, else the regions where there are several.
  chosenField(model) {
    if (this.state.colour === 'plain') return null;
    const named = this.state.colour ? model.field(this.state.colour) : null;
    if (named?.components === 1) return named;
    // Few clusters are told apart, many by whether they lie inside or outside.
    const clusters = model.field('cluster'), few = clusters && clusters.categories.length <= FEW_CLUSTERS;
    const special = model.field('family') ?? (model.entry.overlay ? (clusters ? (few ? clusters : model.field('sign')) : model.field('reason')) : null);
    if (special) return special;
    const candidates = model.fields.filter((one) => one.components === 1 && !one.isLabel && one.location === 'vertices' && one.name !== 'ball_radius');
    const numbers = candidates.find((one) => one.name === 'mean') ?? candidates[0];
    const labels = model.fields.filter((one) => one.isLabel && one.location === 'tetrahedra');
    const regions = model.counts.regions > 1 ? labels.find((one) => one.name === 'region') ?? labels.find((one) => one.name === 'marker') : null;
    return numbers ?? regions ?? null;
  }

  crossesZero(field) {
    const [low, high] = field.bulk;
    return low < 0 && high > 0 && Math.min(-low, high) > 0.05 * Math.max(-low, high);
  }

  /// Most of the values; even around zero where they lie on both sides.
  rangeOf(field) {
    if (!field || field.isLabel) return [0, 1];
    let [low, high] = field.bulk;
    if (high - low > 0.5 * (field.max - field.min)) [low, high] = [field.min, field.max];
    if (this.crossesZero(field)) {
      high = Math.max(-low, high);
      low = -high;
    }
    return low < high ? [low, high] : [low - (Math.abs(low) || 1) * 0.5, low + (Math.abs(low) || 1) * 0.5];
  }

  get theme() {
    return THEMES[this.choice.theme];
  }

  /// Brings the picture and the controls in line with the state.
  follow() {
    try {
      this.bringInLine();
    } catch (error) {
      fail(`This page cannot be shown: ${error.message}`);
    }
  }

  bringInLine() {
    const before = this.choice;
    this.choice = this.resolve();
    const { choice } = this;
    document.documentElement.dataset.theme = choice.theme;
    for (const id of ['head', 'panel']) byId(id).hidden = choice.bare;
    document.body.classList.toggle('bare', choice.bare);
    document.title = this.page.models.length > 1 ? `${choice.model.name} · ${this.page.title}` : this.page.title;
    this.view.up = choice.up;
    const frame = frameOf(choice.model, choice.ground);
    this.view.radius = frame.radius;
    this.view.centre = frame.centre;
    this.stage.setTheme(this.theme);
    const relevant = (c) => c && [c.model.index, c.solid, c.field?.key, c.map, JSON.stringify(c.clip), c.segments, c.points,
      c.directions.map((one) => one?.key).join(), c.density, c.ground?.index, c.groundAs, c.balls, c.theme].join('|');
    if (relevant(before) !== relevant(choice)) this.stage.update(choice);
    if (choice.field && !choice.field.isLabel) this.stage.setRange(choice.field, choice.range);
    this.renderFiles();
    this.panel.render();
    renderLegend(byId('legend'), choice, this.theme, this.stage.directionColours(choice));
    this.view.inset = this.coveredSides();
    byId('probe').hidden = true;
    this.redraw();
  }

  /// CSS pixels at the right and at the bottom that the controls, or on small screens the legend, cover.
  coveredSides() {
    const { choice } = this, isOpen = choice.panel && !choice.bare;
    if (isOpen) return innerWidth > 640 ? [264, 0] : [0, 0.55 * innerHeight];
    const isSmall = innerWidth <= 640 || innerHeight <= 480;
    const legend = byId('legend').getBoundingClientRect();
    return [0, isSmall && legend.height > 0 ? legend.height + 12 : 0];
  }

  renderFiles() {
    const { models } = this.page;
    const nodes = models.length === 1
      ? [element('span', { title: models[0].name }, models[0].name)]
      : models.map((model, i) => element('button', {
        'aria-pressed': String(model === this.choice.model), title: `${model.name} (${i + 1})`, onclick: () => this.set({ file: i }),
      }, model.name));
    byId('files').replaceChildren(...nodes);
  }

  redraw() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.stage.draw(this.view, this.choice.edges);
    });
  }

  moved() {
    byId('probe').hidden = true;
    const { yaw, pitch, distance, target } = this.view;
    const short = target.every((x) => Math.abs(x) < 1e-4) ? (Math.abs(distance - 1) < 1e-4 ? [yaw, pitch] : [yaw, pitch, distance]) : [yaw, pitch, distance, ...target];
    this.state.view = yaw === HOME.yaw && pitch === HOME.pitch && short.length === 2 ? null : short;
    this.redraw();
    this.remember();
  }

  frame() {
    this.view.reset();
    this.moved();
  }

  /// The clipping axis of the moment's view: what is nearer to the eye goes.
  viewAxis() {
    return this.view.basis.back.map((x) => Number(x.toFixed(3))).join('/');
  }

  remember() {
    clearTimeout(this.pending);
    this.pending = setTimeout(() => {
      if (location.hash !== this.address) return; // a link was followed meanwhile: arrive() is about to be called
      try {
        history.replaceState(null, '', hashOf(this.state) || location.pathname + location.search);
        this.address = location.hash;
      } catch {
        // Some browsers forbid this to local files, and limit how often: the address then stays as it was.
      }
    }, 150);
  }

  tapped(event) {
    const box = this.stage.canvas.getBoundingClientRect();
    const hit = this.stage.pick(this.view, (2 * (event.clientX - box.left)) / box.width - 1, 1 - (2 * (event.clientY - box.top)) / box.height);
    if (!hit) {
      byId('probe').hidden = true;
      return;
    }
    renderProbe(byId('probe'), this.describe(hit), event.clientX, event.clientY);
  }

  /// Numbers as in files and messages: from 1.
  describe({ place, vertices, weights, polygon, tetrahedron, segment = -1 }) {
    const { model } = this.choice;
    const rows = [];
    if (tetrahedron >= 0) rows.push(['tetrahedron', String(tetrahedron + 1)]);
    if (polygon >= 0) rows.push([model.counts.triangles === model.counts.polygons ? 'triangle' : 'polygon', String(polygon + 1)]);
    if (segment >= 0) rows.push(['segment', String(segment + 1)]);
    rows.push([vertices.length > 1 ? 'vertices' : 'vertex', vertices.map((v) => v + 1).join(', ')]);
    rows.push(['place', model.place(...place).map((x) => String(Number(x.toPrecision(6)))).join(', ')]);
    for (const field of model.fields) {
      if (field.components !== 1) continue;
      const element = { tetrahedra: tetrahedron, polygons: polygon, segments: segment, vertices: field.isLabel && vertices.length === 1 ? vertices[0] : -1 }[field.location];
      if (element >= 0) rows.push([field.name, labelName(field, field.values[element]) ?? textOf(field.values[element])]);
      if (field.location === 'vertices' && !field.isLabel)
        rows.push([field.name, textOf(vertices.reduce((sum, v, i) => sum + weights[i] * field.values[v], 0))]);
    }
    return rows;
  }

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || /^(INPUT|SELECT|TEXTAREA)$/.test(event.target.tagName)) return;
    const { choice } = this;
    const step = event.shiftKey ? 30 : 8;
    const turn = { ArrowLeft: [step, 0], ArrowRight: [-step, 0], ArrowUp: [0, step], ArrowDown: [0, -step] }[event.key];
    const look = { x: [90, 0], y: [choice.up === 'z' ? 180 : 0, choice.up === 'z' ? 0 : 90], z: [0, choice.up === 'z' ? 90 : 0] }[event.key];
    if (/^[1-9]$/.test(event.key) && Number(event.key) <= this.page.models.length) this.set({ file: Number(event.key) - 1 });
    else if (event.key === 'n') this.set({ file: (choice.model.index + 1) % this.page.models.length });
    else if (event.key === 'r') this.frame();
    else if (event.key === 'd') this.set({ theme: choice.theme === 'dark' ? 'light' : 'dark' });
    else if (event.key === 'e') this.set({ edges: { none: 'sharp', sharp: 'all', all: 'none' }[choice.edges] });
    else if (event.key === 'h') this.set({ panel: !choice.panel });
    else if (event.key === 'c') this.set({ clip: choice.clip ? false : { axis: this.viewAxis(), at: 0.5 } });
    else if (event.key === '+' || event.key === '=') this.view.zoom(0.85);
    else if (event.key === '-') this.view.zoom(1 / 0.85);
    else if (turn) this.view.turn(...turn);
    else if (look) {
      [this.view.yaw, this.view.pitch] = look;
      this.moved();
    } else return;
    event.preventDefault();
  }

  /// Draws now and tells what the picture holds, by value and in the root element's data-certa.
  report() {
    this.stage.draw(this.view, this.choice.edges);
    const { model, solid, field, clip, edges } = this.choice;
    const report = {
      ready: true, file: model.index, name: model.name, solid, field: field?.key ?? null, clip, edges, range: this.choice.range,
      counts: model.counts, hash: hashOf(this.state), ...this.stage.measure(),
    };
    document.documentElement.dataset.certa = JSON.stringify(report);
    return report;
  }
}

function start() {
  let page;
  try {
    page = readPage();
  } catch (error) {
    fail(`This page is damaged: ${error.message}`);
    return;
  }
  let stage;
  try {
    const probe = document.createElement('canvas').getContext('webgl2');
    if (!probe) throw new Error('no WebGL 2');
    probe.getExtension('WEBGL_lose_context')?.loseContext();
    stage = new Stage(byId('stage'));
  } catch {
    fail('This browser does not draw 3D pictures here: WebGL 2 is switched off or missing. Turn on hardware acceleration, or open the page in a current Firefox, Chrome, Edge or Safari.');
    return;
  }
  window.certa = new App(page, stage);
}

start();
