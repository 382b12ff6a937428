// The panel beside the picture.

import { check, choice, element, group, slider } from './dom.js';
import { number } from './format.js';

/** What the buttons at the top set; everything else keeps its value. */
function presets(model) {
  const surface = { opacity: 1, coordinate: 'none', leaves: false, cut: 'none' };
  const isFlat = model.isFlat;
  const list = [['surface', 'Surface', surface]];
  const axis = model.data.coordinates[0];
  if (model.levels.length) {
    // Spheres hide each other: half of them is cut away.
    const veil = isFlat ? {} : { opacity: 0.1, ...(axis === 'radius' ? { cut: 'target x', cutAt: 0.5, cutFlip: false } : {}) };
    if (model.data.shell) list.push(['layers', 'Layers', { ...surface, coordinate: 'outer', cut: 'source x', cutAt: 0.5, cutFlip: false }]);
    else list.push(['levels', isFlat ? 'Lines' : 'Level sets', { ...surface, ...veil, coordinate: isFlat ? 'all' : axis, allLevels: true, colouring: isFlat ? 'position' : 'checks' }]);
  }
  if (model.leaves) {
    const veil = isFlat ? { colouring: 'plain' } : { opacity: 0.08 };
    list.push(['leaves', model.data.shell ? 'Pillars' : 'Leaves', { ...surface, ...veil, leaves: true }]);
  }
  if (!isFlat && model.data.volume) list.push(['section', 'Section', { ...surface, cut: 'target x', cutAt: 0.5, cutFlip: false }]);
  if (model.data.distortion) list.push(['distortion', 'Distortion', { ...surface, colouring: 'distortion' }]);
  for (const [name, , values] of list) if (name !== 'distortion' && !values.colouring) values.colouring = 'checks';
  return list;
}

export class Controls {
  constructor(panel, model, views, settings) {
    Object.assign(this, { model, views, settings, fields: {} });
    this.presets = presets(model);
    panel.append(this.presetRow(), this.surfaceGroup());
    if (model.levels.length) panel.append(this.levelGroup());
    if (model.leaves && !model.data.shell) panel.append(this.leafGroup());
    panel.append(this.cutGroup(), this.viewGroup());
    this.refresh();
  }

  /** Changes settings, the picture and the panel. */
  set(changes) {
    Object.assign(this.settings, changes);
    this.model.apply(this.settings);
    this.refresh();
    this.views.request();
  }

  preset(name) {
    const found = this.presets.find(([key]) => key === name);
    if (found) this.set(found[2]);
  }

  field(name, make) {
    const field = make((value) => this.set({ [name]: value }));
    this.fields[name] = field;
    return field.row;
  }

  presetRow() {
    this.presetButtons = this.presets.map(([name, label]) =>
      element('button', { type: 'button', 'data-preset': name, 'aria-pressed': 'false', onclick: () => this.preset(name) }, label));
    return element('div', { class: 'presets', role: 'group', 'aria-label': 'Show' }, ...this.presetButtons);
  }

  surfaceGroup() {
    const { shell } = this.model.data;
    const colourings = [['checks', 'checkerboard'], ['position', shell ? `place on the ${this.model.data.target}` : 'place in the target'], ['plain', 'one colour']];
    if (this.model.data.distortion) colourings.splice(2, 0, ['distortion', 'distortion']);
    const percent = (value) => `${Math.round(value * 100)} %`;
    this.scale = element('div', { class: 'colour-scale' }, element('span', {}, '1'), element('i', {}), element('span', {}, `≥ ${this.model.data.distortion_end}`));
    return group(
      'Surface',
      this.field('colouring', (change) => choice('colouring', 'Colour', colourings, change)),
      this.scale,
      this.field('checks', (change) => slider('checks', shell ? 'Per side' : 'Squares', shell ? { min: 1, max: 16, step: 1, words: String } : { min: 2, max: 32, step: 2, words: String }, change)),
      this.field('opacity', (change) => slider('opacity', 'Opacity', { min: 0, max: 1, step: 0.02, words: percent }, change)),
      this.field('edges', (change) => check('edges', 'Mesh edges', change)),
    );
  }

  levelGroup() {
    const { coordinates, target } = this.model.data;
    const options = [['none', 'none'], ...coordinates.map((name) => [name, name]), ['all', 'all coordinates']];
    if (this.model.data.shell) {
      const layers = [['none', 'none'], ['outer', 'bottom, top'], ...coordinates.map((name) => [name, name]), ['all', 'all three']];
      return group('Shell', this.field('coordinate', (change) => choice('coordinate', 'Layers', layers, change)), this.leafRow());
    }
    const words = () => this.levelWords();
    return group(
      this.model.isFlat ? `Lines of the ${target}` : 'Level sets',
      this.field('coordinate', (change) => choice('coordinate', 'Coordinate', options, change)),
      this.field('allLevels', (change) => check('allLevels', 'All values', change)),
      this.field('level', (change) => slider('level', 'Value', { min: 1, max: 7, step: 1, words, isWide: true }, change)),
    );
  }

  levelWords() {
    const { coordinate, level } = this.settings;
    const name = coordinate === 'none' || coordinate === 'all' ? this.model.data.coordinates[0] : coordinate;
    const family = this.model.levels.filter((entry) => entry.coordinate === name);
    const chosen = family[Math.min(family.length - 1, Math.round(((level - 1) / 6) * (family.length - 1)))];
    return chosen ? `${name} = ${chosen.label}` : '';
  }

  leafGroup() {
    return group('Foliation', this.leafRow());
  }

  leafRow() {
    if (!this.model.leaves) return null;
    const count = this.model.data.leaves.starts.length - 1;
    const name = this.model.data.shell ? 'Pillars' : 'Leaves';
    return this.field('leaves', (change) => check('leaves', `${name} (${count})`, change));
  }

  cutGroup() {
    const axes = (side) => ['x', 'y', 'z'].slice(0, side === 'target' && this.model.isFlat ? 2 : 3);
    const options = [['none', 'no cut']];
    for (const side of ['target', 'source']) for (const axis of axes(side)) options.push([`${side} ${axis}`, `${side === 'target' && this.model.data.shell ? this.model.data.target.split(' ')[0] : side} ${axis}`]);
    if (this.model.data.target === 'ball' || this.model.data.target === 'disk') options.splice(1, 0, ['target radius', 'target radius']);
    const words = (value) => {
      if (this.settings.cut === 'none') return '';
      const [low, high] = this.model.cutRange(this.settings);
      return number(low + value * (high - low), high - low);
    };
    return group(
      'Cut both sides',
      this.field('cut', (change) => choice('cut', 'Across', options, change)),
      this.field('cutAt', (change) => slider('cutAt', 'Position', { min: 0, max: 1, step: 0.005, words }, change)),
      this.field('cutFlip', (change) => check('cutFlip', 'Keep the other part', change)),
    );
  }

  viewGroup() {
    const percent = (value) => `${Math.round(value * 100)} %`;
    const home = element('button', { type: 'button', onclick: () => this.views.home() }, 'Reset view');
    const save = element('button', { type: 'button', onclick: () => this.save() }, 'Save picture');
    const up = this.field('up', (change) => choice('up', 'Up axis', [['z', 'z'], ['y', 'y'], ['x', 'x']], (value) => {
      change(value);
      this.views.home();
    }));
    return group(
      'View',
      this.field('morph', (change) => slider('morph', 'Morph', { min: 0, max: 1, step: 0.01, words: percent }, change)),
      this.views.canLink ? this.field('linked', (change) => check('linked', 'Turn both sides together', change)) : null,
      up,
      element('div', { class: 'row buttons' }, home, save),
    );
  }

  save() {
    this.views.draw();
    const link = element('a', { href: this.views.renderer.domElement.toDataURL('image/png'), download: 'homeo-map.png' });
    link.click();
  }

  refresh() {
    const { settings, fields } = this;
    for (const [name, field] of Object.entries(fields)) field.show(settings[name]);
    const disable = (name, isOff) => {
      if (!fields[name]) return;
      fields[name].input.disabled = isOff;
      fields[name].row.classList.toggle('off', isOff);
    };
    disable('checks', settings.colouring !== 'checks');
    disable('allLevels', settings.coordinate === 'none');
    disable('level', settings.coordinate === 'none' || settings.allLevels);
    disable('cutAt', settings.cut === 'none');
    disable('cutFlip', settings.cut === 'none');
    this.scale.hidden = settings.colouring !== 'distortion';
    this.presetButtons.forEach((button, index) => {
      const values = this.presets[index][2];
      const isOn = Object.entries(values).every(([name, value]) => settings[name] === value);
      button.setAttribute('aria-pressed', String(isOn));
    });
  }
}
