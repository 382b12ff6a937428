// Small builders for labelled form elements.

let counter = 0;

export function element(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === false || value === undefined) continue;
    if (name.startsWith('on')) node.addEventListener(name.slice(2), value);
    else node.setAttribute(name, value === true ? '' : value);
  }
  node.append(...children.filter((child) => child !== null && child !== undefined));
  return node;
}

export function group(legend, ...children) {
  return element('fieldset', {}, element('legend', {}, legend), ...children);
}

export function check(name, label, onChange) {
  const id = `control-${counter++}`;
  const input = element('input', { type: 'checkbox', id, name });
  input.addEventListener('change', () => onChange(input.checked));
  const row = element('div', { class: 'row check' }, input, element('label', { for: id }, label));
  return { row, input, show: (value) => { input.checked = value; } };
}

export function choice(name, label, options, onChange) {
  const id = `control-${counter++}`;
  const input = element('select', { id, name }, ...options.map(([value, text]) => element('option', { value }, text)));
  input.addEventListener('change', () => onChange(input.value));
  const row = element('div', { class: 'row' }, element('label', { for: id }, label), input);
  return { row, input, show: (value) => { input.value = value; } };
}

/** A slider with its value in words beside the label. */
export function slider(name, label, { min, max, step, words, isWide = false }, onChange) {
  const id = `control-${counter++}`;
  const input = element('input', { type: 'range', id, name, min, max, step });
  const output = element('output', { for: id });
  const update = () => {
    output.textContent = words(Number(input.value));
    input.setAttribute('aria-valuetext', output.textContent);
  };
  input.addEventListener('input', () => {
    onChange(Number(input.value));
    update();
  });
  const row = element('div', { class: isWide ? 'row wide' : 'row slider' }, element('label', { for: id }, label), ...(isWide ? [output, input] : [input, output]));
  return { row, input, show: (value) => { input.value = String(value); update(); } };
}
