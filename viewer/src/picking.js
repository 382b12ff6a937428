// What lies under the pointer: one pixel is drawn with both places of the point as its colour, so that
// whatever is visible (cut, sections, level sets) answers, without searching the mesh.

import { FloatType, NearestFilter, Vector3, WebGLRenderTarget } from 'three';
import { PICK_LAYER } from './model.js';
import { fromShares } from './data.js';
import { toDisplay } from './space.js';
import { number } from './format.js';

export class Picker {
  constructor(views, model) {
    this.views = views;
    this.model = model;
    this.material = model.pickMaterial();
    this.isAvailable = Boolean(views.renderer.extensions.get('EXT_color_buffer_float'));
    this.target = new WebGLRenderTarget(1, 1, {
      count: 2, type: FloatType, minFilter: NearestFilter, magFilter: NearestFilter, generateMipmaps: false,
    });
    this.buffers = [new Float32Array(4), new Float32Array(4)];
  }

  /** Places (shares of both frames) of the point seen at a pixel of a pane, or null. */
  at(pane, x, y) {
    if (!this.isAvailable) return null;
    const { renderer, settings } = this.views;
    const { model, target } = this;
    const { clientWidth: width, clientHeight: height } = pane.element;
    const { camera } = pane;
    camera.setViewOffset(width, height, Math.floor(x), Math.floor(y), 1, 1);
    const layers = camera.layers.mask;
    camera.layers.set(PICK_LAYER);
    model.setSide(pane.side, settings.morph, width, height);
    model.root.overrideMaterial = this.material;
    renderer.setScissorTest(false);
    renderer.setRenderTarget(target);
    renderer.setClearColor(0x000000, 0);
    renderer.clear();
    renderer.render(model.root, camera);
    this.buffers.forEach((buffer, index) => renderer.readRenderTargetPixels(target, 0, 0, 1, 1, buffer, undefined, index));
    renderer.setRenderTarget(null);
    renderer.setScissorTest(true);
    model.root.overrideMaterial = null;
    camera.layers.mask = layers;
    camera.clearViewOffset();
    const [source, image] = this.buffers.map((buffer) => Array.from(buffer));
    return source[3] > 0.5 ? { source: source.slice(0, 3), image: image.slice(0, 3) } : null;
  }
}

/** Rings on both panes and the read-out below them. */
export class Probe {
  constructor(views, model, picker) {
    Object.assign(this, { views, model, picker, hit: null });
    this.rings = views.panes.map((pane) => {
      const ring = document.createElement('div');
      ring.className = 'ring';
      ring.hidden = true;
      pane.element.append(ring);
      return ring;
    });
    this.readouts = views.panes.map((pane) => pane.element.parentElement.querySelector('.readout'));
    for (const pane of views.panes) this.listen(pane);
    views.onProbeCentre = (pane) => this.show(pane, pane.element.clientWidth / 2, pane.element.clientHeight / 2);
    views.afterDraw.push(() => this.place());
  }

  listen(pane) {
    let pending = null;
    const probe = (event) => {
      const box = pane.element.getBoundingClientRect();
      const isFirst = !pending;
      pending = [event.clientX - box.left, event.clientY - box.top];
      if (isFirst) {
        requestAnimationFrame(() => {
          this.show(pane, ...pending);
          pending = null;
        });
      }
    };
    pane.element.addEventListener('pointermove', (event) => {
      if (event.buttons === 0) probe(event);
    });
    pane.element.addEventListener('click', probe);
    pane.element.addEventListener('pointerleave', (event) => {
      if (event.pointerType === 'mouse') this.clear();
    });
  }

  clear() {
    this.hit = null;
    this.place();
  }

  show(pane, x, y) {
    this.hit = this.picker.at(pane, x, y);
    if (this.hit) this.hit.pane = pane;
    this.place();
  }

  place() {
    const { hit, model, views } = this;
    views.panes.forEach((pane, side) => {
      const ring = this.rings[side];
      ring.hidden = !hit;
      const frame = side === 0 ? model.data.source_frame : model.data.image_frame;
      if (!hit) {
        this.readouts[side].textContent = this.picker.isAvailable ? 'Point at a side to find the matching point (display only).' : 'This browser cannot look up points.';
        return;
      }
      const shares = side === 0 ? hit.source : hit.image;
      const seen = this.project(pane);
      ring.style.transform = `translate(${seen.x}px, ${seen.y}px)`;
      const isHidden = pane !== hit.pane && this.isHidden(pane, seen, hit);
      ring.classList.toggle('behind', isHidden);
      const names = side === 1 && model.isFlat ? ['x', 'y'] : ['x', 'y', 'z'];
      const values = fromShares(frame, shares);
      this.readouts[side].textContent =
        names.map((name, axis) => `${name} = ${number(values[axis], frame.high[axis] - frame.low[axis])}`).join('   ') +
        (isHidden ? '   (hidden from here)' : '');
    });
  }

  /** Where the found point is seen in a pane, in pixels. */
  project(pane) {
    const { spaces } = this.model;
    const source = toDisplay(spaces.source, this.hit.source);
    const target = toDisplay(spaces.target, this.hit.image);
    const morph = pane.side === 0 ? this.views.settings.morph : 1;
    const p = new Vector3(...source).lerp(new Vector3(...target), morph).project(pane.camera);
    const { clientWidth: width, clientHeight: height } = pane.element;
    return { x: ((p.x + 1) / 2) * width, y: ((1 - p.y) / 2) * height };
  }

  /** Whether something else is seen where the matching point is. */
  isHidden(pane, { x, y }, hit) {
    const front = this.picker.at(pane, x, y);
    if (!front) return false;
    const { spaces } = this.model;
    const space = pane.side === 0 ? spaces.source : spaces.target;
    const key = pane.side === 0 ? 'source' : 'image';
    const [a, b] = [toDisplay(space, front[key]), toDisplay(space, hit[key])];
    return Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]) > 0.05;
  }
}
