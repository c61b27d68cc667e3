// Colours: maps made of a few stops in OKLab (so that equal steps look equal), and palettes for labels.

function toLinear(c) {
  return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
}
function toGamma(c) {
  const x = Math.min(1, Math.max(0, c));
  return x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055;
}

function labOfHex(hex) {
  const [r, g, b] = [1, 3, 5].map((at) => toLinear(parseInt(hex.slice(at, at + 2), 16) / 255));
  const l = Math.cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
  const m = Math.cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
  const s = Math.cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
  return [
    0.2104542553 * l + 0.793617785 * m - 0.0040720468 * s,
    1.9779984951 * l - 2.428592205 * m + 0.4505937099 * s,
    0.0259040371 * l + 0.7827717662 * m - 0.808675766 * s,
  ];
}

function rgbOfLab([lightness, a, b]) {
  const l = (lightness + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (lightness - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (lightness - 0.0894841775 * a - 1.291485548 * b) ** 3;
  return [
    4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
    -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
    -0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s,
  ].map((c) => Math.round(255 * toGamma(c)));
}

/// Ordered from low to high. `diverging` maps are neutral in the middle.
export const MAPS = {
  dusk: { stops: ['#1f2350', '#274f86', '#1f8a96', '#5cbf84', '#c5de6d', '#fbf3a0'] },
  ember: { stops: ['#20173a', '#5c1f60', '#a6305c', '#e0584a', '#f79a52', '#fce7a2'] },
  tide: { stops: ['#16407a', '#3f83bd', '#9fc4de', '#f1f0ec', '#eab596', '#cc6650', '#86203a'], diverging: true },
  grove: { stops: ['#0f4a43', '#3f8f7f', '#a3cdbd', '#f3f1ea', '#dfbd8b', '#b17c3c', '#6a4413'], diverging: true },
  slate: { stops: ['#20262e', '#717c89', '#f2f4f6'] },
};

/// `count` colours of a map as bytes r, g, b, 255.
export function rampOf(name, count) {
  const stops = MAPS[name].stops.map(labOfHex);
  const bytes = new Uint8Array(4 * count);
  for (let i = 0; i < count; ++i) {
    const at = (i / (count - 1)) * (stops.length - 1);
    const k = Math.min(stops.length - 2, Math.floor(at));
    const f = at - k;
    bytes.set([...rgbOfLab(stops[k].map((c, j) => c + f * (stops[k + 1][j] - c))), 255], 4 * i);
  }
  return bytes;
}

export function gradientOf(name) {
  const bytes = rampOf(name, 24);
  const parts = [];
  for (let i = 0; i < 24; ++i) parts.push(`rgb(${bytes[4 * i]},${bytes[4 * i + 1]},${bytes[4 * i + 2]})`);
  return `linear-gradient(to right, ${parts.join(',')})`;
}

const CALM = ['#7fa6c9', '#e3a868', '#86b58b', '#c98aa5', '#a898cf', '#d9c46a', '#6fb5b3', '#c7836a', '#9aa7b4', '#b3c272'];

/// The colour of the i-th label: chosen ones first, then hues a golden angle apart.
export function labelColour(i) {
  if (i < CALM.length) return [1, 3, 5].map((at) => parseInt(CALM[i].slice(at, at + 2), 16));
  const hue = (i * 2.399963229728653) % (2 * Math.PI);
  const lightness = 0.66 + 0.05 * ((i % 5) - 1.5);
  const chroma = 0.075 + 0.02 * (i % 3);
  return rgbOfLab([lightness, chroma * Math.cos(hue), chroma * Math.sin(hue)]);
}

export function css([r, g, b]) {
  return `rgb(${r},${g},${b})`;
}

/// What the numbers of some labels mean, and which of the theme's colours they have.
const MEANINGS = {
  source_kind: { names: { 0: 'input', 1: 'on a segment', 2: 'in a facet' } },
  family: { names: { 1: 'along k_min', 2: 'along k_max' }, colours: { 1: 0, 2: 1 } },
  umbilic_half_turns: { names: { 1: 'wedge', '-1': 'trisector' }, colours: { 1: 3, '-1': 4 } },
  sign: { names: { '-1': 'f < 0', 1: 'f > 0' }, colours: { '-1': 0, 1: 1 } },
  reason: {
    names: {
      1: 'singular', 2: 'meets the box', 3: 'tangent to the box', 4: 'undefined', 5: 'precision', 6: 'budget', 7: 'cancelled',
    },
    colours: { 1: 1 },
  },
};

export function labelName(field, value) {
  const known = MEANINGS[field.name]?.names[value];
  if (known) return known;
  if (field.name === 'umbilic_half_turns') return `index ${value}/2`.replace('-', '−');
  return value === 0 && ['facet', 'segment', 'marker'].includes(field.name) ? 'none' : null;
}

/// The colours of a label's categories; `strong` are those of the theme that stand out from any surface.
export function coloursOf(field, strong) {
  const chosen = MEANINGS[field.name]?.colours ?? {};
  // Faces and places of boxes have one colour, though only places have a 0.
  const byValue = ['cluster', 'reason'].includes(field.name);
  return Array.from(field.categories, (value, i) => strong[chosen[value]] ?? labelColour(byValue ? Math.max(0, value - 1) : i));
}
