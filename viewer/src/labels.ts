// Names beside bodies and points, drawn into the picture so that saved and printed pictures have them.

import { css_rgb, type Theme } from './theme.ts';

export interface Label { text: string; x: number; y: number; below: boolean }

const longest = 32;

export function draw_labels(pen: CanvasRenderingContext2D, labels: Label[], pixel: number, theme: Theme): void {
  const size = 12.5 * pixel;
  pen.font = `500 ${size}px system-ui, sans-serif`;
  pen.textBaseline = 'middle';
  pen.lineJoin = 'round';
  const taken: [number, number, number, number][] = [];
  for (const label of labels) {
    const letters = [...label.text];
    const text = letters.length > longest ? letters.slice(0, longest - 1).join('') + '\u2026' : label.text;
    const width = pen.measureText(text).width;
    const x = Math.min(Math.max(label.x - width / 2, 6 * pixel), pen.canvas.width - width - 6 * pixel);
    // A label moves away from its item until it covers no other label; after four places it is left out.
    const y = [0, 1, 2, 3].map((k) => label.y + (label.below ? 1 : -1) * size * (0.9 + 1.25 * k)).find((top) => !taken.some(
      ([l, t, r, b]) => x < r && x + width > l && top - size / 2 < b && top + size / 2 > t));
    if (y === undefined || label.x < 0 || label.x > pen.canvas.width || y < 0 || y > pen.canvas.height) continue;
    taken.push([x, y - size / 2, x + width, y + size / 2]);
    pen.strokeStyle = css_rgb(theme.panel, 0.85);
    pen.lineWidth = 3.5 * pixel;
    pen.strokeText(text, x, y);
    pen.fillStyle = theme.ink;
    pen.fillText(text, x, y);
  }
}
