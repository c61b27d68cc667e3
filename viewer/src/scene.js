// What of a model is drawn, and drawing it. `update` follows a change of what is chosen, `draw` one of the view.
import {
  BufferAttribute, BufferGeometry, DataTexture, DoubleSide, GLSL3, InstancedBufferAttribute, InstancedBufferGeometry, Mesh,
  NearestFilter, Points, Scene, ShaderMaterial, Vector2, Vector3, WebGLRenderer,
} from 'three';
import { labelColour, rampOf } from './colour.js';
import { FACE_FRAGMENT, FACE_VERTEX, LINE_FRAGMENT, LINE_VERTEX, POINT_FRAGMENT, POINT_VERTEX } from './shaders.js';
import { Solid } from './solid.js';
import { buildSurface, findSharpEdges } from './surface.js';

const NOTHING = -10;  // "no value" for the shaders
const AXES = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] };

/// The half-space that stays: normal . p <= offset. `at` runs from 0, nothing stays, to 1, all does.
export function clipPlane(model, clip) {
  const flip = clip.axis.startsWith('-');
  let normal = AXES[clip.axis.replace('-', '')] ?? clip.axis.split('/').map(Number);
  if (flip && AXES[clip.axis.slice(1)]) normal = normal.map((x) => -x);
  const length = Math.hypot(...normal) || 1;
  normal = normal.map((x) => x / length);
  const reach = model.halfExtents.reduce((sum, h, i) => sum + h * Math.abs(normal[i]), 0) * 1.0001;
  return { normal, offset: (2 * clip.at - 1) * reach };
}

function shaderMaterial(vertexShader, fragmentShader, uniforms, extra = {}) {
  return new ShaderMaterial({ glslVersion: GLSL3, vertexShader, fragmentShader, uniforms, ...extra });
}

function lineGeometry() {
  const geometry = new InstancedBufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(new Float32Array([0, -1, 0, 1, -1, 0, 1, 1, 0, 0, 1, 0]), 3));
  geometry.setIndex([0, 1, 2, 0, 2, 3]);
  geometry.instanceCount = 0;
  return geometry;
}

function texture(bytes, rows) {
  const result = new DataTexture(bytes, 256, rows);
  result.magFilter = result.minFilter = NearestFilter;
  result.needsUpdate = true;
  return result;
}

export class Stage {
  constructor(canvas) {
    this.canvas = canvas;
    this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true, powerPreference: 'high-performance' });
    this.renderer.setClearColor(0, 0);
    this.scene = new Scene();
    const ramp = { value: texture(rampOf('dusk', 256), 1) };
    const colours = {
      ramp, range: { value: new Vector2(0, 1) }, missing: { value: new Vector3(0.6, 0.6, 0.6) },
    };
    this.shared = { ...colours, line: { value: new Vector3() }, viewport: { value: new Vector2(1, 1) }, pixel: { value: 1 } };
    const own = (more) => ({ ...this.shared, colouring: { value: 0 }, ...more });
    this.faces = new Mesh(new BufferGeometry(), shaderMaterial(FACE_VERTEX, FACE_FRAGMENT, own({
      surface: { value: new Vector3() }, inside: { value: new Vector3() }, edges: { value: 2 },
    }), { side: DoubleSide }));
    const lines = () => new Mesh(lineGeometry(), shaderMaterial(LINE_VERTEX, LINE_FRAGMENT, own({
      line: { value: new Vector3() }, width: { value: 1 }, vanish: { value: 0 }, lift: { value: 0 }, opacity: { value: 1 },
    }), { transparent: true, side: DoubleSide }));
    this.sharp = lines();
    this.segments = lines();
    this.directions = [lines(), lines(), lines()];
    this.points = new Points(new BufferGeometry(), shaderMaterial(POINT_VERTEX, POINT_FRAGMENT, own({
      line: { value: new Vector3() }, size: { value: 6 }, lift: { value: 0 },
    }), { transparent: true }));
    for (const object of [this.faces, this.sharp, this.segments, ...this.directions, this.points]) {
      object.frustumCulled = false;
      this.scene.add(object);
    }
    this.prepared = new Map();
  }

  /// Connectivity of a model, made once.
  prepare(model) {
    let made = this.prepared.get(model);
    if (!made) {
      const surface = buildSurface(model);
      made = { surface, solid: model.hasSolid ? new Solid(model.tetrahedra, model.positions, surface) : null };
      if (made.solid && !model.hasSurface) surface.sharp = findSharpEdges(model.positions, made.solid.hull, null);
      made.edge = this.typicalEdge(model, made.solid ? model.tetrahedra : surface.corners);
      this.prepared.set(model, made);
    }
    return made;
  }

  /// Median length of a sample of edges.
  typicalEdge({ positions: p }, corners) {
    const lengths = [], step = Math.max(1, Math.floor(corners.length / 3000));
    for (let i = 0; i + 1 < corners.length; i += step) {
      const a = 3 * corners[i], b = 3 * corners[i + 1];
      lengths.push(Math.hypot(p[a] - p[b], p[a + 1] - p[b + 1], p[a + 2] - p[b + 2]));
    }
    lengths.sort((x, y) => x - y);
    return lengths[Math.floor(lengths.length / 2)] ?? 0;
  }

  /// `choice`: model, solid (bool), clip (or false), field (or null), and what is visible.
  update(choice) {
    this.choice = choice;
    const { model } = choice;
    const made = this.prepare(model);
    const plane = choice.clip ? clipPlane(model, choice.clip) : null;
    const keeps = plane
      ? (p, at) => plane.normal[0] * p[at] + plane.normal[1] * p[at + 1] + plane.normal[2] * p[at + 2] <= plane.offset
      : () => true;
    this.keeps = keeps;
    if (choice.solid) this.showSolid(model, made, keeps);
    else this.showSurface(model, made, keeps, plane !== null);
    this.colour(choice);
    this.showLines(this.sharp, model, made.surface.sharp, () => NOTHING);
    this.showSegments(model, made, choice);
    this.showDirections(model, choice);
    this.showPoints(model, made, choice);
  }

  /// Fills the buffers of the faces: corner k of triangle i is vertex `corners(i)[k]`.
  fill(model, count, cornersOf, kindOf) {
    const position = new Float32Array(9 * count), kind = new Float32Array(3 * count);
    const vertices = new Uint32Array(3 * count);
    const p = model.positions;
    this.seen = new Uint8Array(p.length / 3);
    for (let i = 0; i < count; ++i) {
      const corners = cornersOf(i), bits = kindOf(i);
      for (let k = 0; k < 3; ++k) {
        const v = corners[k];
        position.set(p.subarray(3 * v, 3 * v + 3), 9 * i + 3 * k);
        vertices[3 * i + k] = v;
        kind[3 * i + k] = bits;
      }
    }
    const geometry = this.faces.geometry;
    geometry.dispose();
    this.faces.geometry = new BufferGeometry();
    this.faces.geometry.setAttribute('position', new BufferAttribute(position, 3));
    this.faces.geometry.setAttribute('kind', new BufferAttribute(kind, 1));
    this.shown = { count, vertices };
  }

  showSurface(model, made, keeps, clipped) {
    const { corners, polygons, masks } = made.surface;
    const all = corners.length / 3;
    let chosen = null;
    if (clipped) {
      // Whole polygons stay or go, by the mean of their corners.
      const means = new Float64Array(4 * model.counts.polygons), p = model.positions;
      for (let t = 0; t < all; ++t) {
        const at = 4 * (polygons ? polygons[t] : t);
        for (let k = 0; k < 3; ++k)
          for (let c = 0; c < 3; ++c) means[at + c] += p[3 * corners[3 * t + k] + c];
        means[at + 3] += 3;
      }
      const kept = [], mean = [0, 0, 0];
      for (let t = 0; t < all; ++t) {
        const at = 4 * (polygons ? polygons[t] : t);
        for (let c = 0; c < 3; ++c) mean[c] = means[at + c] / means[at + 3];
        if (keeps(mean, 0)) kept.push(t);
      }
      chosen = Uint32Array.from(kept);
    }
    const of = (i) => (chosen ? chosen[i] : i);
    this.fill(model, chosen ? chosen.length : all,
      (i) => corners.subarray(3 * of(i), 3 * of(i) + 3), (i) => masks[of(i)]);
    this.shown.polygon = (i) => (polygons ? polygons[of(i)] : of(i));
    this.shown.tetrahedron = () => -1;
    this.mark(model, corners, (mark) => {
      for (let i = 0; i < this.shown.vertices.length; ++i) mark[this.shown.vertices[i]] = 1;
    });
  }

  showSolid(model, made, keeps) {
    const { solid } = made;
    const { faces, kept } = solid.shownFaces(keeps);
    this.fill(model, faces.length, (i) => solid.corners(faces[i]),
      (i) => 7 | (solid.polygon[faces[i]] < 0 && solid.neighbour[faces[i]] >= 0 ? 8 : 0));
    this.shown.polygon = (i) => solid.polygon[faces[i]];
    this.shown.tetrahedron = (i) => faces[i] >> 2;
    this.shown.tetrahedra = kept.reduce((sum, k) => sum + k, 0);
    this.mark(model, model.tetrahedra, (mark) => {
      for (let t = 0; t < solid.count; ++t)
        if (kept[t]) for (let k = 0; k < 4; ++k) mark[model.tetrahedra[4 * t + k]] = 1;
    });
  }

  /// Which vertices are on what is shown; those on nothing go by the plane.
  mark(model, used, fillMarks) {
    const mark = new Uint8Array(model.positions.length / 3);
    fillMarks(mark);
    const inUse = new Uint8Array(mark.length);
    for (let i = 0; i < used.length; ++i) inUse[used[i]] = 1;
    for (let v = 0; v < mark.length; ++v) if (!inUse[v] && this.keeps(model.positions, 3 * v)) mark[v] = 1;
    this.seen = mark;
  }

  /// Values and maps of the chosen field.
  colour(choice) {
    const { model, field, map } = choice;
    const { count, vertices } = this.shown;
    const value = new Float32Array(3 * count).fill(NOTHING);
    const uniforms = [this.faces, this.segments, this.points, ...this.directions].map((object) => object.material.uniforms);
    for (const one of uniforms) one.colouring.value = 0;
    if (field) {
      const place = this.placing(field);
      const label = field.isLabel;
      const onFaces = field.location === 'tetrahedra' || field.location === 'polygons' || (field.location === 'vertices' && !label);
      if (onFaces) {
        this.faces.material.uniforms.colouring.value = label ? 2 : 1;
        if (field.location === 'vertices') for (let i = 0; i < 3 * count; ++i) value[i] = place(vertices[i]);
        else {
          const element = field.location === 'polygons' ? this.shown.polygon : this.shown.tetrahedron;
          for (let i = 0; i < count; ++i) {
            const e = element(i);
            if (e >= 0) value.fill(place(e), 3 * i, 3 * i + 3);
          }
        }
      }
      if (field.location === 'segments') this.segments.material.uniforms.colouring.value = label ? 2 : 1;
      if (field.location === 'vertices' && label) this.points.material.uniforms.colouring.value = 2;
      this.setRamp(field, map);
    }
    this.faces.geometry.setAttribute('value', new BufferAttribute(value, 1));
  }

  setRamp(field, map) {
    const name = field.isLabel ? `label ${field.categories.length}` : map;
    if (this.rampName === name) return;
    this.rampName = name;
    this.shared.ramp.value.dispose();
    if (!field.isLabel) {
      this.shared.ramp.value = texture(rampOf(map, 256), 1);
      return;
    }
    const rows = Math.max(1, Math.ceil(field.categories.length / 256));
    const bytes = new Uint8Array(4 * 256 * rows).fill(255);
    for (let i = 0; i < field.categories.length; ++i) bytes.set(labelColour(i), 4 * i);
    this.shared.ramp.value = texture(bytes, rows);
  }

  /// Element -> its value for the shaders: 0 at the field's minimum, 1 at its maximum; or its label's rank.
  placing(field) {
    if (field.isLabel) {
      const ranks = field.ranks;
      return (e) => ranks[e];
    }
    const values = field.values, low = field.min, span = field.max - field.min || 1;
    return (e) => (Number.isFinite(values[e]) ? (values[e] - low) / span : NOTHING);
  }

  setRange(field, [low, high]) {
    const span = field.max - field.min || 1;
    this.shared.range.value.set((low - field.min) / span, (high - field.min) / span);
  }

  setLines(mesh, starts, ends, values) {
    const geometry = mesh.geometry;
    geometry.dispose();
    mesh.geometry = lineGeometry();
    mesh.geometry.setAttribute('start', new InstancedBufferAttribute(starts, 3));
    mesh.geometry.setAttribute('end', new InstancedBufferAttribute(ends, 3));
    mesh.geometry.setAttribute('value', new InstancedBufferAttribute(values, 1));
    mesh.geometry.instanceCount = starts.length / 3;
    mesh.visible = starts.length > 0;
  }

  /// Pairs of vertices as lines, where both ends are on what is shown.
  showLines(mesh, model, pairs, valueOf) {
    const p = model.positions, most = pairs.length / 2;
    const starts = new Float32Array(3 * most), ends = new Float32Array(3 * most), values = new Float32Array(most);
    let n = 0;
    for (let i = 0; i < most; ++i) {
      const a = pairs[2 * i], b = pairs[2 * i + 1];
      if (!this.seen[a] || !this.seen[b]) continue;
      starts.set(p.subarray(3 * a, 3 * a + 3), 3 * n);
      ends.set(p.subarray(3 * b, 3 * b + 3), 3 * n);
      values[n++] = valueOf(i);
    }
    this.setLines(mesh, starts.slice(0, 3 * n), ends.slice(0, 3 * n), values.slice(0, n));
  }

  showSegments(model, made, choice) {
    const given = model.array('segments');
    const pairs = choice.segments ? [...given, ...made.surface.segments] : [];
    const place = choice.field?.location === 'segments' ? this.placing(choice.field) : () => NOTHING;
    this.showLines(this.segments, model, pairs, (i) => (i < given.length / 2 ? place(i) : NOTHING));
  }

  /// Short lines at vertices spread evenly: at most one in each cell of a lattice.
  showDirections(model, choice) {
    const p = model.positions;
    const cell = model.radius * 0.16 * 0.16 ** choice.density;
    const taken = new Set(), chosen = [];
    if (choice.directions.some(Boolean)) {
      const outside = new Uint8Array(p.length / 3);
      for (const v of this.shown.vertices) outside[v] = 1;
      for (let v = 0; v < p.length / 3; ++v) {
        if (!(this.shown.count > 0 ? outside[v] : this.seen[v])) continue;
        const key = [0, 1, 2].map((k) => Math.floor(p[3 * v + k] / cell)).join();
        if (taken.has(key)) continue;
        taken.add(key);
        chosen.push(v);
      }
    }
    this.directions.forEach((mesh, slot) => {
      const field = choice.directions[slot];
      const starts = new Float32Array(field ? 3 * chosen.length : 0), ends = new Float32Array(starts.length);
      if (field) {
        const oneSided = field.name === 'normal';
        // Principal directions are as long as they are certain: at umbilics and on planes there are none.
        const sure = field.name.startsWith('dir_') ? model.fields.find((one) => one.name === 'confidence' && one.location === 'vertices' && one.components === 1) : null;
        chosen.forEach((v, i) => {
          const d = field.values.subarray(3 * v, 3 * v + 3);
          const length = Math.hypot(...d);
          const share = sure ? Math.min(1, Math.max(0, sure.values[v] || 0)) : 1;
          const reach = length > 0 ? (0.42 * cell * share) / length : 0;
          for (let k = 0; k < 3; ++k) {
            starts[3 * i + k] = p[3 * v + k] - (oneSided ? 0 : reach * d[k]);
            ends[3 * i + k] = p[3 * v + k] + reach * d[k];
          }
        });
      }
      this.setLines(mesh, starts, ends, new Float32Array(starts.length / 3));
    });
  }

  showPoints(model, made, choice) {
    const p = model.positions, chosen = [];
    const field = choice.field?.location === 'vertices' && choice.field.isLabel ? choice.field : null;
    const used = new Uint8Array(p.length / 3);
    for (const array of [made.surface.corners, made.surface.segments, model.array('segments'), model.tetrahedra])
      for (let i = 0; i < array.length; ++i) used[array[i]] = 1;
    const isolated = new Set(made.surface.points);
    for (let v = 0; v < used.length; ++v)
      if (this.seen[v] && ((choice.points && !(field && field.values[v] === field.hides)) || !used[v] || isolated.has(v))) chosen.push(v);
    const place = field ? this.placing(field) : () => NOTHING;
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(Float32Array.from(chosen.flatMap((v) => [...p.subarray(3 * v, 3 * v + 3)])), 3));
    geometry.setAttribute('value', new BufferAttribute(Float32Array.from(chosen, place), 1));
    this.points.geometry.dispose();
    this.points.geometry = geometry;
    this.points.visible = chosen.length > 0;
  }

  setTheme(theme) {
    const set = (uniform, rgb) => uniform.value.set(...rgb.map((c) => c / 255));
    const faces = this.faces.material.uniforms;
    set(faces.surface, theme.surface);
    set(faces.inside, theme.inside);
    set(this.shared.line, theme.edge);
    set(this.shared.missing, theme.missing);
    set(this.sharp.material.uniforms.line, theme.sharp);
    set(this.segments.material.uniforms.line, theme.segment);
    set(this.points.material.uniforms.line, theme.point);
    this.directions.forEach((mesh, i) => set(mesh.material.uniforms.line, theme.directions[i]));
  }

  draw(view, edges) {
    const ratio = window.devicePixelRatio || 1;
    const width = this.canvas.clientWidth, height = this.canvas.clientHeight;
    if (width === 0 || height === 0) return;
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(width, height, false);
    this.shared.viewport.value.set(width * ratio, height * ratio);
    this.shared.pixel.value = ratio;
    // Edges pale as they get shorter than some pixels, evenly over the model.
    const pixels = this.prepare(this.choice.model).edge / view.unitsPerPixel;
    this.faces.material.uniforms.edges.value = edges === 'all' ? (this.faces.material.uniforms.colouring.value === 1 ? 0.3 : 0.45) * Math.min(1, Math.max(0, (pixels - 2) / 8)) : 0;
    this.sharp.visible = edges !== 'none' && this.sharp.geometry.instanceCount > 0;
    // A line comes forward by its width, a point by its radius; directions also over the bend of the surface under them.
    const perPixel = view.unitsPerPixel / view.length;
    const setLine = (mesh, thick, vanish, over) => {
      mesh.material.uniforms.width.value = thick * ratio;
      mesh.material.uniforms.vanish.value = vanish * ratio;
      mesh.material.uniforms.lift.value = 1.5 * thick * perPixel + over;
    };
    setLine(this.sharp, 1.3, 0, 0);
    setLine(this.segments, 1.6, 5, 0.2 * perPixel);
    for (const mesh of this.directions) setLine(mesh, 1.6, 3, (0.006 * view.radius) / view.length);
    this.points.material.uniforms.size.value = 7 * ratio;
    this.points.material.uniforms.lift.value = 5 * perPixel;
    view.apply(width, height);
    this.renderer.render(this.scene, view.camera);
  }

  /// What the last picture holds. Right after `draw` only: the buffer does not outlive the frame.
  measure() {
    const gl = this.renderer.getContext();
    const width = gl.drawingBufferWidth, height = gl.drawingBufferHeight;
    const pixels = new Uint8Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    let covered = 0;
    const colours = new Set(), sum = [0, 0, 0];
    for (let i = 0; i < pixels.length; i += 4) {
      if (pixels[i + 3] < 128) continue;
      ++covered;
      for (let k = 0; k < 3; ++k) sum[k] += pixels[i + k];
      colours.add(((pixels[i] >> 4) << 8) | ((pixels[i + 1] >> 4) << 4) | (pixels[i + 2] >> 4));
    }
    return {
      width, height, covered, colours: colours.size, mean: sum.map((s) => (covered ? Math.round(s / covered) : 0)),
      triangles: this.shown.count, tetrahedra: this.shown.tetrahedra ?? 0, segments: this.segments.geometry.instanceCount,
      sharp: this.sharp.visible ? this.sharp.geometry.instanceCount : 0,
      directions: this.directions.reduce((total, mesh) => total + mesh.geometry.instanceCount, 0),
      points: this.points.geometry.getAttribute('position').count,
    };
  }

  /// The element under a place on the screen ([-1, 1] squared), if any.
  pick(view, x, y) {
    const origin = new Vector3().setFromMatrixPosition(view.camera.matrix);
    const direction = new Vector3(x, y, 0.5).unproject(view.camera).sub(origin).normalize();
    const p = this.faces.geometry.getAttribute('position').array;
    const o = origin.toArray(), d = direction.toArray();
    let best = Infinity, found = -1, weights = null;
    for (let i = 0; i < this.shown.count; ++i) {
      const at = 9 * i;
      const ax = p[at + 3] - p[at], ay = p[at + 4] - p[at + 1], az = p[at + 5] - p[at + 2];
      const bx = p[at + 6] - p[at], by = p[at + 7] - p[at + 1], bz = p[at + 8] - p[at + 2];
      const nx = d[1] * bz - d[2] * by, ny = d[2] * bx - d[0] * bz, nz = d[0] * by - d[1] * bx;
      const det = ax * nx + ay * ny + az * nz;
      if (det === 0) continue;
      const tx = o[0] - p[at], ty = o[1] - p[at + 1], tz = o[2] - p[at + 2];
      const u = (tx * nx + ty * ny + tz * nz) / det;
      if (u < 0 || u > 1) continue;
      const qx = ty * az - tz * ay, qy = tz * ax - tx * az, qz = tx * ay - ty * ax;
      const v = (d[0] * qx + d[1] * qy + d[2] * qz) / det;
      if (v < 0 || u + v > 1) continue;
      const distance = (bx * qx + by * qy + bz * qz) / det;
      if (distance > 0 && distance < best) [best, found, weights] = [distance, i, [1 - u - v, u, v]];
    }
    if (found < 0) return null;
    return {
      place: o.map((c, k) => c + best * d[k]), weights, vertices: [...this.shown.vertices.subarray(3 * found, 3 * found + 3)],
      polygon: this.shown.polygon(found), tetrahedron: this.shown.tetrahedron(found),
    };
  }
}
