// The state of the page and its form in the address: only what differs from what the page would choose itself.

const OPTIONAL = (text) => (text === '' ? null : text);
const numbers = (text) => {
  const values = text.split(',').map(Number);
  return values.every(Number.isFinite) ? values : undefined;
};

/// Name in the address -> [member, text of a value, value of a text (undefined: not understood)]. `null` means automatic.
const CODES = {
  file: ['file', (v) => String(v + 1), (t) => (/^\d+$/.test(t) ? Number(t) - 1 : undefined)],
  show: ['show', String, (t) => (['solid', 'facets'].includes(t) ? t : undefined)],
  color: ['colour', String, OPTIONAL],
  range: ['range', (v) => v.join(','), (t) => { const v = numbers(t); return v?.length === 2 && v[0] < v[1] ? v : undefined; }],
  map: ['map', String, OPTIONAL],
  edges: ['edges', String, (t) => (['none', 'sharp', 'all'].includes(t) ? t : undefined)],
  segments: ['segments', (v) => (v ? '1' : '0'), (t) => t === '1'],
  points: ['points', (v) => (v ? '1' : '0'), (t) => t === '1'],
  directions: ['directions', (v) => v.join(','), (t) => (t === '' ? [] : t.split(','))],
  on: ['ground', (v) => (v ? String(v) : 'none'), (t) => (t === 'none' ? 0 : /^[1-9]\d*$/.test(t) ? Number(t) : undefined)],
  ground: ['groundAs', String, (t) => (['solid', 'glass'].includes(t) ? t : undefined)],
  balls: ['balls', (v) => (v ? '1' : '0'), (t) => t === '1'],
  density: ['density', String, (t) => (Number(t) >= 0 && Number(t) <= 1 ? Number(t) : undefined)],
  clip: ['clip', (v) => (v ? `${v.axis},${v.at}` : 'off'), (t) => {
    if (t === 'off') return false;
    const [axis, at] = t.split(',');
    const known = /^-?[xyz]$/.test(axis) || axis.split('/').map(Number).filter(Number.isFinite).length === 3;
    return known && Number(at) >= 0 && Number(at) <= 1 ? { axis, at: Number(at) } : undefined;
  }],
  view: ['view', (v) => v.map((x) => Number(x.toFixed(4))).join(','), (t) => {
    const v = numbers(t);
    return v && [2, 3, 6].includes(v.length) ? v : undefined;
  }],
  up: ['up', String, (t) => (['y', 'z'].includes(t) ? t : undefined)],
  theme: ['theme', String, (t) => (['light', 'dark'].includes(t) ? t : undefined)],
  panel: ['panel', (v) => (v ? '1' : '0'), (t) => t === '1'],
  // Without controls and names, for pictures.
  bare: ['bare', (v) => (v ? '1' : '0'), (t) => t === '1'],
};

export function automatic() {
  const state = Object.fromEntries(Object.values(CODES).map(([member]) => [member, null]));
  return Object.assign(state, { file: 0 });
}

export function stateOf(hash) {
  const state = automatic();
  for (const part of hash.replace(/^#/, '').split('&')) {
    const cut = part.indexOf('=');
    const code = CODES[part.slice(0, cut)];
    if (cut < 0 || !code) continue;
    let text;
    try {
      text = decodeURIComponent(part.slice(cut + 1));
    } catch {
      continue;
    }
    const value = code[2](text);
    if (value !== undefined) state[code[0]] = value;
  }
  return state;
}

export function hashOf(state) {
  const parts = [];
  for (const [name, [member, write]] of Object.entries(CODES)) {
    const value = state[member];
    if (value === null || (member === 'file' && value === 0)) continue;
    parts.push(`${name}=${encodeURIComponent(write(value)).replace(/%2C/g, ',').replace(/%2F/g, '/')}`);
  }
  return parts.length ? `#${parts.join('&')}` : '';
}
