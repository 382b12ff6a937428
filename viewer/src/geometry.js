// Buffers for the graphics card. Triangles do not share corners, so that each triangle has its own
// shade and edges can be drawn by the fragment shader.

import { BufferAttribute, BufferGeometry, InstancedBufferAttribute, InstancedBufferGeometry } from 'three';

const CREASE_COSINE = Math.cos((40 * Math.PI) / 180);

function gather(values, elements, width) {
  const out = new values.constructor(elements.length * width);
  for (let corner = 0; corner < elements.length; corner++) {
    const from = elements[corner] * width;
    for (let k = 0; k < width; k++) out[corner * width + k] = values[from + k];
  }
  return out;
}

/** Normals per corner: smooth across soft edges, flat across creases. Stretched axes are taken into account. */
function cornerNormals(points, elements, scale) {
  const faces = new Float32Array(elements.length);
  const sums = new Float32Array(points.length);
  const at = (vertex, axis) => points[3 * vertex + axis] * scale[axis];
  for (let t = 0; t < elements.length; t += 3) {
    const [a, b, c] = [elements[t], elements[t + 1], elements[t + 2]];
    const u = [0, 1, 2].map((axis) => at(b, axis) - at(a, axis));
    const v = [0, 1, 2].map((axis) => at(c, axis) - at(a, axis));
    for (let axis = 0; axis < 3; axis++) {
      const [j, k] = [(axis + 1) % 3, (axis + 2) % 3];
      const area = u[j] * v[k] - u[k] * v[j];
      faces[t + axis] = area;
      for (const vertex of [a, b, c]) sums[3 * vertex + axis] += area;
    }
  }
  const out = new Int8Array(elements.length * 4);
  for (let corner = 0; corner < elements.length; corner++) {
    const face = faces.subarray(corner - (corner % 3), corner - (corner % 3) + 3);
    const sum = sums.subarray(3 * elements[corner], 3 * elements[corner] + 3);
    const lengths = Math.hypot(...face) * Math.hypot(...sum);
    const cosine = (face[0] * sum[0] + face[1] * sum[1] + face[2] * sum[2]) / (lengths || 1);
    const normal = cosine > CREASE_COSINE ? sum : face;
    const length = Math.hypot(...normal) || 1;
    for (let axis = 0; axis < 3; axis++) out[4 * corner + axis] = Math.round((127 * normal[axis]) / length);
  }
  return out;
}

/** Level sets come unordered; neighbours are turned alike so that smooth normals do not cancel. */
export function orientAlike(elements) {
  const turned = Uint32Array.from(elements);
  const count = turned.length / 3;
  const byEdge = new Map();
  const bound = turned.reduce((most, vertex) => Math.max(most, vertex), 0) + 1;
  const key = (a, b) => Math.min(a, b) * bound + Math.max(a, b);
  for (let t = 0; t < count; t++) {
    for (let k = 0; k < 3; k++) {
      const edge = key(turned[3 * t + k], turned[3 * t + ((k + 1) % 3)]);
      if (byEdge.has(edge)) byEdge.get(edge).push(t);
      else byEdge.set(edge, [t]);
    }
  }
  const runs = (t, a, b) => [0, 1, 2].some((k) => turned[3 * t + k] === a && turned[3 * t + ((k + 1) % 3)] === b);
  const seen = new Uint8Array(count);
  for (let start = 0; start < count; start++) {
    if (seen[start]) continue;
    seen[start] = 1;
    const stack = [start];
    while (stack.length) {
      const t = stack.pop();
      for (let k = 0; k < 3; k++) {
        const [a, b] = [turned[3 * t + k], turned[3 * t + ((k + 1) % 3)]];
        for (const other of byEdge.get(key(a, b))) {
          if (seen[other]) continue;
          seen[other] = 1;
          if (runs(other, a, b)) [turned[3 * other], turned[3 * other + 1]] = [turned[3 * other + 1], turned[3 * other]];
          stack.push(other);
        }
      }
    }
  }
  return turned;
}

/** Barycentric weights from -0.5 to 1.5 as the page holds them: one corner has 1, the others have 0. */
const [WEIGHT_0, WEIGHT_1] = [16384, 49151];

/** In place of weights per vertex: those of the corners of each triangle in itself. */
export const cornerWeights = Symbol('corner weights');

function weightsOf(weights, elements) {
  if (weights !== cornerWeights) return gather(weights, elements, 2);
  const out = new Uint16Array(elements.length * 2).fill(WEIGHT_0);
  for (let corner = 0; corner < elements.length; corner++) if (corner % 3 < 2) out[2 * corner + (corner % 3)] = WEIGHT_1;
  return out;
}

/** Triangles; `shades` holds one byte per triangle, `weights` two barycentric weights in a prism per vertex. */
export function triangleGeometry(points, elements, spaces, shades, weights = null) {
  const geometry = new BufferGeometry();
  const normalized = !(points.source instanceof Float32Array);
  const add = (name, array, width, isShare) => geometry.setAttribute(name, new BufferAttribute(array, width, isShare));
  add('position', gather(points.source, elements, 3), 3, normalized);
  add('image', gather(points.image, elements, 3), 3, normalized);
  add('normal', cornerNormals(points.source, elements, spaces.source.scale), 4, true);
  add('imageNormal', cornerNormals(points.image, elements, spaces.target.scale), 4, true);
  const shade = new Uint8Array(elements.length * 4);
  if (shades) for (let corner = 0; corner < elements.length; corner++) shade[4 * corner] = shades[Math.floor(corner / 3)];
  add('shade', shade, 4, true);
  if (weights) add('weights', weightsOf(weights, elements), 2, true);
  return geometry;
}

/** Segments as screen-space ribbons: `pairs` lists the two ends of each. */
export function segmentGeometry(points, pairs) {
  const geometry = new InstancedBufferGeometry();
  const normalized = !(points.source instanceof Float32Array);
  const ends = [0, 1].map((end) => Uint32Array.from({ length: pairs.length / 2 }, (_, i) => pairs[2 * i + end]));
  ends.forEach((end, number) => {
    const name = ['from', 'to'][number];
    geometry.setAttribute(`${name}Source`, new InstancedBufferAttribute(gather(points.source, end, 3), 3, normalized));
    geometry.setAttribute(`${name}Image`, new InstancedBufferAttribute(gather(points.image, end, 3), 3, normalized));
  });
  geometry.setAttribute('position', new BufferAttribute(new Float32Array([0, -1, 0, 0, 1, 0, 1, -1, 0, 1, 1, 0]), 3));
  geometry.setIndex([0, 2, 1, 1, 2, 3]);
  geometry.instanceCount = pairs.length / 2;
  return geometry;
}

/** Ends of the segments of polylines that start at `starts[i]`; the last entry is the number of points. */
export function polylinePairs(starts) {
  const pairs = [];
  for (let leaf = 0; leaf + 1 < starts.length; leaf++) {
    for (let point = starts[leaf]; point + 1 < starts[leaf + 1]; point++) pairs.push(point, point + 1);
  }
  return pairs;
}
