// Small helpers for elements and numbers.

// h('button.small', { onclick: f, 'aria-label': '...' }, 'text', child): an element.
export function h(what, attributes = {}, ...children) {
  const [tag, ...classes] = what.split('.');
  const element = document.createElement(tag);
  if (classes.length) element.className = classes.join(' ');
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (name.startsWith('on')) element.addEventListener(name.slice(2), value);
    else if (name in element && typeof value !== 'string') element[name] = value;
    else element.setAttribute(name, value === true ? '' : value);
  }
  element.append(...present(children));
  return element;
}

// Without null, undefined and false, of which the browser would write the names.
export const present = (children) => children.filter((child) => child !== null && child !== undefined && child !== false);

// Whether a button of the mouse is down: what is pressed must not be replaced before it is released, or the click is lost.
let pressed = false;
addEventListener('pointerdown', () => { pressed = true; }, true);
for (const name of ['pointerup', 'pointercancel', 'blur']) addEventListener(name, () => setTimeout(() => { pressed = false; }), true);
export const isPressed = () => pressed;

export const byId = (id) => document.getElementById(id);

// Four digits, without a long tail: "0.0012", "1.234e-7".
export function number(value, digits = 4) {
  if (value === null || value === undefined || Number.isNaN(value)) return '–';
  if (value === 0) return '0';
  if (!Number.isFinite(value)) return value > 0 ? 'infinite' : '-infinite';
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-4) return value.toExponential(digits - 1).replace(/\.?0+e/, 'e').replace('e+', 'e');
  return Number(value.toPrecision(digits)).toString();
}

// Nanoseconds as people read them.
export function duration(ns) {
  if (!(ns > 0)) return '–';
  if (ns < 1e3) return `${number(ns, 3)} ns`;
  if (ns < 1e6) return `${number(ns / 1e3, 3)} µs`;
  return ns < 1e9 ? `${number(ns / 1e6, 3)} ms` : `${number(ns / 1e9, 3)} s`;
}

// Bytes as people read them.
export function size(bytes) {
  if (bytes < 1e5) return `${number(bytes / 1e3, 2)} kB`;
  return bytes < 1e9 ? `${number(bytes / 1e6, 3)} MB` : `${number(bytes / 1e9, 3)} GB`;
}

export const seconds = (value) => `${(value ?? 0).toFixed(3)} s`;

// A level of detail as people count it, from the cheapest; '–': an algorithm that the ladder does not name.
export const levelText = (level, of) => (level < 0 ? '–' : `${Number(level) + 1} of ${of ?? '?'}`);

// "Constraint/AngularVelocity/Graph" is "Graph".
export const shortType = (type) => type.slice(type.lastIndexOf('/') + 1);

// Text of a parameter, with its long digits cut: "0.30000000000000004 1 2" is "0.3 1 2".
export function shortText(text) {
  return text.split(' ').map((word) => (/^-?[\d.]+(e[-+]?\d+)?$/.test(word) ? number(Number(word), 6) : word)).join(' ');
}

export function vector(text) {
  const numbers = (text ?? '').split(' ').map(Number);
  return numbers.length === 3 && numbers.every(Number.isFinite) ? numbers : null;
}
