// Polygons as triangles to draw. Facets with several rings are filled as docs/conventions.md says: what the rings
// enclose, less what the hole points reach. Elements keep their numbers; inner diagonals are not edges.
import { ShapeUtils, Vector2 } from 'three';

const FEATURE_COSINE = Math.cos((40 * Math.PI) / 180);
export const SHORT_BEND = 0.08;  // of the model's radius

/// Newell's normal of a closed ring of vertices.
function ringNormal(positions, ring) {
  let x = 0, y = 0, z = 0;
  for (let i = 0; i < ring.length; ++i) {
    const a = 3 * ring[i], b = 3 * ring[(i + 1) % ring.length];
    x += (positions[a + 1] - positions[b + 1]) * (positions[a + 2] + positions[b + 2]);
    y += (positions[a + 2] - positions[b + 2]) * (positions[a] + positions[b]);
    z += (positions[a] - positions[b]) * (positions[a + 1] + positions[b + 1]);
  }
  return [x, y, z];
}

/// A map from space to the coordinate plane that the normal is most perpendicular to, keeping orientation.
function planeOf(normal) {
  const [x, y, z] = normal.map(Math.abs);
  const k = x > y ? (x > z ? 0 : 2) : y > z ? 1 : 2;
  const [u, v] = normal[k] >= 0 ? [(k + 1) % 3, (k + 2) % 3] : [(k + 2) % 3, (k + 1) % 3];
  return (point, at = 0) => new Vector2(point[at + u], point[at + v]);
}

function isInside(point, ring) {
  let inside = false;
  for (let i = 0, j = ring.length - 1; i < ring.length; j = i++) {
    const a = ring[i], b = ring[j];
    if (a.y > point.y !== b.y > point.y && point.x < ((b.x - a.x) * (point.y - a.y)) / (b.y - a.y) + a.x) inside = !inside;
  }
  return inside;
}

/// Whether ring `inner` lies inside ring `outer`: by its first corner that is not one of the outer ring's.
function isNested(inner, outer) {
  const probe = inner.find((p) => !outer.some((q) => q.x === p.x && q.y === p.y));
  return probe !== undefined && isInside(probe, outer);
}

class Builder {
  constructor(positions) {
    this.positions = positions;
    this.corners = [];
    this.polygons = [];
    this.masks = [];
  }
  add(a, b, c, polygon, mask) {
    this.corners.push(a, b, c);
    this.polygons.push(polygon);
    this.masks.push(mask);
  }
  /// A quadrilateral by the diagonal that leaves both halves facing the polygon's way, the shorter of two such.
  addQuad(ring, polygon) {
    const p = this.positions;
    const normal = ringNormal(p, ring);
    const worst = (i) => Math.min(...[[i, i + 1, i + 2], [i, i + 2, i + 3]].map((t) => {
      const n = ringNormal(p, t.map((k) => ring[k % 4]));
      return n[0] * normal[0] + n[1] * normal[1] + n[2] * normal[2];
    }));
    const at = worst(0) >= worst(1) ? 0 : 1;
    const [a, b, c, d] = [0, 1, 2, 3].map((k) => ring[(at + k) % 4]);
    this.add(a, b, c, polygon, 0b101);
    this.add(a, c, d, polygon, 0b011);
  }
  /// A ring with rings inside it left out.
  addRings(ring, holes, flat, polygon) {
    const contour = ring.map((v) => flat(this.positions, 3 * v));
    const gaps = holes.map((hole) => hole.map((v) => flat(this.positions, 3 * v)));
    const all = [ring, ...holes];
    const vertices = all.flat();
    // Which corners are neighbours in a ring: those edges are the polygon's.
    const next = [], previous = [];
    let start = 0;
    for (const one of all) {
      for (let i = 0; i < one.length; ++i) {
        next[start + i] = start + ((i + 1) % one.length);
        previous[start + ((i + 1) % one.length)] = start + i;
      }
      start += one.length;
    }
    const isEdge = (i, j) => next[i] === j || previous[i] === j;
    for (const [i, j, k] of ShapeUtils.triangulateShape(contour, gaps))
      this.add(vertices[i], vertices[j], vertices[k], polygon, isEdge(j, k) | (isEdge(k, i) << 1) | (isEdge(i, j) << 2));
  }
}

/// Fills a facet of several rings.
function addFacet(builder, rings, holePoints) {
  const areas = rings.map(({ ring }) => ringNormal(builder.positions, ring));
  const largest = areas.reduce((best, n, i) => (Math.hypot(...n) > Math.hypot(...areas[best]) ? i : best), 0);
  const flat = planeOf(areas[largest]);
  const outlines = rings.map(({ ring }) => ring.map((v) => flat(builder.positions, 3 * v)));
  const parents = outlines.map((inner, i) => {
    let parent = -1, least = Infinity;
    outlines.forEach((outer, j) => {
      const size = Math.hypot(...areas[j]);
      if (i !== j && size < least && isNested(inner, outer)) [parent, least] = [j, size];
    });
    return parent;
  });
  const emptied = new Set();
  for (const point of holePoints) {
    const at = flat(point);
    let innermost = -1, least = Infinity;
    outlines.forEach((outline, i) => {
      const size = Math.hypot(...areas[i]);
      if (size < least && isInside(at, outline)) [innermost, least] = [i, size];
    });
    if (innermost >= 0) emptied.add(innermost);
  }
  rings.forEach(({ ring, polygon }, i) => {
    if (emptied.has(i)) return;
    const inner = rings.filter((_, j) => parents[j] === i).map((child) => child.ring);
    builder.addRings(ring, inner, flat, polygon);
  });
}

/// Unit normals of triangles; without area, 0.
function triangleNormals(p, corners) {
  const normals = new Float32Array(corners.length);
  for (let i = 0; i < corners.length; i += 3) {
    const a = 3 * corners[i], b = 3 * corners[i + 1], c = 3 * corners[i + 2];
    const ux = p[b] - p[a], uy = p[b + 1] - p[a + 1], uz = p[b + 2] - p[a + 2];
    const vx = p[c] - p[a], vy = p[c + 1] - p[a + 1], vz = p[c + 2] - p[a + 2];
    const x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
    const length = Math.sqrt(x * x + y * y + z * z) || 1;
    normals[i] = x / length;
    normals[i + 1] = y / length;
    normals[i + 2] = z / length;
  }
  return normals;
}

/// Of edges as pairs of vertices, those whose connected part is at least so long.
function longParts(positions, pairs, least) {
  const parent = new Map();
  const root = (v) => {
    while (parent.has(v)) v = parent.get(v);
    return v;
  };
  for (let i = 0; i < pairs.length; i += 2) {
    const a = root(pairs[i]), b = root(pairs[i + 1]);
    if (a !== b) parent.set(Math.max(a, b), Math.min(a, b));
  }
  const lengths = new Map();
  for (let i = 0; i < pairs.length; i += 2) {
    const part = root(pairs[i]), a = 3 * pairs[i], b = 3 * pairs[i + 1];
    const length = Math.hypot(positions[a] - positions[b], positions[a + 1] - positions[b + 1], positions[a + 2] - positions[b + 2]);
    lengths.set(part, (lengths.get(part) ?? 0) + length);
  }
  return pairs.filter((v, i) => lengths.get(root(v)) >= least);
}

/// Edges at which a surface bends sharply, ends, or branches, as pairs of vertices. `masks`: which edges are real. Bends whose
/// connected part is shorter than `least` are those of single slivers, and left out.
export function findSharpEdges(positions, corners, masks, least) {
  const halves = corners.length;  // half-edge h is opposite corner h
  const normals = triangleNormals(positions, corners);
  const from = (h) => corners[h - (h % 3) + ((h + 1) % 3)], to = (h) => corners[h - (h % 3) + ((h + 2) % 3)];
  // Half-edges, linked by their smaller vertex.
  const head = new Int32Array(positions.length / 3).fill(-1), link = new Int32Array(halves);
  const other = new Uint32Array(halves);
  for (let h = 0; h < halves; ++h) {
    const a = from(h), b = to(h), low = Math.min(a, b);
    other[h] = Math.max(a, b);
    link[h] = head[low];
    head[low] = h;
  }
  const isReal = (h) => !masks || (masks[(h / 3) | 0] & (1 << h % 3)) !== 0;
  const same = [], bends = [], rims = [];
  const seen = new Uint8Array(halves);
  for (let h = 0; h < halves; ++h) {
    if (seen[h]) continue;
    const low = Math.min(from(h), to(h));
    same.length = 0;
    for (let k = head[low]; k >= 0; k = link[k])
      if (other[k] === other[h]) {
        same.push(k);
        seen[k] = 1;
      }
    if (same.length === 2) {
      const s = same[0] - (same[0] % 3), t = same[1] - (same[1] % 3);
      const flip = from(same[0]) === from(same[1]) ? -1 : 1;
      const cosine = normals[s] * normals[t] + normals[s + 1] * normals[t + 1] + normals[s + 2] * normals[t + 2];
      if (flip * cosine >= FEATURE_COSINE) continue;
    }
    if (same.every(isReal)) (same.length === 2 ? bends : rims).push(from(h), to(h));
  }
  return Uint32Array.from([rims, longParts(positions, bends, least)].flat());
}

/// { corners, polygons, masks, sharp, segments, points }: triangles, the polygon of each, which edges (opposite each corner)
/// are the polygon's, sharp edges; polygons of two corners as segments, of one as points.
export function buildSurface(model) {
  const positions = model.positions, given = model.array('corners');
  const count = model.counts.polygons, degree = model.entry.degree;
  let surface;
  if (degree === 3) {
    surface = { corners: Uint32Array.from(given), polygons: null, masks: new Uint8Array(count).fill(7), segments: [], points: [] };
  } else {
    const offsets = degree ? null : model.array('offsets');
    const facets = model.entry.facets ? model.array('facets') : null;
    const places = model.entry.facet_holes ?? [], owners = model.entry.facet_hole_owners ?? [];
    const builder = new Builder(positions);
    const loose = { segments: [], points: [] };
    const facetCount = facets ? facets.length - 1 : count;
    const holesOf = new Map();
    owners.forEach((facet, i) => holesOf.set(facet, [...(holesOf.get(facet) ?? []), places[i]]));
    for (let f = 0; f < facetCount; ++f) {
      const rings = [];
      for (let p = facets ? facets[f] : f; p < (facets ? facets[f + 1] : f + 1); ++p) {
        const ring = Array.from(offsets ? given.subarray(offsets[p], offsets[p + 1]) : given.subarray(degree * p, degree * (p + 1)));
        if (ring.length === 1) loose.points.push(ring[0]);
        else if (ring.length === 2) loose.segments.push(...ring);
        else if (ring.length > 2) rings.push({ ring, polygon: p });
      }
      const holes = holesOf.get(f) ?? [];
      if (rings.length > 1 || holes.length > 0) addFacet(builder, rings, holes);
      else if (rings.length === 1) {
        const { ring, polygon } = rings[0];
        if (ring.length === 3) builder.add(...ring, polygon, 7);
        else if (ring.length === 4) builder.addQuad(ring, polygon);
        else builder.addRings(ring, [], planeOf(ringNormal(positions, ring)), polygon);
      }
    }
    surface = {
      corners: Uint32Array.from(builder.corners), polygons: Uint32Array.from(builder.polygons),
      masks: Uint8Array.from(builder.masks), ...loose,
    };
  }
  surface.sharp = findSharpEdges(positions, surface.corners, surface.masks, SHORT_BEND * model.radius);
  return surface;
}
