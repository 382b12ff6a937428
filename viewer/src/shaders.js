// Programs of the graphics card. Each vertex carries its place on both sides as shares of the two frames;
// `side` (0 source, 1 target, between them a straight-line morph) says which place is drawn.

const PLACE = /* glsl */ `
uniform float side;
uniform vec3 sourceScale, sourceOffset, imageScale, imageOffset;
vec3 place(vec3 source, vec3 image) {
  return mix(source * sourceScale + sourceOffset, image * imageScale + imageOffset, side);
}`;

/** Colours of target points, the checkerboard, and the cut; shared by surfaces and lines. */
const TARGET = /* glsl */ `
uniform int target; // 0 square, 1 disk, 2 cube, 3 ball, 4 middle surface of a shell, 5 another section of it
uniform vec3 frameLow, frameSize;
uniform float checks;
uniform int cutSpace; // 0 none, 1 source, 2 target
uniform int cutAxis;  // 3 is the radius
uniform float cutValue, cutSign;

vec3 coordinates(vec3 image) { return frameLow + image * frameSize; }

bool cutAway(vec3 source, vec3 image) {
  if (cutSpace == 0) return false;
  vec3 t = coordinates(image);
  float value = cutAxis == 3 ? length(t) : (cutSpace == 1 ? source[cutAxis] : t[cutAxis]);
  return (value - cutValue) * cutSign > 0.0;
}

vec3 fromOklab(vec3 c) {
  float l = c.x + 0.3963377774 * c.y + 0.2158037573 * c.z;
  float m = c.x - 0.1055613458 * c.y - 0.0638541728 * c.z;
  float s = c.x - 0.0894841775 * c.y - 1.2914855480 * c.z;
  l = l * l * l; m = m * m * m; s = s * s * s;
  return clamp(vec3(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
                    -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
                    -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s), 0.0, 1.0);
}

vec3 centred(vec3 t) {
  if (target >= 4) return 2.0 * (t - frameLow) / max(frameSize, vec3(1e-30)) - 1.0;
  return target == 0 ? vec3(2.0 * t.xy - 1.0, 0.0) : target == 2 ? 2.0 * t - 1.0 : t;
}

vec3 placeColour(vec3 t) {
  vec3 c = centred(t);
  return vec3(0.72 + 0.12 * c.z, 0.105 * c.x, 0.105 * c.y);
}

vec3 encode(vec3 linear) {
  return mix(12.92 * linear, 1.055 * pow(max(linear, vec3(1e-6)), vec3(1.0 / 2.4)) - 0.055, step(0.0031308, linear));
}`;

export const TRIANGLE_VERTEX = /* glsl */ `precision highp float;
in vec3 position, image;
in vec4 normal, imageNormal, shade;
in vec2 weights;
uniform mat4 viewMatrix, projectionMatrix;
out vec3 vSource, vImage, vNormal, vView, vEdge, vWeights;
flat out float vShade;
${PLACE}
void main() {
  vSource = position;
  vImage = image;
  vShade = shade.x;
  vec2 w = 2.0 * weights - 0.5;
  vWeights = vec3(w, 1.0 - w.x - w.y);
  vEdge = vec3(gl_VertexID % 3 == 0, gl_VertexID % 3 == 1, gl_VertexID % 3 == 2);
  vec4 view = viewMatrix * vec4(place(position, image), 1.0);
  vView = -view.xyz;
  vNormal = mat3(viewMatrix) * mix(normal.xyz, imageNormal.xyz, side);
  gl_Position = projectionMatrix * view;
}`;

const TRIANGLE_INPUT = /* glsl */ `precision highp float;
in vec3 vSource, vImage, vNormal, vView, vEdge, vWeights;
flat in float vShade;
${TARGET}`;

export const TRIANGLE_FRAGMENT = /* glsl */ `${TRIANGLE_INPUT}
uniform int skipAxis;   // checkerboard coordinate that is constant here, -1 for none
uniform int colouring;  // 0 checkerboard, 1 plain position, 2 distortion, 3 one colour
uniform float opacity, edges, insideSign;
uniform vec3 edgeColour;
uniform vec4 tint;      // with alpha 1 the colour of a layer
out vec4 colour;

// One factor of a checkerboard, +1 or -1, averaged over the width of a pixel.
float wave(float p, float width) {
  float w = max(width, 1e-4);
  return 2.0 * (abs(fract((p - 0.5 * w) * 0.5) - 0.5) - abs(fract((p + 0.5 * w) * 0.5) - 0.5)) / w;
}

// How much of a pixel belongs to the lines where a weight is 0; lines fade where they would cover all.
float lines(vec3 weights, float reach) {
  vec3 width = fwidth(weights);
  vec3 near = smoothstep(width * 0.3 * reach, width * 1.3 * reach, max(weights, vec3(0.0)));
  float room = clamp(1.5 - 7.0 * max(width.x, max(width.y, width.z)), 0.0, 1.0);
  return (1.0 - min(near.x, min(near.y, near.z))) * room;
}

float checker(vec3 t) {
  vec3 p;
  if (target >= 4) {
    // Lines parallel to the sides cut the prism's triangle into ones that point up and down.
    p = vWeights * checks;
    vec3 w = fwidth(p);
    return wave(p.x, w.x) * wave(p.y, w.y) * wave(p.z, w.z);
  }
  bool round_target = target == 1 || target == 3;
  if (round_target) {
    float r = length(t);
    // On the boundary a plane triangle dips below the sphere; that must not change the square.
    p.x = skipAxis == -2 ? 0.5 : r * checks * 0.5;
    // Half a square further, so that the planes x = 0, y = 0 and z = 0 do not run between squares.
    p.y = (atan(t.y, t.x) / 6.283185307 + 0.5) * checks * 2.0 + 0.5;
    p.z = target == 1 ? 0.5 : acos(clamp(t.z / max(r, 1e-6), -1.0, 1.0)) / 3.141592654 * checks + 0.5;
  } else {
    p = clamp(t, 1e-4, 1.0 - 1e-4) * checks;
    if (target == 0) p.z = 0.5;
  }
  vec3 w = fwidth(p);
  if (round_target) w.y = min(w.y, fwidth(mod(p.y + checks, checks * 2.0))); // no seam where the angle jumps
  float sign_ = 1.0;
  for (int axis = 0; axis < 3; axis++) if (axis != skipAxis) sign_ *= wave(p[axis], w[axis]);
  return sign_;
}

vec3 viridis(float x) {
  vec3 stops[5] = vec3[](vec3(0.267, 0.005, 0.329), vec3(0.231, 0.322, 0.545), vec3(0.129, 0.569, 0.549),
                         vec3(0.369, 0.788, 0.384), vec3(0.992, 0.906, 0.145));
  float s = clamp(x, 0.0, 1.0) * 4.0;
  int i = min(int(s), 3);
  vec3 c = mix(stops[i], stops[i + 1], s - float(i));
  return pow(c, vec3(2.2));
}

void main() {
  if (cutAway(vSource, vImage)) discard;
  vec3 t = coordinates(vImage);
  vec3 base;
  if (tint.a > 0.0) {
    base = tint.rgb;
  } else if (colouring == 2 && vShade >= 0.0) {
    base = vShade > 0.9985 ? vec3(0.75, 0.05, 0.08) : viridis(vShade * 255.0 / 254.0);
  } else if (colouring == 3) {
    base = vec3(0.55, 0.58, 0.62);
  } else {
    vec3 lab = placeColour(t);
    if (colouring == 0) {
      float c = checker(t);
      lab.x += 0.085 * c;
      lab.yz *= 1.0 - 0.12 * c;
    }
    base = fromOklab(lab);
  }
  vec3 normal = normalize(vNormal);
  vec3 view = normalize(vView);
  if (target >= 4 && colouring != 3) base *= 1.0 - 0.8 * lines(vWeights, 1.2);
  bool inside = (gl_FrontFacing ? 1.0 : -1.0) * insideSign < 0.0;
  if (inside) base = mix(base, vec3(dot(base, vec3(0.3, 0.6, 0.1))), 0.55) * 0.7;
  if (dot(normal, view) < 0.0) normal = -normal;
  float key = max(dot(normal, normalize(vec3(-0.35, 0.55, 0.75))), 0.0);
  float fill = max(dot(normal, normalize(vec3(0.7, -0.2, 0.5))), 0.0);
  float gloss = pow(max(dot(normal, normalize(view + vec3(-0.35, 0.55, 0.75))), 0.0), 40.0);
  // Measured colours must stay readable: less shadow, no highlights.
  vec3 lit = colouring == 2 ? base * (0.66 + 0.34 * key) : base * (0.40 + 0.55 * key + 0.20 * fill) + 0.05 * gloss;
  if (edges > 0.0) {
    vec3 width = fwidth(vEdge);
    vec3 near = smoothstep(width * 0.3, width * 1.3, vEdge);
    // Triangles of a few pixels would drown in their edges.
    float room = clamp(1.6 - 4.0 * max(width.x, max(width.y, width.z)), 0.15, 1.0);
    lit = mix(lit, edgeColour, (1.0 - min(near.x, min(near.y, near.z))) * edges * room);
  }
  // A veil is denser where it is seen edge-on, so that the outline stays.
  float veil = opacity >= 1.0 ? 1.0 : mix(min(1.0, opacity * 2.2 + 0.12), opacity, abs(dot(normal, view)));
  colour = vec4(encode(lit), veil);
}`;

export const PICK_FRAGMENT = /* glsl */ `${TRIANGLE_INPUT}
layout(location = 0) out vec4 hitSource;
layout(location = 1) out vec4 hitImage;
void main() {
  if (cutAway(vSource, vImage)) discard;
  hitSource = vec4(vSource, 1.0);
  hitImage = vec4(vImage, 1.0);
}`;

export const SEGMENT_VERTEX = /* glsl */ `precision highp float;
in vec3 position, fromSource, toSource, fromImage, toImage;
uniform mat4 viewMatrix, projectionMatrix;
uniform vec2 resolution;
uniform float width, lift;
out vec3 vSource, vImage;
out float vAcross;
${PLACE}
void main() {
  vec4 a = projectionMatrix * viewMatrix * vec4(place(fromSource, fromImage), 1.0);
  vec4 b = projectionMatrix * viewMatrix * vec4(place(toSource, toImage), 1.0);
  vec2 pa = a.xy / a.w * resolution, pb = b.xy / b.w * resolution;
  vec2 along = pb - pa;
  along = length(along) > 1e-6 ? normalize(along) : vec2(1.0, 0.0);
  vec4 p = mix(a, b, position.x);
  vec2 shift = vec2(-along.y, along.x) * position.y * width + along * (2.0 * position.x - 1.0) * width * 0.4;
  p.xy += shift / resolution * p.w;
  p.z -= lift * p.w;
  vSource = mix(fromSource, toSource, position.x);
  vImage = mix(fromImage, toImage, position.x);
  vAcross = position.y;
  gl_Position = p;
}`;

export const SEGMENT_FRAGMENT = /* glsl */ `precision highp float;
in vec3 vSource, vImage;
in float vAcross;
${TARGET}
uniform vec4 ink; // alpha 0: the colour of the leaf
uniform float depthOfColour;
out vec4 colour;
void main() {
  if (cutAway(vSource, vImage)) discard;
  vec3 base = ink.rgb;
  if (ink.a == 0.0) {
    // Constant along a leaf: the position across the leaves, not along them.
    vec3 t = centred(coordinates(vImage));
    if (target == 1 || target == 3) t = t / max(length(t), 1e-6);
    if (target == 0) t.y = t.x * -0.5;
    if (target == 2) t.z = 0.0;
    base = encode(fromOklab(vec3(depthOfColour + 0.08 * t.z, 0.16 * t.x, 0.16 * t.y)));
  }
  // Darker towards the rim: reads as a thin tube.
  base *= ink.a == 0.0 ? 1.0 - 0.45 * vAcross * vAcross : 1.0;
  colour = vec4(base, ink.a == 0.0 ? 1.0 : ink.a);
}`;
