// The legend of a plot: which columns are drawn, their colours, and their values at the cursor.

import type { Column } from './data.ts';
import { h } from './dom.ts';
import { exact } from './format.ts';
import { formula } from './math.ts';

export interface Entry { column: Column; shown: boolean; color: () => string; dash: number[] | undefined }

export class Legend {
  readonly element = h('div', { class: 'legend' });
  private readonly rows: { entry: Entry; button: HTMLButtonElement; swatch: SVGElement; value: HTMLElement; at: HTMLElement }[];

  constructor(entries: Entry[], private readonly unit: string, private readonly changed: () => void) {
    this.rows = entries.map((entry) => this.row(entry));
    this.element.append(...this.rows.map((r) => h('div', { class: 'entry' }, r.button, h('span', { class: 'reading' }, r.value, r.at))));
    if (entries.length > 6) {
      const all = (on: boolean) => () => { for (const e of entries) e.shown = on; this.update(); this.changed(); };
      this.element.append(h('div', { class: 'all' },
        h('button', { type: 'button', class: 'plain', click: all(true) }, 'show all'), h('button', { type: 'button', class: 'plain', click: all(false) }, 'hide all')));
    }
    this.update();
  }

  private row(entry: Entry) {
    const { column } = entry;
    const space = 'http://www.w3.org/2000/svg';
    const swatch = document.createElementNS(space, 'svg');
    swatch.setAttribute('viewBox', '0 0 22 8');
    swatch.setAttribute('class', 'swatch');
    swatch.setAttribute('aria-hidden', 'true');
    const line = document.createElementNS(space, 'path');
    line.setAttribute('d', 'M1 4H21');
    if (entry.dash) line.setAttribute('stroke-dasharray', entry.dash.join(' '));
    swatch.append(line);
    const name = h('span', { class: 'name' });
    name.append(formula(column.html, column.name));
    const button = h('button', { type: 'button', class: 'column', title: column.name + (column.unit ? ` (${column.unit})` : ''),
      click: () => { entry.shown = !entry.shown; this.update(); this.changed(); } }, swatch, name,
      column.unit ? h('span', { class: 'unit' }, column.unit) : null);
    return { entry, button, swatch, value: h('span', { class: 'value' }), at: h('span', { class: 'at' }) };
  }

  // Updates the colours and the state of the buttons.
  update(): void {
    for (const { entry, button, swatch } of this.rows) {
      button.setAttribute('aria-pressed', String(entry.shown));
      swatch.style.color = entry.color();
    }
  }

  // Shows values. `rows`: the row of each column, -1 for none; `time`: the time of the cursor; other times are shown beside values.
  read(rows: number[], time: number): void {
    this.rows.forEach(({ entry, value, at }, k) => {
      const row = rows[k];
      const text = row < 0 ? '' : exact(entry.column.data[row]);
      if (value.textContent !== text) value.textContent = text;
      const own = row >= 0 && entry.column.t[row] !== time ? `at ${exact(entry.column.t[row])}${this.unit ? ` ${this.unit}` : ''}` : '';
      if (at.textContent !== own) at.textContent = own;
    });
  }
}
