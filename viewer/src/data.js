// Reads what the command embedded in the page: a manifest (JSON) and arrays (base64, little-endian).
// Positions are single precision in a box around the origin: input = origin + scale * position. Everything else has
// the smallest type that holds its numbers exactly.

const FEW_FACETS = 500;
const TYPES = {
  u8: Uint8Array, u16: Uint16Array, u32: Uint32Array, i32: Int32Array,
  f32: Float32Array, f64: Float64Array, i64: BigInt64Array,
};

function decodeBase64(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

/// The array that a reference { id, type, count } of the manifest stands for.
function readArray(reference) {
  const text = document.getElementById(`certa-array-${reference.id}`).textContent;
  const bytes = decodeBase64(text);
  const Type = TYPES[reference.type];
  if (bytes.byteLength !== reference.count * Type.BYTES_PER_ELEMENT)
    throw new Error(`array ${reference.id} is damaged: ${bytes.byteLength} bytes for ${reference.count} numbers`);
  const array = new Type(bytes.buffer, bytes.byteOffset, reference.count);
  return reference.type === 'i64' ? Float64Array.from(array, Number) : array;
}

/// A field whose values are decoded when they are first needed.
class Field {
  constructor(entry, key) {
    Object.assign(this, entry);
    this.key = key;
  }
  get values() {
    this.decoded ??= readArray(this.array);
    return this.decoded;
  }
  get isLabel() {
    return this.kind === 'label' && this.components === 1;
  }
  get isVector() {
    return this.components === 3;
  }
  /// The label whose vertices are not shown as points: those of the input, or of no umbilic, say nothing.
  get hides() {
    return ['source_kind', 'umbilic_half_turns', 'cluster', 'reason', 'sign'].includes(this.name) && this.location === 'vertices' ? 0 : null;
  }
  /// Distinct values in ascending order, for labels.
  get categories() {
    this.distinct ??= Float64Array.from(new Set(this.values)).sort();
    return this.distinct;
  }
  /// Position of each value in `categories`.
  get ranks() {
    if (!this.ranked) {
      const places = new Map();
      this.categories.forEach((value, i) => places.set(value, i));
      this.ranked = Uint32Array.from(this.values, (value) => places.get(value));
    }
    return this.ranked;
  }
  /// The middle 96 % of the values, from a sample: what the colours cover at first.
  get bulk() {
    if (!this.sampled) {
      const step = Math.max(1, Math.floor(this.values.length / 20000));
      const sample = [];
      for (let i = 0; i < this.values.length; i += step) if (Number.isFinite(this.values[i])) sample.push(this.values[i]);
      sample.sort((a, b) => a - b);
      const at = (share) => sample[Math.min(sample.length - 1, Math.floor(share * sample.length))];
      this.sampled = sample.length ? [at(0.02), at(0.98)] : [0, 1];
    }
    return this.sampled;
  }
}

/// One file of the page.
export class Model {
  constructor(entry, index) {
    this.entry = entry;
    this.index = index;
    this.name = entry.name;
    this.remark = entry.remark ?? '';
    const named = new Map();
    this.fields = entry.fields.map((field) => {
      // Two fields of one name differ in what they are given on.
      const key = named.has(field.name) ? `${field.name}@${field.location}` : field.name;
      named.set(field.name, true);
      return new Field(field, key);
    });
    this.counts = { vertices: entry.positions.count / 3, ...entry.counts };
    this.addFacets();
  }
  /// Facets of an input have no field: their numbers, where few enough to be told apart.
  addFacets() {
    const { polygons, triangles, facets = polygons, tetrahedra } = this.counts;
    if (facets < 2 || tetrahedra > 0 || (polygons === triangles && facets > FEW_FACETS)) return;
    if (this.fields.some((field) => field.name === 'facet' && field.location === 'polygons')) return;
    const field = new Field({ name: 'facet', location: 'polygons', components: 1, kind: 'label', min: 1, max: facets }, 'facet');
    const offsets = this.entry.facets ? this.array('facets') : null;
    field.decoded = new Uint32Array(polygons);
    for (let f = 0; f < facets; ++f) field.decoded.fill(f + 1, offsets ? offsets[f] : f, offsets ? offsets[f + 1] : f + 1);
    this.fields.push(field);
  }
  array(name) {
    this.arrays ??= {};
    return (this.arrays[name] ??= this.entry[name] ? readArray(this.entry[name]) : new Uint32Array(0));
  }
  get positions() {
    return this.array('positions');
  }
  get tetrahedra() {
    return this.array('tetrahedra');
  }
  get hasSolid() {
    return this.counts.tetrahedra > 0;
  }
  get hasSurface() {
    return this.counts.polygons > 0;
  }
  /// Of a ball around the middle of the box that holds the model, in the units of `positions`.
  get radius() {
    if (this.reach === undefined) {
      // Stray points may lie outside the box, which is that of the elements.
      const corner = Math.hypot(...this.halfExtents), p = this.positions;
      let most = 0;
      for (let i = 0; i < p.length; i += 3) most = Math.max(most, p[i] * p[i] + p[i + 1] * p[i + 1] + p[i + 2] * p[i + 2]);
      this.reach = Math.min(corner, Math.sqrt(most)) || 1;
    }
    return this.reach;
  }
  /// Boxes and lines say more on the surface that they belong to than alone.
  get wantsGround() {
    return this.entry.overlay === true || !(this.hasSolid || this.hasSurface);
  }
  /// Takes a place of another model to this one's: p -> shift + factor p.
  mapFrom(other) {
    const { origin, scale } = this.entry;
    return { shift: other.entry.origin.map((x, i) => (x - origin[i]) / scale), factor: other.entry.scale / scale };
  }
  /// A label of vertices that stand out whatever the colours show: umbilics, places of boxes.
  get marks() {
    const names = this.entry.overlay ? ['cluster', 'reason'] : ['umbilic_half_turns'];
    return this.fields.find((field) => field.location === 'vertices' && field.isLabel && names.includes(field.name)) ?? null;
  }
  /// The file's name up to its extension.
  get stem() {
    return this.name.replace(/\.[^.]*$/, '');
  }
  /// Vertices with a protecting ball.
  get balls() {
    return this.fields.find((field) => field.name === 'ball_radius' && field.location === 'vertices' && field.components === 1 && field.max > 0) ?? null;
  }
  get halfExtents() {
    const { lower, upper, scale } = this.entry;
    return lower.map((low, i) => (upper[i] / 2 - low / 2) / scale);
  }
  /// Whether all that it has lies in one place.
  get isPoint() {
    return this.halfExtents.every((half) => half === 0);
  }
  /// A point in the input's unit.
  place(x, y, z) {
    const { origin, scale } = this.entry;
    return [origin[0] + scale * x, origin[1] + scale * y, origin[2] + scale * z];
  }
  field(key) {
    return this.fields.find((field) => field.key === key);
  }
}

export function readPage() {
  const manifest = JSON.parse(document.getElementById('certa-manifest').textContent);
  return { title: manifest.title, up: manifest.up ?? 'z', models: manifest.models.map((entry, i) => new Model(entry, i)) };
}
