// Tetrahedra: which share which triangle, so that the boundary of any set of them can be drawn.

/// Local corners of the face opposite each corner, counter-clockwise seen from outside a positive tetrahedron.
const FACES = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

/// Triangles by their three vertices in any order: chains of those with the same lowest one.
class FaceTable {
  constructor(vertices, faces) {
    this.head = new Int32Array(vertices).fill(-1);
    this.link = new Int32Array(faces).fill(-1);
    this.middle = new Uint32Array(faces);
    this.highest = new Uint32Array(faces);
  }
  /// The face of the chain from `from` on with these two other vertices, or -1.
  follow(from, middle, highest) {
    let k = from;
    while (k >= 0 && (this.middle[k] !== middle || this.highest[k] !== highest)) k = this.link[k];
    return k;
  }
  /// The last face that was added with these vertices, or -1.
  find(a, b, c) {
    const low = Math.min(a, b, c), high = Math.max(a, b, c);
    return this.follow(this.head[low], a + b + c - low - high, high);
  }
  /// Another face with the vertices of one that was added, or -1.
  findAnother(face) {
    return this.follow(this.link[face], this.middle[face], this.highest[face]);
  }
  add(face, a, b, c) {
    const low = Math.min(a, b, c), high = Math.max(a, b, c);
    this.middle[face] = a + b + c - low - high;
    this.highest[face] = high;
    this.link[face] = this.head[low];
    this.head[low] = face;
  }
}

export class Solid {
  /// `corners` and `polygonOf` (null: the triangle itself): constraint triangles, which faces are matched with.
  constructor(tetrahedra, positions, surface) {
    this.tetrahedra = tetrahedra;
    this.count = tetrahedra.length / 4;
    const faces = 4 * this.count;
    this.neighbour = new Int32Array(faces).fill(-1);
    this.polygon = new Int32Array(faces).fill(-1);
    const table = new FaceTable(positions.length / 3, faces);
    const corners = [0, 0, 0];
    for (let face = 0; face < faces; ++face) {
      this.writeCorners(face, corners, 0);
      table.add(face, ...corners);
      const twin = table.findAnother(face);
      if (twin >= 0 && this.neighbour[twin] < 0) {
        this.neighbour[face] = twin >> 2;
        this.neighbour[twin] = face >> 2;
      }
    }
    const triangles = surface.corners.length / 3;
    for (let t = 0; t < triangles; ++t) {
      const polygon = surface.polygons ? surface.polygons[t] : t;
      let face = table.find(surface.corners[3 * t], surface.corners[3 * t + 1], surface.corners[3 * t + 2]);
      for (; face >= 0; face = table.findAnother(face)) this.polygon[face] = polygon;
    }
    this.centres = new Float32Array(3 * this.count);
    for (let t = 0; t < this.count; ++t)
      for (let i = 0; i < 4; ++i)
        for (let k = 0; k < 3; ++k) this.centres[3 * t + k] += positions[3 * tetrahedra[4 * t + i] + k] / 4;
  }
  /// The corners of a face, into an array.
  writeCorners(face, out, at) {
    const t = face & ~3, order = FACES[face & 3];
    for (let k = 0; k < 3; ++k) out[at + k] = this.tetrahedra[t + order[k]];
  }
  /// Faces of one tetrahedron only, as corners.
  get hull() {
    const faces = [];
    for (let face = 0; face < 4 * this.count; ++face) if (this.neighbour[face] < 0) faces.push(face);
    const corners = new Uint32Array(3 * faces.length);
    faces.forEach((face, i) => this.writeCorners(face, corners, 3 * i));
    return corners;
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
