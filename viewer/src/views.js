// Two panes, one canvas: each pane has a camera, both look at the same model from their side.

import { PerspectiveCamera, Quaternion, Spherical, Vector3, WebGLRenderer } from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

import { AXES_SIZE } from './model.js';

const FIELD_OF_VIEW = 32;
const UPS = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] };
const HOMES = { x: [0.55, 0.9, 1.5], y: [0.9, 0.62, 1.5], z: [0.9, -1.5, 0.62] };

/** Mean normal of an open surface, or null where there is no preferred direction. */
function facingDirection(model) {
  const { vertices, surface } = model.data;
  const { scale } = model.spaces.source;
  const sum = new Vector3();
  let area = 0;
  const at = (vertex) => new Vector3(...[0, 1, 2].map((axis) => vertices.source[3 * vertex + axis] * scale[axis]));
  for (let t = 0; t < surface.length; t += 3) {
    const a = at(surface[t]);
    const normal = at(surface[t + 1]).sub(a).cross(at(surface[t + 2]).sub(a));
    area += normal.length();
    sum.add(normal);
  }
  return area > 0 && sum.length() > 0.3 * area ? sum.normalize() : null;
}

class Pane {
  constructor(element, side, model, views) {
    this.element = element;
    this.side = side;
    this.camera = new PerspectiveCamera(FIELD_OF_VIEW, 1, 0.05, 50);
    this.isFlat = model.isFlat && side === 1;
    this.facing = model.isFlat && side === 0 ? facingDirection(model) : null;
    this.views = views;
    element.addEventListener('keydown', (event) => this.onKey(event));
  }

  /** Controls remember the up axis from their construction, so they are made anew. */
  home(up) {
    this.controls?.dispose();
    const { camera } = this;
    const upAxis = this.isFlat ? new Vector3(0, 1, 0) : new Vector3(...UPS[up]);
    let direction = new Vector3(...(this.isFlat ? [0, 0, 1] : HOMES[up])).normalize();
    if (this.facing) {
      // A little from below and from the side, so that relief is seen.
      direction = this.facing.clone().addScaledVector(new Vector3(...HOMES[up]).normalize(), 0.45).normalize();
      if (Math.abs(direction.dot(upAxis)) > 0.995) direction.add(new Vector3(0.05, -0.2, 0.1)).normalize();
    }
    camera.up.copy(upAxis);
    const { clientWidth: width, clientHeight: height } = this.element;
    const narrow = Math.min(1, width / Math.max(height, 1));
    const half = Math.atan(Math.tan((FIELD_OF_VIEW * Math.PI) / 360) * narrow);
    camera.position.copy(direction.multiplyScalar((this.isFlat ? this.views.flatFit : 1.02) / Math.sin(half)));
    this.controls = new OrbitControls(camera, this.element);
    Object.assign(this.controls, { enableDamping: false, minDistance: 0.3, maxDistance: 20, zoomSpeed: 1.2 });
    if (this.isFlat) {
      this.controls.enableRotate = false;
      this.controls.screenSpacePanning = true;
      Object.assign(this.controls.mouseButtons, { LEFT: 2 }); // pan
      Object.assign(this.controls.touches, { ONE: 1 });
    }
    this.controls.addEventListener('change', () => this.views.moved(this));
    this.controls.update();
  }

  follow(other) {
    this.isFollowing = true;
    this.camera.position.copy(other.camera.position);
    this.controls.target.copy(other.controls.target);
    this.controls.update();
    this.isFollowing = false;
  }

  turn(right, up) {
    const { camera, controls } = this;
    const offset = camera.position.clone().sub(controls.target);
    if (this.isFlat) {
      const step = 0.08 * offset.length();
      const shift = new Vector3(right, -up, 0).multiplyScalar(step);
      camera.position.add(shift);
      controls.target.add(shift);
    } else {
      // Spherical counts from the y axis: express the offset with the up axis there.
      const toY = new Quaternion().setFromUnitVectors(camera.up, new Vector3(0, 1, 0));
      offset.applyQuaternion(toY);
      const spherical = new Spherical().setFromVector3(offset);
      spherical.theta -= right * 0.12;
      spherical.phi = Math.min(Math.PI - 0.02, Math.max(0.02, spherical.phi + up * 0.12));
      offset.setFromSpherical(spherical);
      offset.applyQuaternion(toY.invert());
      camera.position.copy(controls.target).add(offset);
    }
    controls.update();
  }

  zoom(factor) {
    const { camera, controls } = this;
    camera.position.sub(controls.target).multiplyScalar(factor).add(controls.target);
    controls.update();
  }

  onKey(event) {
    const actions = {
      ArrowLeft: () => this.turn(-1, 0), ArrowRight: () => this.turn(1, 0),
      ArrowUp: () => this.turn(0, -1), ArrowDown: () => this.turn(0, 1),
      '+': () => this.zoom(0.88), '=': () => this.zoom(0.88), '-': () => this.zoom(1 / 0.88),
      Home: () => this.views.home(), 0: () => this.views.home(),
      Enter: () => this.views.onProbeCentre?.(this),
    };
    const action = actions[event.key];
    if (!action || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    action();
  }
}

export class Views {
  constructor(container, elements, model) {
    this.container = container;
    this.model = model;
    this.settings = null;
    // The corners of a square reach the radius 1 of display space only along its diagonals.
    this.flatFit = model.data.target === 'disk' ? 1.14 : 0.92;
    this.renderer = new WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true });
    this.renderer.autoClear = false;
    this.renderer.setScissorTest(true);
    this.renderer.domElement.setAttribute('aria-hidden', 'true');
    container.append(this.renderer.domElement);
    this.panes = elements.map((element, side) => new Pane(element, side, model, this));
    this.axesCamera = new PerspectiveCamera(42, 1, 0.1, 10);
    this.afterDraw = [];
    new ResizeObserver(() => this.resize()).observe(container);
  }

  start(settings) {
    this.settings = settings;
    this.resize();
    this.home();
  }

  home() {
    for (const pane of this.panes) pane.home(this.settings.up);
    this.request();
  }

  /** The same camera only makes sense where both sides are solid. */
  get canLink() {
    return !this.model.isFlat;
  }

  moved(pane) {
    if (pane.isFollowing) return;
    if (this.canLink && this.settings.linked) this.panes[1 - pane.side].follow(pane);
    this.request();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.container;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
    this.renderer.setSize(width, height, false);
    // At once: resizing has emptied the canvas.
    this.draw();
  }

  request() {
    if (this.isWaiting) return;
    this.isWaiting = true;
    requestAnimationFrame(() => this.draw());
  }

  /** The directions of the axes, in a corner of the source's pane. */
  drawAxes(pane, x, y) {
    const { renderer, model, axesCamera } = this;
    axesCamera.up.copy(pane.camera.up);
    axesCamera.position.copy(pane.camera.position).sub(pane.controls.target).setLength(4);
    axesCamera.lookAt(0, 0, 0);
    renderer.setViewport(x, y, AXES_SIZE, AXES_SIZE);
    renderer.setScissor(x, y, AXES_SIZE, AXES_SIZE);
    renderer.render(model.axes, axesCamera);
  }

  draw() {
    this.isWaiting = false;
    if (!this.settings || !this.panes[0].controls) return;
    const { renderer, model } = this;
    renderer.setScissorTest(false);
    renderer.clear();
    renderer.setScissorTest(true);
    const outer = this.container.getBoundingClientRect();
    for (const pane of this.panes) {
      const box = pane.element.getBoundingClientRect();
      const [x, y] = [box.left - outer.left, outer.bottom - box.bottom];
      if (box.width < 2 || box.height < 2) continue;
      pane.camera.aspect = box.width / box.height;
      pane.camera.updateProjectionMatrix();
      renderer.setViewport(x, y, box.width, box.height);
      renderer.setScissor(x, y, box.width, box.height);
      model.setSide(pane.side, this.settings.morph, box.width, box.height);
      renderer.render(model.root, pane.camera);
      if (pane.side === 0) this.drawAxes(pane, x + box.width - AXES_SIZE - 6, y + 34);
    }
    for (const callback of this.afterDraw) callback();
  }
}
