// Colours from the page's custom properties, and the switch between light and dark.

import { h, icon, type Icon } from './dom.ts';

export interface Theme {
  paper: string; ink: string; quiet: string; line: string; accent: string; warn: string; panel: string;
  series: string[]; dark: boolean;
}

const fallback: Record<string, string> = {
  paper: '#fffefb', ink: '#1d1d1b', quiet: '#6b6a66', line: '#dcdad3', accent: '#1f5fa8', warn: '#b3261e', panel: '#f7f6f1',
};
const series_fallback = ['#1f5fa8', '#c2571a', '#2e7d4f', '#8e3b8a', '#b58900', '#0f7c8a', '#a23b3b', '#5f6368'];

// Colours of any CSS notation are converted to rgb(), since canvas and three.js read fewer notations than the browser.
let pen: CanvasRenderingContext2D | null = null;
export function rgb(color: string): [number, number, number] {
  pen ??= Object.assign(document.createElement('canvas'), { width: 1, height: 1 }).getContext('2d', { willReadFrequently: true });
  if (!pen) return [128, 128, 128];
  pen.clearRect(0, 0, 1, 1);
  pen.fillStyle = '#808080';
  pen.fillStyle = color;
  pen.fillRect(0, 0, 1, 1);
  const [r, g, b] = pen.getImageData(0, 0, 1, 1).data;
  return [r, g, b];
}

export function css_rgb(color: string, alpha = 1): string {
  const [r, g, b] = rgb(color);
  return alpha < 1 ? `rgba(${r}, ${g}, ${b}, ${alpha})` : `rgb(${r}, ${g}, ${b})`;
}

export function mixed(a: string, b: string, part: number): string {
  const p = rgb(a), q = rgb(b);
  return `rgb(${p.map((x, k) => Math.round(x + (q[k] - x) * part)).join(', ')})`;
}

// The element whose custom properties hold the colours: the root of a page, or the host of a widget.
let source: HTMLElement = document.documentElement;
export function take_colours_from(element: HTMLElement): void {
  source = element;
  changed();
}

function read(): Theme {
  const style = getComputedStyle(source);
  const get = (name: string, other: string): string => css_rgb(style.getPropertyValue(`--${name}`).trim() || other);
  const t = Object.fromEntries(Object.entries(fallback).map(([k, v]) => [k, get(k, v)]));
  const [r, g, b] = rgb(t.paper);
  return { ...(t as unknown as Theme), series: series_fallback.map((c, k) => get(`c${k}`, c)), dark: r + g + b < 384 };
}

let current: Theme | null = null;
const listeners = new Set<() => void>();

export function theme(): Theme { return (current ??= read()); }
// Calls `f` after each change of the theme. Returns the function that ends this.
export function on_theme(f: () => void): () => void {
  listeners.add(f);
  return () => { listeners.delete(f); };
}

function changed(): void {
  current = null;
  scheme();
  for (const f of listeners) f();
}

// Sets the colour scheme, by which the browser draws checkboxes and lists light or dark.
function scheme(): void {
  const value = theme().dark ? 'dark' : 'light', { style } = source;
  if (style.getPropertyValue('--v-scheme') !== value) style.setProperty('--v-scheme', value);
}

export function watch_theme(): void {
  scheme();
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', changed);
  new MutationObserver(changed).observe(document.documentElement, { attributes: true, attributeFilter: ['data-theme', 'class', 'style'] });
  // Paper is white. Canvases are raster images, so they are drawn anew in light colours before the page is printed.
  let before: string | undefined;
  addEventListener('beforeprint', () => { before = document.documentElement.dataset.theme; apply('light'); changed(); });
  addEventListener('afterprint', () => { apply(before); changed(); });
}

function apply(choice: string | undefined): void {
  if (choice) document.documentElement.dataset.theme = choice;
  else delete document.documentElement.dataset.theme;
}

// Pages from file:// may have no storage.
const key = 'anholon-theme';
function remembered(): string | null { try { return localStorage.getItem(key); } catch { return null; } }
function remember(choice: string): void { try { localStorage.setItem(key, choice); } catch { /* the choice holds for this visit */ } }

export function theme_switch(place: Element): void {
  const choices: [string, Icon, string][] = [['light', 'sun', 'Light'], ['', 'auto', 'As the system'], ['dark', 'moon', 'Dark']];
  const buttons = choices.map(([value, name, label]) =>
    h('button', { type: 'button', class: 'choice', title: label, 'aria-label': label, click: () => { remember(value); choose(value); } }, icon(name)));
  const choose = (value: string): void => {
    apply(value || undefined);
    buttons.forEach((b, k) => b.setAttribute('aria-pressed', String(choices[k][0] === value)));
  };
  const stored = remembered();
  choose(stored === 'light' || stored === 'dark' ? stored : '');
  place.append(h('div', { class: 'segments theme-switch', role: 'group', 'aria-label': 'Colours of the page' }, ...buttons));
}
