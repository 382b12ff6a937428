// Names of the axes, as text above the canvas so that it stays sharp and follows the theme.

import { Vector3 } from 'three';
import { AXES_SIZE } from './model.js';
import { toDisplay } from './space.js';

/** Where the labels stand: in the little picture of the axes for the source, in shares of the frame for the target. */
function anchors(model, side) {
  const { image_frame: frame, target } = model.data;
  if (side === 0) return [['x', [1.22, 0, 0]], ['y', [0, 1.22, 0]], ['z', [0, 0, 1.22]]];
  if (model.data.shell) return [];
  const share = (t) => t.map((value, axis) => (frame.high[axis] > frame.low[axis] ? (value - frame.low[axis]) / (frame.high[axis] - frame.low[axis]) : 0));
  const places = {
    square: [['0', [-0.04, -0.04, 0]], ['x = 1', [1.02, -0.05, 0]], ['y = 1', [-0.05, 1.04, 0]]],
    disk: [['x = 1', [1.1, 0, 0]], ['y = 1', [0, 1.06, 0]]],
    cube: [['0', [-0.05, -0.05, -0.05]], ['x = 1', [1.08, -0.04, -0.04]], ['y = 1', [-0.04, 1.08, -0.04]], ['z = 1', [-0.04, -0.04, 1.08]]],
    ball: [['x = 1', [1.13, 0, 0]], ['y = 1', [0, 1.13, 0]], ['z = 1', [0, 0, 1.08]]],
  };
  return places[target].map(([text, place]) => [text, share(place)]);
}

export class Labels {
  constructor(views, model) {
    this.views = views;
    this.model = model;
    this.entries = views.panes.flatMap((pane) =>
      anchors(model, pane.side).map(([text, shares]) => {
        const element = document.createElement('span');
        element.className = 'axis-label';
        element.textContent = text;
        pane.element.append(element);
        return { pane, element, shares };
      }),
    );
    views.afterDraw.push(() => this.place());
  }

  place() {
    const { views } = this;
    for (const { pane, element, shares } of this.entries) {
      const { clientWidth: width, clientHeight: height } = pane.element;
      if (pane.side === 0) {
        const p = new Vector3(...shares).project(views.axesCamera);
        this.put(element, width - AXES_SIZE - 6 + ((p.x + 1) / 2) * AXES_SIZE, height - 34 - ((p.y + 1) / 2) * AXES_SIZE);
        element.classList.add('in-front');
        continue;
      }
      const anchor = new Vector3(...toDisplay(this.model.spaces.target, shares));
      const { position } = pane.camera;
      // Behind the middle of the object the canvas may cover the label; in front it must not.
      element.classList.toggle('in-front', pane.isFlat || anchor.distanceTo(position) <= position.length());
      const p = anchor.project(pane.camera);
      element.hidden = Math.abs(p.x) > 1 || Math.abs(p.y) > 1;
      this.put(element, ((p.x + 1) / 2) * width, ((1 - p.y) / 2) * height);
    }
  }

  put(element, x, y) {
    element.style.transform = `translate(-50%, -50%) translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
  }
}
