// Tetrahedra: which share which triangle, so that the boundary of any set of them can be drawn.

/// Local corners of the face opposite each corner, counter-clockwise seen from outside a positive tetrahedron.
const FACES = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

function sorted(a, b, c) {
  if (a > b) [a, b] = [b, a];
  if (b > c) [b, c] = [c, b];
  if (a > b) [a, b] = [b, a];
  return [a, b, c];
}

export class Solid {
  /// `corners` and `polygonOf` (null: the triangle itself): constraint triangles, which faces are matched with.
  constructor(tetrahedra, positions, surface) {
    this.tetrahedra = tetrahedra;
    this.count = tetrahedra.length / 4;
    const faces = 4 * this.count;
    this.neighbour = new Int32Array(faces).fill(-1);
    this.polygon = new Int32Array(faces).fill(-1);
    const head = new Int32Array(positions.length / 3).fill(-1);
    const link = new Int32Array(faces).fill(-1);
    const find = (a, b, c, from) => {
      for (let k = from; k >= 0; k = link[k]) {
        const [, b2, c2] = sorted(...this.corners(k));
        if (b2 === b && c2 === c) return k;
      }
      return -1;
    };
    for (let face = 0; face < faces; ++face) {
      const [a, b, c] = sorted(...this.corners(face));
      const twin = find(a, b, c, head[a]);
      if (twin >= 0 && this.neighbour[twin] < 0) {
        this.neighbour[face] = twin >> 2;
        this.neighbour[twin] = face >> 2;
      }
      link[face] = head[a];
      head[a] = face;
    }
    const triangles = surface.corners.length / 3;
    for (let t = 0; t < triangles; ++t) {
      const [a, b, c] = sorted(surface.corners[3 * t], surface.corners[3 * t + 1], surface.corners[3 * t + 2]);
      const face = find(a, b, c, head[a]);
      if (face < 0) continue;
      const polygon = surface.polygons ? surface.polygons[t] : t;
      this.polygon[face] = polygon;
      const other = this.neighbour[face];
      if (other < 0) continue;
      for (let i = 0; i < 4; ++i)
        if (this.neighbour[4 * other + i] === face >> 2 && this.isSame(4 * other + i, a, b, c)) this.polygon[4 * other + i] = polygon;
    }
    this.centres = new Float32Array(3 * this.count);
    for (let t = 0; t < this.count; ++t)
      for (let i = 0; i < 4; ++i)
        for (let k = 0; k < 3; ++k) this.centres[3 * t + k] += positions[3 * tetrahedra[4 * t + i] + k] / 4;
  }
  isSame(face, a, b, c) {
    const [a2, b2, c2] = sorted(...this.corners(face));
    return a === a2 && b === b2 && c === c2;
  }
  corners(face) {
    const t = face & ~3, [i, j, k] = FACES[face & 3];
    return [this.tetrahedra[t + i], this.tetrahedra[t + j], this.tetrahedra[t + k]];
  }
  /// The same into an array, without making one.
  writeCorners(face, out, at) {
    const t = face & ~3, order = FACES[face & 3];
    for (let k = 0; k < 3; ++k) out[at + k] = this.tetrahedra[t + order[k]];
  }
  /// Faces of one tetrahedron only, as corners.
  get hull() {
    const corners = [];
    for (let face = 0; face < 4 * this.count; ++face) if (this.neighbour[face] < 0) corners.push(...this.corners(face));
    return Uint32Array.from(corners);
  }
  /// Faces of tetrahedra that are kept, towards one that is not or towards nothing.
  shownFaces(keeps) {
    const kept = new Uint8Array(this.count);
    for (let t = 0; t < this.count; ++t) kept[t] = keeps(this.centres, 3 * t) ? 1 : 0;
    const shown = [];
    for (let face = 0; face < 4 * this.count; ++face) {
      const other = this.neighbour[face];
      if (kept[face >> 2] && (other < 0 || !kept[other])) shown.push(face);
    }
    return { faces: Uint32Array.from(shown), kept };
  }
}
