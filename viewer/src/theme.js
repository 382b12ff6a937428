// Light, dark, or what the system says.

import { element } from './dom.js';

const MODES = ['auto', 'light', 'dark'];
const NAMES = { auto: 'Theme: system', light: 'Theme: light', dark: 'Theme: dark' };

export function installTheme(tools, wanted, onChange) {
  let mode = MODES.includes(wanted) ? wanted : 'auto';
  const button = element('button', { type: 'button', class: 'quiet' });
  const show = () => {
    if (mode === 'auto') document.documentElement.removeAttribute('data-theme');
    else document.documentElement.dataset.theme = mode;
    button.textContent = NAMES[mode];
    onChange();
  };
  button.addEventListener('click', () => {
    mode = MODES[(MODES.indexOf(mode) + 1) % MODES.length];
    show();
  });
  window.matchMedia('(prefers-color-scheme: dark)').addEventListener('change', show);
  tools.append(button);
  show();
}

/** A colour variable of the style sheet, `#rrggbb`, as three shares of 1. */
export function themeColour(name) {
  const text = getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  return [1, 3, 5].map((at) => parseInt(text.slice(at, at + 2), 16) / 255);
}
