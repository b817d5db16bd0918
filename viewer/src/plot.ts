// One plot: the columns of a group over time.

import uPlot from 'uplot';
import { draw_bands } from './band_drawing.ts';
import type { Case, Column, Group } from './data.ts';
import { curve_paths, value_range } from './curve.ts';
import { h } from './dom.ts';
import { exact, with_unit } from './format.ts';
import { nearest } from './interpolate.ts';
import { Legend, type Entry } from './legend.ts';
import { css_rgb, theme } from './theme.ts';
import { beside, decades, decades_around, increments, multiples, offset_of, power_label, powers, tick_labels, type Offset } from './ticks.ts';

// The place to which the reader points: a time, and for the keyboard the row of a list of times, which tells the sides of a jump.
export interface Cursor { time: number; t?: Float64Array; row?: number }

export interface Owner {
  readonly range: [number, number];
  readonly cursor: Cursor | null;
  hover(cursor: Cursor | null): void;
  zoom(range: [number, number] | null): void;
  seek(time: number): void;
}

const initially = 8;           // the number of columns shown at first, and of series colours
const dashes = [undefined, [6, 3], [2, 2.5], [8, 3, 2, 3]];

export class Plot {
  readonly element: HTMLElement;
  readonly legend: Legend;
  readonly entries: Entry[];
  private readonly chart = h('div', { class: 'chart', tabindex: '0', role: 'group' });
  private readonly moment = h('span', { class: 'moment' });
  private readonly said = h('span', { class: 'unseen', 'aria-live': 'polite' });
  private readonly note = h('p', { class: 'note', hidden: true });
  private readonly base = h('span', { class: 'note base' });
  private readonly line = h('div', { class: 'cursor-line', hidden: true });
  private readonly present = h('div', { class: 'present-line' });
  private readonly dots: HTMLElement[];
  private u: uPlot | null = null;         // made when the plot is first visible, since a page may have many plots
  private width = 0;
  private offset: Offset | null = null;

  constructor(private readonly data: Case, readonly group: Group, columns: Column[], private readonly owner: Owner) {
    this.entries = columns.map((column, k) => ({
      column, shown: k < initially, color: () => theme().series[k % initially], dash: dashes[Math.floor(k / initially) % dashes.length],
    }));
    this.legend = new Legend(this.entries, data.unit, () => this.columns_changed());
    this.dots = columns.map(() => h('div', { class: 'dot', hidden: true }));
    const unit = columns.every((c) => c.unit === columns[0].unit) ? columns[0].unit : '';
    this.chart.setAttribute('aria-label', `${group.title}, plot over time. Left and right move from row to row, Enter takes the motion there, plus and minus zoom, Escape leaves.`);
    this.element = h('figure', { class: 'plot' },
      h('figcaption', {}, h('span', { class: 'title' }, group.title), unit ? h('span', { class: 'unit' }, unit) : null, this.base, this.moment),
      this.chart, this.note, this.legend.element, this.said);
    this.chart.addEventListener('keydown', (e) => this.pressed(e));
    this.chart.addEventListener('blur', () => this.owner.hover(null));
    this.notes();
  }

  wake(): void {
    if (this.u || this.element.hidden) return;
    this.u = new uPlot(this.options(), this.empty(), this.chart);
    this.u.over.append(this.present, this.line, ...this.dots);
    this.listen(this.u.over);
    this.resize(this.width || this.chart_width);
  }

  // Dummy data for uPlot, which does not draw the curves but needs data.
  private empty(): uPlot.AlignedData { return [[this.data.start, this.data.end], ...this.entries.map(() => [null, null])] as uPlot.AlignedData; }

  private options(): uPlot.Options {
    const { log } = this.group;
    const labelled = (u: uPlot, splits: number[]): (number | null)[] => powers(splits, Math.max(2, u.bbox.height / (devicePixelRatio || 1) / 30));
    const splits = (_u: uPlot, _axis: number, low: number, high: number, step: number): number[] => (log && _axis === 1 ? decades(low, high) : multiples(low, high, step));
    const grid = { stroke: () => css_rgb(theme().line), width: 1 };
    const axis = { stroke: () => css_rgb(theme().quiet), font: '12px system-ui, sans-serif', incrs: increments, splits, ticks: { show: false }, border: { show: true, stroke: () => css_rgb(theme().line), width: 1 } };
    return {
      width: 600, height: 220, legend: { show: false },
      padding: [8, 28, 0, 0],      // the right margin holds half of the longest label of a time
      cursor: { x: false, y: false, points: { show: false }, drag: { x: true, y: false, setScale: false, dist: 5 },
        bind: { dblclick: () => () => { this.owner.zoom(null); return null; } } },
      scales: {
        x: { time: false, range: () => this.owner.range },
        y: { distr: log ? 3 : 1, range: () => this.y_range() },
      },
      axes: [
        { ...axis, grid: { ...grid, show: false }, size: 30, gap: 6, space: 70, values: (_u, v, _a, _s, step) => tick_labels(v, step, 0) },
        { ...axis, grid: log ? { ...grid, filter: labelled } : grid, ...(log ? { filter: labelled } : {}), size: 64, gap: 6, space: 34, values: (_u, v, _a, _s, step) => (log ? v.map(power_label) : tick_labels(v, step, this.offset?.value ?? 0)) },
      ],
      series: [{}, ...this.entries.map((e): uPlot.Series => ({
        show: e.shown, stroke: () => css_rgb(e.color()), width: 1.5, dash: e.dash, points: { show: false },
        paths: curve_paths(e.column, log, () => this.owner.range),
      }))],
      hooks: {
        drawAxes: [(u) => this.draw_events(u)],
        setSelect: [(u) => this.selected(u)],
        ready: [(u) => { u.root.querySelector('canvas')?.setAttribute('aria-hidden', 'true'); }],
      },
    };
  }

  private visible(): Column[] { return this.entries.filter((e) => e.shown).map((e) => e.column); }

  private y_range(): [number, number] {
    const { log } = this.group;
    const found = value_range(this.visible(), ...this.owner.range, log);
    this.offset = null;
    if (!found) return log ? [1e-16, 1] : [0, 1];
    let [low, high] = found;
    if (log) return decades_around(low, high);
    // Finer ticks would have equal labels, as a double has no more digits.
    const least = 4e-14 * Math.max(Math.abs(low), Math.abs(high));
    if (high - low < least) { const middle = (low + high) / 2; low = middle - least / 2; high = middle + least / 2; }
    if (high === low) { low -= 1; high += 1; }
    const pad = 0.06 * (high - low);
    this.offset = offset_of(low, high);
    this.base.textContent = this.offset ? `${this.offset.text} +` : '';
    return [low - pad, high + pad];
  }

  private notes(): void {
    const texts: string[] = [];
    if (this.group.log) {
      const shown = this.visible();
      const any = (f: (x: number) => boolean): boolean => shown.some((c) => c.data.some(f));
      const zeros = any((x) => x === 0), negative = any((x) => x < 0);
      if (zeros && negative) texts.push('exact zeros and negative values are not drawn');
      else if (zeros) texts.push('exact zeros are not drawn');
      else if (negative) texts.push('negative values are not drawn');
    }
    if (this.visible().length === 0) texts.push('no column is shown');
    this.note.textContent = texts.join('; ');
    this.note.hidden = texts.length === 0;
  }

  private columns_changed(): void {
    const { u } = this;
    u?.batch(() => this.entries.forEach((e, k) => { if (u.series[k + 1].show !== e.shown) u.setSeries(k + 1, { show: e.shown }); }));
    this.rescale();
    this.notes();
    this.owner.hover(this.owner.cursor);
  }

  // Applies a change of the range of the owner.
  rescale(): void {
    this.base.textContent = '';
    const { u } = this;
    u?.batch(() => {
      u.setScale('x', { min: this.owner.range[0], max: this.owner.range[1] });
      u.redraw(true, true);
    });
    this.legend.update();
  }

  recolor(): void { this.u?.redraw(true, true); this.legend.update(); }

  resize(width: number): void {
    if (width <= 0) return;
    this.width = width;
    const height = width < 500 ? 190 : 220;
    this.chart.style.minHeight = `${height}px`;
    if (this.u && (this.u.width !== width || this.u.height !== height)) this.u.setSize({ width, height });
  }

  get chart_width(): number { return this.chart.clientWidth; }

  // Shows the values at the cursor, or without a cursor at the present time.
  point(cursor: Cursor | null, present: number): void {
    const at = cursor ?? { time: present };
    const rows = this.entries.map(({ column }) => (at.t === column.t && at.row !== undefined ? at.row : nearest(column.t, at.time)));
    const lead = Math.max(0, this.entries.findIndex((e) => e.shown));
    const time = rows[lead] >= 0 ? this.entries[lead].column.t[rows[lead]] : at.time;
    this.legend.read(rows, time);
    this.moment.textContent = `t = ${with_unit(exact(time), this.data.unit)}`;
    this.moment.classList.toggle('pointed', cursor !== null);
    const { u } = this;
    if (!u) return;
    this.place(this.line, time, cursor !== null);
    this.entries.forEach(({ column, shown, color }, k) => {
      const t = column.t[rows[k]], y = column.data[rows[k]];
      const on = cursor !== null && shown && Number.isFinite(y) && (!this.group.log || y > 0);
      this.place(this.dots[k], t, on);
      if (!on) return;
      this.dots[k].style.top = `${u.valToPos(y, 'y')}px`;
      this.dots[k].style.background = color();
    });
  }

  // Moves the line of the present time.
  move(present: number): void { this.place(this.present, present, true); }

  private place(element: HTMLElement, time: number, on: boolean): void {
    const [from, to] = this.owner.range;
    const inside = on && time >= from && time <= to;
    element.hidden = !inside;
    if (inside && this.u) element.style.left = `${this.u.valToPos(time, 'x')}px`;
  }

  private selected(u: uPlot): void {
    if (u.select.width < 5) return;
    const range: [number, number] = [u.posToVal(u.select.left, 'x'), u.posToVal(u.select.left + u.select.width, 'x')];
    u.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
    this.owner.zoom(range);
  }

  private listen(over: HTMLElement): void {
    const time_at = (e: MouseEvent): number => this.u!.posToVal(e.clientX - over.getBoundingClientRect().left, 'x');
    let down = 0;
    over.addEventListener('pointermove', (e) => this.owner.hover({ time: time_at(e) }));
    over.addEventListener('pointerleave', () => this.owner.hover(null));
    over.addEventListener('pointerdown', (e) => { down = e.clientX; });
    over.addEventListener('click', (e) => { if (Math.abs(e.clientX - down) < 5) this.owner.seek(time_at(e)); });
  }

  private pressed(e: KeyboardEvent): void {
    if (e.ctrlKey || e.metaKey || e.altKey) return;
    const column = this.visible()[0];
    if (!column || column.t.length === 0) return;
    const { t } = column, last = t.length - 1, c = this.owner.cursor;
    const now = c?.t === t && c.row !== undefined ? c.row : nearest(t, c?.time ?? this.owner.range[0]);
    const by: Record<string, number> = { ArrowLeft: -1, ArrowRight: 1, PageUp: -Math.ceil(last / 20), PageDown: Math.ceil(last / 20), Home: -last, End: last };
    const middle = c?.time ?? (this.owner.range[0] + this.owner.range[1]) / 2;
    if (e.key in by) {
      const row = Math.min(last, Math.max(0, c ? now + by[e.key] : now));
      this.owner.hover({ time: t[row], t, row });
      this.say();
    } else if (e.key === 'Enter') this.owner.seek(middle);
    else if (e.key === 'Escape') this.owner.hover(null);
    else if (e.key === '+' || e.key === '=' || e.key === '-') {
      const factor = e.key === '-' ? 2 : 0.5;
      this.owner.zoom(this.owner.range.map((x) => middle + factor * (x - middle)) as [number, number]);
    } else if (e.key === '0') this.owner.zoom(null);
    else return;
    e.preventDefault();
  }

  private timer = 0;
  private say(): void {
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => {
      const c = this.owner.cursor;
      if (!c) return;
      const values = this.entries.filter((x) => x.shown).slice(0, 4).map(({ column }) => `${column.name} ${column.data[nearest(column.t, c.time)]?.toPrecision(6)}`);
      this.said.textContent = `t ${c.time.toPrecision(6)}; ${values.join('; ')}`;
    }, 400);
  }

  private draw_events(u: uPlot): void {
    const { ctx, bbox } = u, [from, to] = this.owner.range, pixel = devicePixelRatio || 1;
    ctx.save();
    draw_bands(ctx, bbox, this.data.bands, [from, to], pixel);
    ctx.strokeStyle = css_rgb(theme().quiet, 0.7);
    ctx.fillStyle = css_rgb(theme().quiet);
    ctx.lineWidth = pixel;
    ctx.setLineDash([2 * pixel, 3 * pixel]);
    ctx.font = `${11 * pixel}px system-ui, sans-serif`;
    ctx.textBaseline = 'top';
    ctx.textAlign = 'left';
    let free = -Infinity;
    for (const { t, name } of this.data.events) {
      if (!(t >= from && t <= to)) continue;
      const x = Math.round(bbox.left + ((t - from) / (to - from || 1)) * bbox.width) + 0.5;
      ctx.beginPath();
      ctx.moveTo(x, bbox.top);
      ctx.lineTo(x, bbox.top + bbox.height);
      ctx.stroke();
      const text = name.length > 24 ? `${name.slice(0, 23)}\u2026` : name, width = ctx.measureText(text).width;
      const at = beside(x, width, 4 * pixel, free, bbox.left + bbox.width);
      if (at === null) continue;
      ctx.fillText(text, at, bbox.top + 2 * pixel);
      free = at + width + 8 * pixel;
    }
    ctx.restore();
  }
}
