// Elements, and the few icons of the controls.

type Child = Node | string | null;
type Attributes = Record<string, string | boolean | EventListener>;

export function h<K extends keyof HTMLElementTagNameMap>(tag: K, attributes: Attributes = {}, ...children: Child[]): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [key, value] of Object.entries(attributes)) {
    if (typeof value === 'function') element.addEventListener(key, value);
    else if (typeof value === 'boolean') { if (value) element.setAttribute(key, ''); }
    else element.setAttribute(key, value);
  }
  for (const child of children) if (child !== null) element.append(child);
  return element;
}

// Paths of the icons on a grid of 16 x 16, drawn as strokes in the colour of the text.
const paths = {
  play: 'M5 3.2v9.6l8-4.8z', pause: 'M5 3.5v9M11 3.5v9', loop: 'M3 8a5 5 0 0 1 8.6-3.5L13 6M13 3v3h-3M13 8a5 5 0 0 1-8.6 3.5L3 10M3 13v-3h3',
  reset: 'M2.5 6V2.5H6M10 2.5h3.5V6M13.5 10v3.5H10M6 13.5H2.5V10M8 8h.01', image: 'M2.5 3.5h11v9h-11zM2.5 11l3.5-3.5 3 3 2-2 2.5 2.5M10.6 6.2h.01',
  full: 'M9.5 6.5l4-4M10 2.5h3.5V6M6.5 9.5l-4 4M6 13.5H2.5V10', copy: 'M6 5.5h7v8H6zM3.5 10.5V2.5h6.5', done: 'M3 8.5l3.5 3.5L13 4.5',
  sun: 'M8 5a3 3 0 1 0 0 6 3 3 0 0 0 0-6zM8 1.5v1M8 13.5v1M1.5 8h1M13.5 8h1M3.4 3.4l.7.7M11.9 11.9l.7.7M3.4 12.6l.7-.7M11.9 4.1l.7-.7',
  moon: 'M13 9.6A5.6 5.6 0 0 1 6.4 3a5.6 5.6 0 1 0 6.6 6.6z', auto: 'M8 2.5a5.5 5.5 0 1 0 0 11zM8 2.5a5.5 5.5 0 0 1 0 11z',
};
const solid = new Set(['play']);

export type Icon = keyof typeof paths;

export function icon(name: Icon): SVGSVGElement {
  const space = 'http://www.w3.org/2000/svg';
  const svg = document.createElementNS(space, 'svg');
  for (const [key, value] of Object.entries({ viewBox: '0 0 16 16', class: 'icon', 'aria-hidden': 'true' })) svg.setAttribute(key, value);
  const path = document.createElementNS(space, 'path');
  path.setAttribute('d', paths[name]);
  if (solid.has(name)) path.setAttribute('fill', 'currentColor');
  if (name === 'auto') {
    const half = document.createElementNS(space, 'path');
    half.setAttribute('d', 'M8 2.5a5.5 5.5 0 0 0 0 11z');
    half.setAttribute('fill', 'currentColor');
    svg.append(half);
  }
  svg.append(path);
  return svg;
}

export function set_icon(button: HTMLElement, name: Icon): void {
  button.querySelector('svg')?.replaceWith(icon(name));
}
