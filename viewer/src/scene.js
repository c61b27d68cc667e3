// What of a model is drawn, and drawing it. `update` follows a change of what is chosen, `draw` one of the view.
import {
  BufferAttribute, BufferGeometry, DataTexture, DoubleSide, GLSL3, InstancedBufferAttribute, InstancedBufferGeometry, Mesh,
  NearestFilter, Points, Scene, ShaderMaterial, Vector2, Vector3, WebGLRenderer,
} from 'three';
import { coloursOf, rampOf } from './colour.js';
import {
  BALL_FRAGMENT, BALL_VERTEX, FACE_FRAGMENT, FACE_VERTEX, LINE_FRAGMENT, LINE_VERTEX, POINT_FRAGMENT, POINT_VERTEX,
} from './shaders.js';
import { Solid } from './solid.js';
import { buildSurface, findSharpEdges, SHORT_BEND } from './surface.js';

const NOTHING = -10;  // "no value" for the shaders
const AXES = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] };

/// What the view is about, in the model's coordinates: the model, or what it lies on.
export function frameOf(model, ground) {
  if (!ground) return { centre: [0, 0, 0], half: model.halfExtents, radius: model.radius };
  const { shift, factor } = model.mapFrom(ground);
  return { centre: shift, half: ground.halfExtents.map((h) => factor * h), radius: factor * ground.radius };
}

/// The half-space that stays: normal . p <= offset. `at` runs from 0, nothing stays, to 1, all does.
export function clipPlane({ centre, half }, clip) {
  const flip = clip.axis.startsWith('-');
  let normal = AXES[clip.axis.replace('-', '')] ?? clip.axis.split('/').map(Number);
  if (flip && AXES[clip.axis.slice(1)]) normal = normal.map((x) => -x);
  const length = Math.hypot(...normal) || 1;
  normal = normal.map((x) => x / length);
  const reach = half.reduce((sum, h, i) => sum + h * Math.abs(normal[i]), 0) * 1.0001;
  const middle = centre.reduce((sum, c, i) => sum + c * normal[i], 0);
  return { normal, offset: middle + (2 * clip.at - 1) * reach };
}

function shaderMaterial(vertexShader, fragmentShader, uniforms, extra = {}) {
  return new ShaderMaterial({ glslVersion: GLSL3, vertexShader, fragmentShader, uniforms, ...extra });
}

/// One square per instance; its corners are (0 or 1, -1 or 1).
function squareGeometry() {
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

/// Where a ray first meets the triangles of a mesh: distance, number (-1: nowhere) and weights of the corners.
function firstHit(mesh, o, d) {
  const p = mesh.geometry.getAttribute('position')?.array ?? [];
  let best = Infinity, found = -1, weights = null;
  for (let at = 0; at < p.length; at += 9) {
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
    if (distance > 0 && distance < best) [best, found, weights] = [distance, at / 9, [1 - u - v, u, v]];
  }
  return { best, found, weights };
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
    const faces = () => new Mesh(new BufferGeometry(), shaderMaterial(FACE_VERTEX, FACE_FRAGMENT, own({
      surface: { value: new Vector3() }, inside: { value: new Vector3() }, edges: { value: 2 }, glass: { value: 0 },
    }), { side: DoubleSide }));
    this.faces = faces();
    this.ground = faces();
    const lines = () => new Mesh(squareGeometry(), shaderMaterial(LINE_VERTEX, LINE_FRAGMENT, own({
      line: { value: new Vector3() }, width: { value: 1 }, vanish: { value: 0 }, lift: { value: 0 }, opacity: { value: 1 },
    }), { transparent: true, side: DoubleSide }));
    this.sharp = lines();
    this.groundSharp = lines();
    this.shields = lines();
    this.segments = lines();
    this.directions = [lines(), lines(), lines()];
    this.points = new Points(new BufferGeometry(), shaderMaterial(POINT_VERTEX, POINT_FRAGMENT, own({
      line: { value: new Vector3() }, size: { value: 6 }, lift: { value: 0 }, ramp: { value: texture(rampOf('dusk', 256), 1) },
    }), { transparent: true }));
    this.balls = new Mesh(squareGeometry(), shaderMaterial(BALL_VERTEX, BALL_FRAGMENT, { line: { value: new Vector3() } },
      { transparent: true, depthWrite: false, side: DoubleSide }));
    // In the order in which they are drawn: what is seen through comes last.
    [this.faces, this.ground, this.sharp, this.groundSharp, this.segments, this.shields, ...this.directions, this.points, this.balls].forEach((object, i) => {
      object.frustumCulled = false;
      object.renderOrder = i;
      this.scene.add(object);
    });
    this.prepared = new Map();
  }

  /// Connectivity of a model, made once.
  prepare(model) {
    let made = this.prepared.get(model);
    if (!made) {
      const surface = buildSurface(model);
      made = { surface, solid: model.hasSolid ? new Solid(model.tetrahedra, model.positions, surface) : null };
      if (made.solid && !model.hasSurface) surface.sharp = findSharpEdges(model.positions, made.solid.hull, null, SHORT_BEND * model.radius);
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
    this.frame = frameOf(model, choice.ground);
    const plane = choice.clip ? clipPlane(this.frame, choice.clip) : null;
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
    this.showBalls(model, choice);
    this.showGround(model, choice, plane !== null);
  }

  /// Gives a mesh of faces its buffers: three vertices per triangle (`vertices`) and what the shader is to know of each.
  setFaces(mesh, positions, vertices, kinds) {
    const position = new Float32Array(3 * vertices.length), kind = new Float32Array(vertices.length);
    for (let i = 0; i < vertices.length; ++i) {
      const v = 3 * vertices[i];
      position[3 * i] = positions[v];
      position[3 * i + 1] = positions[v + 1];
      position[3 * i + 2] = positions[v + 2];
      kind[i] = kinds[(i / 3) | 0];
    }
    mesh.geometry.dispose();
    mesh.geometry = new BufferGeometry();
    mesh.geometry.setAttribute('position', new BufferAttribute(position, 3));
    mesh.geometry.setAttribute('kind', new BufferAttribute(kind, 1));
    mesh.visible = vertices.length > 0;
  }

  /// The triangles of a surface that the plane leaves: whole polygons stay or go, by the mean of their corners.
  trianglesKept({ corners, polygons }, polygonCount, p, keeps) {
    const all = corners.length / 3;
    const means = new Float64Array(4 * polygonCount);
    for (let t = 0; t < all; ++t) {
      const at = 4 * (polygons ? polygons[t] : t);
      for (let k = 3 * t; k < 3 * t + 3; ++k) for (let c = 0; c < 3; ++c) means[at + c] += p[3 * corners[k] + c];
      means[at + 3] += 3;
    }
    const kept = new Uint32Array(all), mean = [0, 0, 0];
    let n = 0;
    for (let t = 0; t < all; ++t) {
      const at = 4 * (polygons ? polygons[t] : t);
      for (let c = 0; c < 3; ++c) mean[c] = means[at + c] / means[at + 3];
      if (keeps(mean, 0)) kept[n++] = t;
    }
    return kept.subarray(0, n);
  }

  /// Corners and masks of some triangles of a surface, all where `chosen` is null.
  chosenTriangles({ corners, masks }, chosen) {
    if (!chosen) return { vertices: corners, kinds: masks };
    const vertices = new Uint32Array(3 * chosen.length), kinds = new Uint8Array(chosen.length);
    for (let i = 0; i < chosen.length; ++i) {
      for (let k = 0; k < 3; ++k) vertices[3 * i + k] = corners[3 * chosen[i] + k];
      kinds[i] = masks[chosen[i]];
    }
    return { vertices, kinds };
  }

  showSurface(model, made, keeps, clipped) {
    const { surface } = made;
    const chosen = clipped ? this.trianglesKept(surface, model.counts.polygons, model.positions, keeps) : null;
    const { vertices, kinds } = this.chosenTriangles(surface, chosen);
    this.setFaces(this.faces, model.positions, vertices, kinds);
    this.shown = { count: kinds.length, vertices };
    const of = (i) => (chosen ? chosen[i] : i);
    this.shown.polygon = (i) => (surface.polygons ? surface.polygons[of(i)] : of(i));
    this.shown.tetrahedron = () => -1;
    this.mark(model, surface.corners, (mark) => {
      for (let i = 0; i < vertices.length; ++i) mark[vertices[i]] = 1;
    });
  }

  showSolid(model, made, keeps) {
    const { solid } = made;
    const { faces, kept } = solid.shownFaces(keeps);
    const vertices = new Uint32Array(3 * faces.length), kinds = new Uint8Array(faces.length);
    for (let i = 0; i < faces.length; ++i) {
      solid.writeCorners(faces[i], vertices, 3 * i);
      kinds[i] = 7 | (solid.polygon[faces[i]] < 0 && solid.neighbour[faces[i]] >= 0 ? 8 : 0);
    }
    this.setFaces(this.faces, model.positions, vertices, kinds);
    this.shown = { count: faces.length, vertices };
    this.shown.polygon = (i) => solid.polygon[faces[i]];
    this.shown.tetrahedron = (i) => faces[i] >> 2;
    this.shown.tetrahedra = kept.reduce((sum, k) => sum + k, 0);
    this.mark(model, model.tetrahedra, (mark) => {
      for (let t = 0; t < solid.count; ++t)
        if (kept[t]) for (let k = 0; k < 4; ++k) mark[model.tetrahedra[4 * t + k]] = 1;
    });
  }

  /// The surface of another file, in this one's coordinates, clipped with it.
  showGround(model, choice, clipped) {
    const { ground } = choice;
    const nothing = new Float32Array(0);
    if (!ground) {
      this.setFaces(this.ground, nothing, new Uint32Array(0), new Uint8Array(0));
      this.setLines(this.groundSharp, nothing, nothing, nothing);
      return;
    }
    const made = this.prepare(ground);
    const { shift, factor } = model.mapFrom(ground);
    const positions = ground.positions.map((x, i) => shift[i % 3] + factor * x);
    const hull = ground.hasSurface ? null : made.solid.hull;
    const surface = hull ? { corners: hull, polygons: null, masks: new Uint8Array(hull.length / 3).fill(7) } : made.surface;
    const count = hull ? hull.length / 3 : ground.counts.polygons;
    const chosen = clipped ? this.trianglesKept(surface, count, positions, this.keeps) : null;
    const { vertices, kinds } = this.chosenTriangles(surface, chosen);
    this.setFaces(this.ground, positions, vertices, kinds);
    this.ground.geometry.setAttribute('value', new BufferAttribute(new Float32Array(vertices.length).fill(NOTHING), 1));
    const glass = choice.groundAs === 'glass';
    const { material } = this.ground;
    material.uniforms.glass.value = glass ? 1 : 0;
    material.transparent = glass;
    material.depthWrite = !glass;
    this.ground.renderOrder = glass ? 8.5 : 1;  // as glass over lines, under points and balls
    const seen = new Uint8Array(positions.length / 3);
    for (const v of vertices) seen[v] = 1;
    this.showLines(this.groundSharp, { positions }, made.surface.sharp, () => NOTHING, seen);
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
      this.setRamp(field, map, choice.theme);
    }
    if (choice.marks) {
      const { ramp, colouring } = this.points.material.uniforms;
      colouring.value = 2;
      ramp.value.dispose();
      ramp.value = this.labelRamp(choice.marks);
    }
    this.faces.geometry.setAttribute('value', new BufferAttribute(value, 1));
  }

  setRamp(field, map, theme) {
    const name = field.isLabel ? `label ${field.key} ${field.categories.length} ${theme} ${this.choice.model.index}` : map;
    if (this.rampName === name) return;
    this.rampName = name;
    this.shared.ramp.value.dispose();
    this.shared.ramp.value = field.isLabel ? this.labelRamp(field) : texture(rampOf(map, 256), 1);
  }

  /// The colours of a label's categories, 256 to a row.
  labelRamp(field) {
    const colours = coloursOf(field, this.strong);
    const rows = Math.max(1, Math.ceil(colours.length / 256));
    const bytes = new Uint8Array(4 * 256 * rows).fill(255);
    colours.forEach((rgb, i) => bytes.set(rgb, 4 * i));
    return texture(bytes, rows);
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
    mesh.geometry = squareGeometry();
    mesh.geometry.setAttribute('start', new InstancedBufferAttribute(starts, 3));
    mesh.geometry.setAttribute('end', new InstancedBufferAttribute(ends, 3));
    mesh.geometry.setAttribute('value', new InstancedBufferAttribute(values, 1));
    mesh.geometry.instanceCount = starts.length / 3;
    mesh.visible = starts.length > 0;
  }

  /// Pairs of vertices as lines, where both ends are on what is shown.
  showLines(mesh, { positions: p }, pairs, valueOf, seen = this.seen) {
    const most = pairs.length / 2;
    const starts = new Float32Array(3 * most), ends = new Float32Array(3 * most), values = new Float32Array(most);
    let n = 0;
    for (let i = 0; i < most; ++i) {
      const a = pairs[2 * i], b = pairs[2 * i + 1];
      if (!seen[a] || !seen[b]) continue;
      for (let k = 0; k < 3; ++k) {
        starts[3 * n + k] = p[3 * a + k];
        ends[3 * n + k] = p[3 * b + k];
      }
      values[n++] = valueOf(i);
    }
    this.setLines(mesh, starts.slice(0, 3 * n), ends.slice(0, 3 * n), values.slice(0, n));
  }

  showSegments(model, made, choice) {
    const given = model.array('segments');
    const loose = made.surface.segments;
    const pairs = new Uint32Array(choice.segments ? given.length + loose.length : 0);
    if (choice.segments) {
      pairs.set(given);
      pairs.set(loose, given.length);
    }
    const place = choice.field?.location === 'segments' ? this.placing(choice.field) : () => NOTHING;
    this.showLines(this.segments, model, pairs, (i) => (i < given.length / 2 ? place(i) : NOTHING));
  }

  /// The colours of directions: surfaces with a colour map are as light in the dark as they are by day.
  directionColours(choice) {
    return choice.field && !choice.field.isLabel && choice.field.location !== 'segments' ? this.theme.directionsOnMaps : this.theme.directions;
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
      mesh.material.uniforms.line.value.set(...this.directionColours(choice)[slot].map((c) => c / 255));
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
    const field = choice.marks;
    const used = new Uint8Array(p.length / 3);
    for (const array of [made.surface.corners, made.surface.segments, model.array('segments'), model.tetrahedra])
      for (let i = 0; i < array.length; ++i) used[array[i]] = 1;
    const isolated = new Set(made.surface.points);
    for (let v = 0; v < used.length; ++v)
      if (this.seen[v] && ((choice.points && !(field && field.values[v] === field.hides)) || !used[v] || isolated.has(v))) chosen.push(v);
    const place = field ? this.placing(field) : () => NOTHING;
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(Float32Array.from({ length: 3 * chosen.length }, (_, i) => p[3 * chosen[(i / 3) | 0] + (i % 3)]), 3));
    geometry.setAttribute('value', new BufferAttribute(Float32Array.from(chosen, place), 1));
    this.points.geometry.dispose();
    this.points.geometry = geometry;
    this.points.visible = chosen.length > 0;
  }

  /// Protecting balls as glass, and the shield edges on them.
  showBalls(model, choice) {
    const radii = choice.balls ? model.balls : null;
    const p = model.positions, centres = [], sizes = [];
    if (radii) {
      for (let v = 0; v < radii.values.length; ++v) {
        if (!(radii.values[v] > 0) || !this.keeps(p, 3 * v)) continue;
        centres.push(p[3 * v], p[3 * v + 1], p[3 * v + 2]);
        sizes.push(radii.values[v] / model.entry.scale);
      }
    }
    this.balls.geometry.dispose();
    this.balls.geometry = squareGeometry();
    this.balls.geometry.setAttribute('centre', new InstancedBufferAttribute(Float32Array.from(centres), 3));
    this.balls.geometry.setAttribute('radius', new InstancedBufferAttribute(Float32Array.from(sizes), 1));
    this.balls.geometry.instanceCount = sizes.length;
    this.balls.visible = sizes.length > 0;
    this.showLines(this.shields, model, radii ? model.array('shields') : [], () => NOTHING);
  }

  setTheme(theme) {
    this.theme = theme;
    this.strong = theme.directions;
    const set = (uniform, rgb) => uniform.value.set(...rgb.map((c) => c / 255));
    const faces = this.faces.material.uniforms;
    set(faces.surface, theme.surface);
    set(faces.inside, theme.inside);
    set(this.shared.line, theme.edge);
    set(this.shared.missing, theme.missing);
    for (const mesh of [this.sharp, this.groundSharp]) set(mesh.material.uniforms.line, theme.sharp);
    set(this.ground.material.uniforms.surface, theme.surface);
    set(this.ground.material.uniforms.inside, theme.inside);
    set(this.balls.material.uniforms.line, theme.ball);
    set(this.shields.material.uniforms.line, theme.shield);
    set(this.segments.material.uniforms.line, theme.segment);
    set(this.points.material.uniforms.line, theme.point);
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
    const strength = (length, uniforms) => {
      const pixels = length / view.unitsPerPixel;
      return edges === 'all' ? (uniforms.colouring.value === 1 ? 0.3 : 0.45) * Math.min(1, Math.max(0, (pixels - 2) / 8)) : 0;
    };
    const { model, ground, groundAs } = this.choice;
    const setEdges = (mesh, length) => { mesh.material.uniforms.edges.value = strength(length, mesh.material.uniforms); };
    setEdges(this.faces, this.prepare(model).edge);
    // Boxes are few, and nothing without their edges.
    if (model.entry.overlay) this.faces.material.uniforms.edges.value = edges === 'none' ? 0 : 0.6;
    if (ground) setEdges(this.ground, groundAs === 'glass' ? 0 : this.prepare(ground).edge * model.mapFrom(ground).factor);
    this.sharp.visible = edges !== 'none' && !model.entry.overlay && this.sharp.geometry.instanceCount > 0;
    this.groundSharp.visible = edges !== 'none' && groundAs !== 'glass' && this.groundSharp.geometry.instanceCount > 0;
    // A line comes forward by its width, a point by its radius; directions also over the bend of the surface under them.
    const perPixel = view.unitsPerPixel / view.length;
    const setLine = (mesh, thick, vanish, over) => {
      mesh.material.uniforms.width.value = thick * ratio;
      mesh.material.uniforms.vanish.value = vanish * ratio;
      mesh.material.uniforms.lift.value = 1.5 * thick * perPixel + over;
    };
    for (const mesh of [this.sharp, this.groundSharp]) setLine(mesh, 1.3, 0, 0);
    // Pieces of lines are short and stay; sides of dense facets fade. Lines lie on the surface only up to its bend.
    const bare = !(model.hasSurface || model.hasSolid);
    setLine(this.segments, bare ? 1.8 : 1.6, bare ? 0 : 5, 0.2 * perPixel + (bare && ground ? (0.002 * view.radius) / view.length : 0));
    setLine(this.shields, 2, 4, 0.4 * perPixel);
    for (const mesh of this.directions) setLine(mesh, 1.6, 3, (0.006 * view.radius) / view.length);
    this.points.material.uniforms.size.value = (this.choice.model.marks ? 10 : 7) * ratio;
    this.points.material.uniforms.lift.value = 5 * perPixel + (ground ? (0.004 * view.radius) / view.length : 0);
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
      points: this.points.geometry.getAttribute('position').count, balls: this.balls.visible ? this.balls.geometry.instanceCount : 0,
      shields: this.shields.geometry.instanceCount, ground: this.ground.visible ? this.ground.geometry.getAttribute('position').count / 3 : 0,
    };
  }

  /// The nearest segment, or vertex that stands out, within some pixels of a place on the screen and not behind `covered`.
  pickLine(view, x, y, covered) {
    const { model, segments, marks } = this.choice;
    const p = model.positions, { clientWidth, clientHeight } = this.canvas;
    const at = (v) => {
      const place = new Vector3(p[3 * v], p[3 * v + 1], p[3 * v + 2]), far = place.distanceTo(eye);
      place.project(view.camera);
      return [((place.x - x) * clientWidth) / 2, ((place.y - y) * clientHeight) / 2, far];
    };
    const eye = new Vector3().setFromMatrixPosition(view.camera.matrix);
    const best = { score: Infinity };
    const offer = (score, far, found) => {
      if (score < 7 && score < best.score && far < covered + 0.03 * view.radius) Object.assign(best, { score, ...found });
    };
    const pairs = segments ? model.array('segments') : [];
    for (let s = 0; s < pairs.length; s += 2) {
      if (!this.seen[pairs[s]] || !this.seen[pairs[s + 1]]) continue;
      const a = at(pairs[s]), b = at(pairs[s + 1]);
      const dx = b[0] - a[0], dy = b[1] - a[1], length = dx * dx + dy * dy;
      const t = length > 0 ? Math.min(1, Math.max(0, -(a[0] * dx + a[1] * dy) / length)) : 0;
      offer(Math.hypot(a[0] + t * dx, a[1] + t * dy), a[2] + t * (b[2] - a[2]), { segment: s / 2, vertices: [pairs[s], pairs[s + 1]], weights: [1 - t, t] });
    }
    if (marks)
      for (let v = 0; v < marks.values.length; ++v) {
        if (marks.values[v] === marks.hides) continue;
        const [px, py, far] = at(v);
        offer(Math.hypot(px, py) - 3, far, { segment: -1, vertices: [v], weights: [1] });
      }
    if (!best.vertices) return null;
    const place = [0, 1, 2].map((k) => best.vertices.reduce((sum, v, i) => sum + best.weights[i] * p[3 * v + k], 0));
    return { ...best, place, polygon: -1, tetrahedron: -1 };
  }

  /// The element under a place on the screen ([-1, 1] squared), if any.
  pick(view, x, y) {
    const origin = new Vector3().setFromMatrixPosition(view.camera.matrix);
    const direction = new Vector3(x, y, 0.5).unproject(view.camera).sub(origin).normalize();
    const o = origin.toArray(), d = direction.toArray();
    const { best, found, weights } = firstHit(this.faces, o, d);
    if (found < 0) return this.pickLine(view, x, y, this.choice.groundAs === 'solid' ? firstHit(this.ground, o, d).best : Infinity);
    return {
      place: o.map((c, k) => c + best * d[k]), weights, vertices: [...this.shown.vertices.subarray(3 * found, 3 * found + 3)],
      polygon: this.shown.polygon(found), tetrahedron: this.shown.tetrahedron(found),
    };
  }
}
