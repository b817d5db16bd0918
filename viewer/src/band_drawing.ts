// The modes of contacts as bands along the lower edge of a plot: a contact that sticks has a full band, one that slips a dashed one of another colour.

import { strips } from './bands.ts';
import type { Band } from './data.ts';
import { h } from './dom.ts';
import { css_rgb, theme } from './theme.ts';

export const mode_names = ['open', 'slips', 'sticks'];

// Returns the colour of a mode; null for open contacts.
export function mode_color(mode: number): string | null {
  return mode === 1 ? css_rgb(theme().series[1]) : mode === 2 ? css_rgb(theme().series[2]) : null;
}

// Draws the bands; the first one is the lowest.
export function draw_bands(ctx: CanvasRenderingContext2D, box: { left: number; top: number; width: number; height: number },
  bands: Band[], range: [number, number], pixel: number): void {
  const height = 5 * pixel;
  bands.forEach((band, k) => {
    for (const s of strips(band, ...range)) {
      const color = mode_color(s.mode);
      if (!color) continue;
      ctx.fillStyle = color;
      const left = box.left + s.x * box.width, width = Math.max(s.width * box.width, pixel), top = box.top + box.height - (k + 1) * height;
      const dash = s.mode === 1 ? 4 * pixel : width, gap = 3 * pixel;
      for (let from = 0; from < width; from += dash + gap) ctx.fillRect(left + from, top, Math.min(dash, width - from), height - pixel);
    }
  });
}

// Returns the legend of the bands; null if there are no contacts.
export function bands_key(bands: Band[]): HTMLElement | null {
  if (bands.length === 0) return null;
  const key = (mode: number): HTMLElement => h('span', { class: `mode mode-${mode}` }, mode_names[mode]);
  const names = bands.map((b) => b.name).join(', ');
  return h('p', { class: 'note bands-key' }, bands.length > 1 ? `Contacts, from below: ${names}. ` : `Contact ${names}: `, key(2), ' ', key(1));
}
