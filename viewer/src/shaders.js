// What the graphics card does: faces with their edges in one pass, lines of constant width on the screen, round points.
// Edges and lines fade where elements are only a few pixels large, so that dense meshes stay calm.

const LIGHT = `
vec3 toLinear(vec3 c) { return pow(c, vec3(2.2)); }
vec3 toGamma(vec3 c) { return pow(clamp(c, 0.0, 1.0), vec3(1.0 / 2.2)); }
`;

/// value: place in [0, 1] of the colour map, or the number of a label; below -1: no value.
const COLOUR = `
uniform sampler2D ramp;
uniform vec2 range;
uniform int colouring;  // 0 plain, 1 colour map, 2 labels
uniform vec3 missing;
vec3 colourOf(float value, vec3 plain) {
  if (colouring == 0) return plain;
  if (value < -1.0) return missing;
  if (colouring == 2) {
    int label = int(value + 0.5);
    return texelFetch(ramp, ivec2(label & 255, label >> 8), 0).rgb;
  }
  float at = clamp((value - range.x) / max(range.y - range.x, 1e-12), 0.0, 1.0);
  return texture(ramp, vec2((at * 255.0 + 0.5) / 256.0, 0.5)).rgb;
}
`;

export const FACE_VERTEX = `
in float value;
in float kind;
out float vValue;
out vec3 vView;
out vec3 vCorner;
flat out int vKind;
void main() {
  vValue = value;
  vKind = int(kind + 0.5);
  int corner = gl_VertexID % 3;
  vCorner = vec3(corner == 0, corner == 1, corner == 2);
  vec4 view = modelViewMatrix * vec4(position, 1.0);
  vView = view.xyz;
  gl_Position = projectionMatrix * view;
}
`;

/// kind: bits 0-2 edges opposite the corners that are to be drawn, 3 a face inside the solid.
export const FACE_FRAGMENT = `
${LIGHT}${COLOUR}
uniform vec3 surface;
uniform vec3 inside;
uniform vec3 line;
uniform float edges;     // how strongly they are drawn
uniform float pixel;     // device pixels per CSS pixel
uniform float glass;     // 1: only the rim is seen
in float vValue;
in vec3 vView;
in vec3 vCorner;
flat in int vKind;
out vec4 colour;
float edgeAt(int bits, float width, vec3 slope) {
  vec3 near = 1.0 - smoothstep(slope * (width - 0.7), slope * (width + 0.7), vCorner);
  vec3 on = vec3(bits & 1, (bits >> 1) & 1, (bits >> 2) & 1);
  near *= on;
  return max(near.x, max(near.y, near.z));
}
void main() {
  vec3 plain = (vKind & 8) != 0 ? inside : surface;
  vec3 base = toLinear(colourOf(vValue, plain));
  vec3 normal = normalize(cross(dFdx(vView), dFdy(vView)));
  if (dot(normal, vView) > 0.0) normal = -normal;
  float key = max(dot(normal, normalize(vec3(-0.4, 0.6, 0.75))), 0.0);
  float fill = max(dot(normal, normalize(vec3(0.8, -0.1, 0.5))), 0.0);
  float shine = pow(max(dot(normal, normalize(normalize(vec3(-0.4, 0.6, 0.75)) - normalize(vView))), 0.0), 40.0);
  vec3 lit = base * (0.34 + 0.62 * key + 0.2 * fill) + 0.035 * shine;
  if (!gl_FrontFacing) lit *= vec3(0.80, 0.74, 0.72);
  vec3 slope = fwidth(vCorner);
  float size = 1.0 / max(max(slope.x, slope.y), max(slope.z, 1e-6)) / pixel;
  vec3 drawn = toGamma(lit);
  if (edges > 0.0) drawn = mix(drawn, line, edges * edgeAt(vKind, 0.55 * pixel, slope) * smoothstep(0.8, 3.0, size));
  float facing = abs(dot(normal, normalize(vView)));
  colour = vec4(drawn, glass > 0.0 ? mix(0.5, 0.1, smoothstep(0.0, 0.75, facing)) : 1.0);
}
`;

export const LINE_VERTEX = `
in vec3 start;
in vec3 end;
in float value;
uniform vec2 viewport;
uniform float width;
uniform float lift;    // share of the distance by which it comes nearer to the eye, so that faces do not cover it
uniform float vanish;
out float vValue;
out float vAcross;
out float vAlpha;
void main() {
  vec4 a = projectionMatrix * vec4((modelViewMatrix * vec4(start, 1.0)).xyz * (1.0 - lift), 1.0);
  vec4 b = projectionMatrix * vec4((modelViewMatrix * vec4(end, 1.0)).xyz * (1.0 - lift), 1.0);
  float at = position.x;
  vec2 along = (b.xy / b.w - a.xy / a.w) * viewport * 0.5;
  float size = length(along);
  along = size > 1e-6 ? along / size : vec2(1.0, 0.0);
  vec4 place = mix(a, b, at);
  float reach = width * 0.5 + 0.75;
  vec2 shift = vec2(-along.y, along.x) * position.y * reach + along * (at * 2.0 - 1.0) * 0.35 * width;
  place.xy += shift / viewport * 2.0 * place.w;
  vValue = value;
  vAcross = position.y * reach;
  vAlpha = vanish > 0.0 ? smoothstep(0.25, 1.0, size / vanish) : 1.0;
  gl_Position = place;
}
`;

export const LINE_FRAGMENT = `
${COLOUR}
uniform vec3 line;
uniform float width;
uniform float opacity;
in float vValue;
in float vAcross;
in float vAlpha;
out vec4 colour;
void main() {
  float cover = clamp(width * 0.5 + 0.5 - abs(vAcross), 0.0, 1.0);
  colour = vec4(colourOf(vValue, line), cover * vAlpha * opacity);
  if (colour.a < 0.02) discard;
}
`;

export const POINT_VERTEX = `
in float value;
uniform float size;
uniform float lift;
out float vValue;
void main() {
  vValue = value;
  gl_Position = projectionMatrix * vec4((modelViewMatrix * vec4(position, 1.0)).xyz * (1.0 - lift), 1.0);
  gl_PointSize = size;
}
`;

export const POINT_FRAGMENT = `
${COLOUR}
uniform vec3 line;
uniform float size;
in float vValue;
out vec4 colour;
void main() {
  float r = length(gl_PointCoord - 0.5) * size;
  float cover = clamp(size * 0.5 - r, 0.0, 1.0);
  if (cover < 0.05) discard;
  vec3 own = colourOf(vValue, line);
  colour = vec4(mix(own * 0.45, own, clamp(size * 0.5 - 1.2 - r + 0.5, 0.0, 1.0)), cover);
}
`;

/// A square that covers the ball on the screen; the ball itself is found by its rays.
export const BALL_VERTEX = `
in vec3 centre;
in float radius;
out vec3 vPlace;
flat out vec3 vCentre;
flat out float vRadius;
flat out vec2 vDepth;
void main() {
  vCentre = (modelViewMatrix * vec4(centre, 1.0)).xyz;
  vRadius = radius;
  vDepth = vec2(projectionMatrix[2][2], projectionMatrix[3][2]);
  float far = length(vCentre);
  vec3 back = -vCentre / far;
  vec3 across = normalize(abs(back.x) < 0.9 ? cross(back, vec3(1.0, 0.0, 0.0)) : cross(back, vec3(0.0, 1.0, 0.0)));
  // The outline of a near ball is wider than its radius.
  float reach = far > 1.01 * radius ? radius * far / sqrt(far * far - radius * radius) : 0.0;
  vPlace = vCentre + reach * ((2.0 * position.x - 1.0) * across + position.y * cross(back, across));
  gl_Position = projectionMatrix * vec4(vPlace, 1.0);
}
`;

export const BALL_FRAGMENT = `
uniform vec3 line;
in vec3 vPlace;
flat in vec3 vCentre;
flat in float vRadius;
flat in vec2 vDepth;
out vec4 colour;
void main() {
  vec3 ray = normalize(vPlace);
  float middle = dot(ray, vCentre);
  float rest = vRadius * vRadius - dot(vCentre, vCentre) + middle * middle;
  if (rest < 0.0) discard;
  vec3 hit = ray * (middle - sqrt(rest));
  float facing = sqrt(rest) / vRadius;
  float shine = pow(max(dot((hit - vCentre) / vRadius, normalize(vec3(-0.4, 0.6, 0.75))), 0.0), 60.0);
  colour = vec4(line + 0.6 * shine, mix(0.75, 0.16, smoothstep(0.0, 0.55, facing)));
  gl_FragDepth = 0.5 - 0.5 * (vDepth.x * hit.z + vDepth.y) / hit.z;
}
`;
