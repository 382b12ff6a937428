// Entry point: replaces the notice in #viewer by the picture.

import { readScene } from './data.js';
import { element } from './dom.js';
import { Controls } from './controls.js';
import { Labels } from './labels.js';
import { Model, initialSettings } from './model.js';
import { Picker, Probe } from './picking.js';
import { Views } from './views.js';
import { installTheme, themeColour } from './theme.js';

const RANGES = { square: '[0, 1]²', cube: '[0, 1]³', disk: 'radius 1', ball: 'radius 1' };

function pane(title, detail, help) {
  const stage = element('div', { class: 'stage', tabindex: '0', role: 'application', 'aria-label': `${title}. ${help}` });
  const figure = element(
    'div', { class: 'pane' },
    element('div', { class: 'pane-title' }, element('strong', {}, title), ' ', element('span', {}, detail)),
    stage,
    element('div', { class: 'readout' }),
  );
  return { figure, stage };
}

/** Settings named after `#` in the address, for example `#show=section&theme=dark`. */
function fromAddress() {
  return new URLSearchParams(window.location.hash.slice(1));
}

function start() {
  const host = document.getElementById('viewer');
  const address = fromAddress();
  let model = null;
  let views = null;
  installTheme(document.getElementById('page-tools'), address.get('theme'), () => {
    if (!model || !views) return;
    model.setInk(themeColour('--ink-soft'));
    views.request();
  });
  const keys = 'Arrow keys turn, plus and minus zoom, Home resets, Enter looks up the point in the middle.';
  const scene = readScene(document);
  const left = pane('Source', 'in the units of the file', keys);
  const right = scene.shell
    ? scene.target === 'section'
      ? pane('Section', `of ${scene.shell.triangles} triangles, in the same units`, keys)
      : pane('Middle surface', `of ${scene.shell.prisms} prism${scene.shell.prisms === 1 ? '' : 's'}, in the same units`, keys)
    : pane('Target', `${scene.target}, ${RANGES[scene.target]}`, keys);
  const stageArea = element('div', { class: 'views' }, left.figure, right.figure);
  const panel = element('form', { class: 'panel', 'aria-label': 'What is shown', onsubmit: (event) => event.preventDefault() });
  const notice = host.querySelector('.no-picture');
  model = new Model(scene);
  const settings = initialSettings(scene);
  host.append(stageArea, panel);
  try {
    views = new Views(stageArea, [left.stage, right.stage], model);
  } catch (error) {
    stageArea.remove();
    panel.remove();
    notice.textContent = `The picture needs WebGL 2, which this browser does not offer (${error.message}). All text below is complete without it.`;
    notice.setAttribute('role', 'status');
    return;
  }
  notice.remove();
  host.classList.add('live');
  model.setInk(themeColour('--ink-soft'));
  model.apply(settings);
  const probe = new Probe(views, model, new Picker(views, model));
  const labels = new Labels(views, model);
  const controls = new Controls(panel, model, views, settings);
  views.start(settings);
  controls.preset(address.get('show') ?? 'surface');
  // For scripts and tests: the same handles that the controls use.
  window.homeoReport = { settings, controls, model, views, probe, labels };
  document.documentElement.dataset.viewer = 'ready';
}

start();
