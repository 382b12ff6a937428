// Everything that is drawn, and how the settings act on it.

import {
  DoubleSide, GLSL3, Group, Mesh, RawShaderMaterial, Scene, Vector2, Vector3, Vector4,
} from 'three';
import { cornerWeights, orientAlike, polylinePairs, segmentGeometry, triangleGeometry } from './geometry.js';
import { section } from './section.js';
import { sourceSpace, targetSpace } from './space.js';
import {
  PICK_FRAGMENT, SEGMENT_FRAGMENT, SEGMENT_VERTEX, TRIANGLE_FRAGMENT, TRIANGLE_VERTEX,
} from './shaders.js';

export const TARGETS = ['square', 'disk', 'cube', 'ball', 'middle surface', 'section'];
export const COLOURINGS = ['checks', 'position', 'distortion', 'plain'];
/** Objects on this layer answer to the pointer. */
export const PICK_LAYER = 1;
/** Width and height of the little picture of the source's axes, in pixels. */
export const AXES_SIZE = 84;
/** Level sets are drawn, and answer to the pointer. */
const LEVEL_LAYERS = 1 | (1 << PICK_LAYER);

/** Colours of the layers of a shell, as shares of 1 of linear light. */
const LAYERS = { bottom: [0.72, 0.3, 0.09], middle: [0.5, 0.52, 0.55], top: [0.1, 0.34, 0.62] };
/** As many divisions of prisms as make about this many triangles of the pattern. */
const PATTERN_TRIANGLES = 12000;

/** Settings and what they are at first. `cut` is `none` or side and axis, for example `target x`. */
export function initialSettings(scene) {
  return {
    opacity: 1, colouring: 'checks', checks: scene.shell ? divisions(scene.shell.prisms) : 8, edges: false,
    coordinate: 'none', allLevels: true, level: 4,
    leaves: false, cut: 'none', cutAt: 0.5, cutFlip: false,
    linked: true, up: 'z', morph: 0,
    isFlat: scene.dimension === 2,
  };
}

function divisions(prisms) {
  return Math.max(2, Math.min(8, Math.round(Math.sqrt(PATTERN_TRIANGLES / prisms))));
}

/** Signed volume of the surface in display coordinates of a side (signed area for the flat target). */
function orientation(points, elements, scale, isFlat) {
  let sum = 0;
  const at = (vertex, axis) => points[3 * vertex + axis] * scale[axis];
  for (let t = 0; t < elements.length; t += 3) {
    const [a, b, c] = [0, 1, 2].map((k) => [0, 1, 2].map((axis) => at(elements[t + k], axis)));
    sum += isFlat
      ? (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
      : a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  return sum < 0 ? -1 : 1;
}

export class Model {
  constructor(scene) {
    this.data = scene;
    this.isFlat = scene.dimension === 2;
    const source = sourceSpace(scene);
    // Both sides of a shell lie in the same place of the same space.
    this.spaces = { source, target: scene.shell ? source : targetSpace(scene) };
    this.root = new Scene();
    this.shared = this.sharedUniforms();
    this.buildSurface();
    this.buildLevels();
    this.buildLeaves();
    this.buildFrames();
    this.section = null;
    this.sectionKey = '';
  }

  sharedUniforms() {
    const { image_frame: image, target } = this.data;
    const vector = (values) => ({ value: new Vector3(...values) });
    return {
      side: { value: 0 },
      sourceScale: vector(this.spaces.source.scale), sourceOffset: vector(this.spaces.source.offset),
      imageScale: vector(this.spaces.target.scale), imageOffset: vector(this.spaces.target.offset),
      target: { value: TARGETS.indexOf(target) },
      frameLow: vector(image.low), frameSize: vector(image.high.map((value, axis) => value - image.low[axis])),
      checks: { value: 8 }, colouring: { value: 0 }, edgeColour: vector([0.02, 0.03, 0.05]),
      cutSpace: { value: 0 }, cutAxis: { value: 0 }, cutValue: { value: 0 }, cutSign: { value: 1 },
      resolution: { value: new Vector2(1, 1) },
    };
  }

  triangleMaterial(own = {}) {
    const values = { skipAxis: -1, opacity: 1, edges: 0, insideSign: 0, tint: new Vector4(0, 0, 0, 0), ...own };
    const uniforms = { ...this.shared };
    for (const [name, value] of Object.entries(values)) uniforms[name] = { value };
    return new RawShaderMaterial({
      glslVersion: GLSL3, vertexShader: TRIANGLE_VERTEX, fragmentShader: TRIANGLE_FRAGMENT, uniforms, side: DoubleSide,
      // Lines that lie in a surface must win over it.
      polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
    });
  }

  segmentMaterial(ink, width, lift = 0.0002, own = {}) {
    return new RawShaderMaterial({
      glslVersion: GLSL3, vertexShader: SEGMENT_VERTEX, fragmentShader: SEGMENT_FRAGMENT, side: DoubleSide,
      uniforms: {
        ...this.shared, ink: { value: new Vector4(...ink) }, width: { value: width }, lift: { value: lift },
        depthOfColour: { value: 0.6 }, ...own,
      },
      transparent: ink[3] > 0 && ink[3] < 1,
    });
  }

  add(geometry, material, { pickable = false, parent = this.root } = {}) {
    const mesh = new Mesh(geometry, material);
    mesh.frustumCulled = false; // Bounds depend on the side that is drawn.
    if (pickable) mesh.layers.enable(PICK_LAYER);
    parent.add(mesh);
    return mesh;
  }

  buildSurface() {
    const { vertices, surface, distortion, weights } = this.data;
    const geometry = triangleGeometry(vertices, surface, this.spaces, distortion, weights);
    this.surface = this.add(geometry, this.triangleMaterial({ skipAxis: this.data.target === 'ball' ? -2 : -1 }), { pickable: true });
    this.surface.renderOrder = 10;
    // Orientation of the surface on both sides tells inside from outside. That of a shell is given.
    this.insideSigns = this.data.shell ? [1, 1] : this.isFlat
      ? [1, orientation(vertices.image, surface, this.spaces.target.scale, true)]
      : [
          orientation(vertices.source, surface, this.spaces.source.scale, false),
          orientation(vertices.image, surface, this.spaces.target.scale, false),
        ];
  }

  buildLevels() {
    if (this.data.shell) {
      this.buildLayers();
      return;
    }
    this.levels = this.data.levels.map((level) => {
      const mesh = this.isFlat
        ? this.add(segmentGeometry(level.points, level.elements), this.segmentMaterial([0, 0, 0, 0.999], 1.4))
        : this.add(
            triangleGeometry(level.points, orientAlike(level.elements), this.spaces, null),
            this.triangleMaterial({ skipAxis: level.checker_axis }),
            { pickable: true },
          );
      mesh.visible = false;
      return { coordinate: level.coordinate, label: level.label, mesh };
    });
  }

  /** Bottom, middle and top of a shell, one triangle per prism on each. */
  buildLayers() {
    this.levels = this.data.levels.map(({ coordinate, label, points, elements }) => {
      const tint = new Vector4(...LAYERS[coordinate], 1);
      const geometry = triangleGeometry(points, elements, this.spaces, null, cornerWeights);
      const mesh = this.add(geometry, this.triangleMaterial({ tint, insideSign: 1 }), { pickable: true });
      mesh.visible = false;
      return { coordinate, label, mesh };
    });
  }

  buildLeaves() {
    const { leaves } = this.data;
    if (!leaves) return;
    this.leaves = this.add(segmentGeometry(leaves.points, polylinePairs(leaves.starts)), this.segmentMaterial([0, 0, 0, 0], 2.2));
    this.leaves.visible = false;
  }

  /** Outline of the target, and the directions of the source's axes as a scene of its own. */
  buildFrames() {
    this.frame = new Group();
    this.axes = new Scene();
    this.root.add(this.frame);
    const corner = (n) => [n & 1, (n >> 1) & 1, (n >> 2) & 1];
    const edges = [];
    const hasOutline = !this.data.shell;
    for (let n = 0; n < 8; n++) for (const bit of [1, 2, 4]) if (!(n & bit)) edges.push([corner(n), corner(n | bit)]);
    const isRound = this.data.target === 'disk' || this.data.target === 'ball';
    const { low, high } = this.data.image_frame;
    const share = (t) => t.map((value, axis) => (high[axis] > low[axis] ? (value - low[axis]) / (high[axis] - low[axis]) : 0));
    const box = edges.filter(([a, b]) => !this.isFlat || (a[2] === 0 && b[2] === 0)).map((edge) => edge.map(share));
    const circle = (u, v) => Array.from({ length: 96 }, (_, i) => [i, i + 1].map((j) => {
      const angle = (j * Math.PI) / 48;
      const t = [0, 0, 0];
      t[u] = Math.cos(angle);
      t[v] = Math.sin(angle);
      return share(t);
    }));
    const circles = this.isFlat ? circle(0, 1) : [...circle(0, 1), ...circle(0, 2), ...circle(1, 2)];
    this.frameInk = [];
    if (hasOutline) this.addFrame(isRound ? circles : box, this.frame, { cutSpace: { value: 0 } });
    const still = { cutSpace: { value: 0 }, side: { value: 0 }, resolution: { value: new Vector2(AXES_SIZE, AXES_SIZE) } };
    const unit = { sourceScale: { value: new Vector3(1, 1, 1) }, sourceOffset: { value: new Vector3(0, 0, 0) } };
    this.addFrame([0, 1, 2].map((axis) => [[0, 0, 0], corner(1 << axis)]), this.axes, { ...still, ...unit });
  }

  addFrame(pairs, parent, own) {
    const points = new Float32Array(pairs.flat(2));
    const indices = Uint32Array.from({ length: pairs.length * 2 }, (_, i) => i);
    const material = this.segmentMaterial([0.5, 0.5, 0.5, 0.75], 1.2, 0, own);
    this.frameInk.push(material);
    this.add(segmentGeometry({ source: points, image: points }, indices), material, { parent });
  }

  /** Colours that follow the page's theme, as three shares of 1 in the page's colour space. */
  setInk(ink) {
    for (const material of this.frameInk) material.uniforms.ink.value.set(...ink, material.uniforms.ink.value.w);
    if (this.isFlat) for (const level of this.levels) level.mesh.material.uniforms.ink.value.set(0.06, 0.07, 0.1, 0.999);
  }

  apply(settings) {
    const { shared, surface } = this;
    shared.checks.value = settings.checks;
    shared.colouring.value = COLOURINGS.indexOf(settings.colouring);
    surface.material.uniforms.opacity.value = settings.opacity;
    surface.material.uniforms.edges.value = settings.edges ? 0.75 : 0;
    surface.visible = settings.opacity > 0;
    const isVeil = settings.opacity < 1;
    if (surface.material.transparent !== isVeil) {
      surface.material.transparent = isVeil;
      surface.material.depthWrite = !isVeil;
      surface.material.needsUpdate = true;
    }
    const coordinates = this.data.coordinates;
    for (const name of coordinates) {
      const family = this.levels.filter((level) => level.coordinate === name);
      const chosen = Math.min(family.length - 1, Math.round(((settings.level - 1) / 6) * (family.length - 1)));
      family.forEach((level, index) => {
        const named = settings.coordinate === 'all' || settings.coordinate === name || (settings.coordinate === 'outer' && name !== 'middle');
        level.mesh.visible = named && (settings.allLevels || index === chosen);
      });
    }
    if (this.leaves) this.leaves.visible = settings.leaves;
    this.applyCut(settings);
    // A faint veil must not keep the pointer from what lies inside.
    const inner = !this.isFlat && (this.levels.some((level) => level.mesh.visible) || this.section?.visible);
    if (inner && settings.opacity < 0.5) surface.layers.disable(PICK_LAYER);
    else surface.layers.enable(PICK_LAYER);
  }

  applyCut(settings) {
    const { shared } = this;
    if (settings.cut === 'none') {
      shared.cutSpace.value = 0;
      if (this.section) this.section.visible = false;
      return;
    }
    const [space, axisName] = settings.cut.split(' ');
    const axis = ['x', 'y', 'z', 'radius'].indexOf(axisName);
    const range = this.cutRange(settings);
    const position = range[0] + settings.cutAt * (range[1] - range[0]);
    shared.cutSpace.value = space === 'source' ? 1 : 2;
    shared.cutAxis.value = axis;
    shared.cutValue.value = space === 'source' ? settings.cutAt : position;
    shared.cutSign.value = settings.cutFlip ? -1 : 1;
    // A veil is there to look inside, which a section would close again.
    if (!this.isFlat && this.data.volume && settings.opacity >= 0.5) this.updateSection(space, axis, position, settings);
    else if (this.section) this.section.visible = false;
  }

  /** Lowest and highest position of the cut, in the coordinates of its side. */
  cutRange(settings) {
    const [space, axisName] = settings.cut.split(' ');
    if (axisName === 'radius') return [0, 1];
    const axis = ['x', 'y', 'z'].indexOf(axisName);
    const frame = space === 'source' ? this.data.source_frame : this.data.image_frame;
    return [frame.low[axis], frame.high[axis]];
  }

  updateSection(space, axis, position, settings) {
    const key = `${settings.cut} ${settings.cutAt}`;
    if (key !== this.sectionKey) {
      this.sectionKey = key;
      const { vertices, image_frame: frame } = this.data;
      const coordinate = (vertex, k) => frame.low[k] + (vertices.image[3 * vertex + k] / 65535) * (frame.high[k] - frame.low[k]);
      const value = axis === 3
        ? (vertex) => Math.hypot(coordinate(vertex, 0), coordinate(vertex, 1), coordinate(vertex, 2)) - position
        : space === 'source'
          ? (vertex) => vertices.source[3 * vertex + axis] - settings.cutAt * 65535
          : (vertex) => vertices.image[3 * vertex + axis] - settings.cutAt * 65535;
      this.replaceSection(section(this.data, value));
    }
    const isBox = this.data.target === 'cube';
    const uniforms = this.section.material.uniforms;
    uniforms.skipAxis.value = space === 'target' && (isBox || axis === 3) ? (axis === 3 ? 0 : axis) : -1;
    uniforms.edges.value = settings.edges ? 0.75 : 0;
    this.section.visible = true;
  }

  replaceSection(points) {
    const elements = Uint32Array.from({ length: points.source.length / 3 }, (_, i) => i);
    const geometry = triangleGeometry(points, elements, this.spaces, null);
    if (!this.section) {
      // Lies on the cut itself, so the cut must not remove it.
      this.section = this.add(geometry, this.triangleMaterial(), { pickable: true });
      this.section.material.uniforms.cutSpace = { value: 0 };
      return;
    }
    this.section.geometry.dispose();
    this.section.geometry = geometry;
  }

  /** Prepares the scene for drawing a side; `morph` moves the source towards the target. */
  setSide(side, morph, width, height) {
    this.shared.side.value = side === 0 ? morph : 1;
    this.shared.resolution.value.set(width, height);
    this.frame.visible = side === 1 || morph >= 0.5;
    // The target's side is the middle layer, but for a map onto another section.
    if (this.data.shell) for (const { coordinate, mesh } of this.levels) mesh.layers.mask = coordinate === 'middle' && side === 1 && this.data.target === 'middle surface' ? 0 : LEVEL_LAYERS;
    this.surface.material.uniforms.insideSign.value = this.insideSigns[side === 0 && morph < 0.5 ? 0 : 1];
  }

  pickMaterial() {
    return new RawShaderMaterial({
      glslVersion: GLSL3, vertexShader: TRIANGLE_VERTEX, fragmentShader: PICK_FRAGMENT, uniforms: this.shared, side: DoubleSide,
    });
  }
}
