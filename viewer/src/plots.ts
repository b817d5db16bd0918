// The plots of one case over a common range of time.

import { bands_key } from './band_drawing.ts';
import type { Clock } from './clock.ts';
import type { Case, Group } from './data.ts';
import { h } from './dom.ts';
import { Plot, type Cursor, type Owner } from './plot.ts';
import { on_theme } from './theme.ts';

const print_width = 680;       // px; fits between the margins of a page of A4 or letter

export class Plots implements Owner {
  range: [number, number];
  readonly plots: Plot[] = [];
  cursor: Cursor | null = null;
  private pending = false;
  private readonly ends: (() => void)[] = [];     // functions that close() calls
  private last_reading = 0;
  private readonly unzoom = h('button', { type: 'button', class: 'plain', hidden: true, click: () => this.zoom(null) }, 'Whole time');
  private readonly stack = h('div', { class: 'stack' });

  constructor(readonly place: HTMLElement, private readonly data: Case, private readonly clock: Clock) {
    this.range = this.whole();
    for (const s of place.querySelectorAll<HTMLElement>('.static')) s.hidden = true;
    place.classList.add('live');
    place.append(this.head(), this.stack);
    for (const group of this.groups()) this.plots.push(new Plot(data, group, data.columns.filter((c) => c.group === group.id), this));
    this.stack.append(...this.plots.map((p) => p.element));
    // All widths are read before the first plot changes, so that the browser lays the page out once, not once for each plot.
    const width = place.clientWidth || 600, widths = this.plots.map((p) => p.chart_width || width);
    this.plots.forEach((p, k) => p.resize(widths[k]));
    this.chips();
    clock.listen(() => this.request());
    this.ends.push(on_theme(() => { for (const p of this.plots) p.recolor(); }));
    const seen = new IntersectionObserver((entries) => {
      for (const e of entries) if (e.isIntersecting) this.wake(this.plots.find((p) => p.element === e.target));
    }, { rootMargin: '300px' });
    for (const p of this.plots) seen.observe(p.element);
    this.wake_idly(0);
    const sized = new ResizeObserver(() => this.resize());
    sized.observe(this.stack);
    const before = (): void => { for (const p of this.plots) this.wake(p); this.resize(print_width); }, after = (): void => this.resize();
    addEventListener('beforeprint', before);
    addEventListener('afterprint', after);
    this.ends.push(() => sized.disconnect(), () => seen.disconnect(), () => removeEventListener('beforeprint', before), () => removeEventListener('afterprint', after));
    this.read();
  }

  // Removes the listeners, so that the place can get other plots.
  close(): void {
    for (const end of this.ends) end();
    this.closed = true;
  }

  private closed = false;

  // Makes the remaining plots one by one while the browser is idle.
  private wake_idly(k: number): void {
    if (k >= this.plots.length || this.closed) return;
    const next = (): void => { this.wake(this.plots[k]); this.wake_idly(k + 1); };
    if ('requestIdleCallback' in window) requestIdleCallback(next, { timeout: 1000 }); else setTimeout(next, 200);
  }

  private wake(plot: Plot | undefined): void {
    plot?.wake();
    plot?.move(this.clock.time);
    plot?.point(this.cursor, this.clock.time);
  }

  private whole(): [number, number] {
    const { start, end } = this.data;
    return end > start ? [start, end] : [start - 0.5, start + 0.5];
  }

  // Returns the groups of the data that have columns, then other groups that columns name.
  private groups(): Group[] {
    const used = new Set(this.data.columns.map((c) => c.group).filter((id) => id !== ''));   // columns without a group are for the picture only
    const known = this.data.groups.filter((g) => used.has(g.id));
    const others = [...used].filter((id) => !known.some((g) => g.id === id)).map((id) => ({ id, title: id, log: false }));
    return [...known, ...others];
  }

  private readonly group_chips = h('div', { class: 'chips', role: 'group', 'aria-label': 'Plots shown' });

  private head(): HTMLElement {
    const { rows, shown } = this.data;
    const note = shown < rows
      ? h('span', { class: 'note' }, `${shown.toLocaleString('en')} of ${rows.toLocaleString('en')} rows are drawn; extremes are kept`) : null;
    const parts = this.groups().flatMap((g) => {
      const drawn = this.data.columns.filter((c) => c.group === g.id).length;
      return (g.columns ?? 0) > drawn ? [`${drawn} of ${g.columns} ${g.title.toLowerCase()}`] : [];
    });
    const left_out = parts.length > 0 ? h('span', { class: 'note' }, `Drawn are ${parts.join(', ')}; --columns NAME,… draws others`) : null;
    return h('div', { class: 'plots-head' }, this.group_chips, this.unzoom, note, left_out, bands_key(this.data.bands));
  }

  private chips(): void {
    if (this.plots.length < 2) return;
    for (const plot of this.plots) {
      const chip = h('button', { type: 'button', class: 'chip', 'aria-pressed': 'true', click: () => {
        plot.element.hidden = !plot.element.hidden;
        chip.setAttribute('aria-pressed', String(!plot.element.hidden));
        this.resize();
      } }, plot.group.title);
      this.group_chips.append(chip);
    }
  }

  hover(cursor: Cursor | null): void {
    this.cursor = cursor;
    this.last_reading = 0;
    this.request();
  }

  zoom(range: [number, number] | null): void {
    const [start, end] = this.whole();
    let [from, to] = range ?? [start, end];
    from = Math.max(start, from);
    to = Math.min(end, to);
    // In a shorter range the times of neighbouring pixels would be the same double.
    if (!(to - from > 1e-12 * Math.max(Math.abs(start), Math.abs(end)))) return;
    this.range = [from, to];
    this.unzoom.hidden = from === start && to === end;
    for (const p of this.plots) p.rescale();
    this.request();
  }

  seek(time: number): void { this.clock.seek(time); }

  private request(): void {
    if (this.pending) return;
    this.pending = true;
    requestAnimationFrame(() => { this.pending = false; this.read(); });
  }

  private read(): void {
    const now = performance.now();
    // Numbers that change sixty times a second cannot be read.
    const due = !this.clock.playing || this.cursor !== null || now - this.last_reading > 120;
    if (due) this.last_reading = now;
    for (const p of this.plots) {
      if (p.element.hidden) continue;
      p.move(this.clock.time);
      if (due) p.point(this.cursor, this.clock.time);
    }
  }

  private resize(width?: number): void {
    const shown = this.plots.filter((p) => !p.element.hidden), widths = shown.map((p) => width ?? p.chart_width);
    shown.forEach((p, k) => p.resize(widths[k]));
    this.request();
  }
}
