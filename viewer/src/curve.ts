// A column as a path on the plot, and the range of the visible columns. uPlot has one list of times for all its series. Here
// each column may have its own list, so uPlot draws the axes and handles zooms, and this file draws the curves.

import type uPlot from 'uplot';
import { interval } from './interpolate.ts';
import type { Column } from './data.ts';

// Returns the rows from the last one before `from` to the first one after `to`, so that curves reach the border.
export function rows_within(t: Float64Array, from: number, to: number): [number, number] {
  if (t.length < 2) return [0, t.length - 1];
  return [interval(t, from, 'before'), Math.min(t.length - 1, interval(t, to) + 1)];
}

const drawable = (y: number, log: boolean): boolean => Number.isFinite(y) && (!log || y > 0);

// Returns the least and greatest drawable value with from <= t <= to; null if there is none.
export function value_range(columns: Column[], from: number, to: number, log: boolean): [number, number] | null {
  let low = Infinity, high = -Infinity;
  for (const { t, data } of columns) {
    const [first, last] = rows_within(t, from, to);
    for (let i = Math.max(0, first); i <= last; ++i) {
      if (t[i] < from || t[i] > to || !drawable(data[i], log)) continue;
      if (data[i] < low) low = data[i];
      if (data[i] > high) high = data[i];
    }
    // If the range lies between two rows, their values bound the visible part.
    for (const i of low <= high ? [] : [first, last]) {
      if (i < 0 || !drawable(data[i], log)) continue;
      low = Math.min(low, data[i]);
      high = Math.max(high, data[i]);
    }
  }
  return low <= high ? [low, high] : null;
}

interface Pen { moveTo(x: number, y: number): void; lineTo(x: number, y: number): void }

// Adds the curve of a column to a path, with gaps where there is no value and between the two sides of a jump. Of many rows
// in one pixel column only the first, the least, the greatest and the last are drawn, which gives the same picture.
export function trace_curve(path: Pen, column: Column, rows: [number, number], log: boolean, x_of: (t: number) => number, y_of: (y: number) => number): void {
  const { t, data } = column;
  let start = -1;
  const flush = (end: number): void => {
    if (start >= 0) piece(path, t, data, start, end, x_of, y_of);
    start = -1;
  };
  for (let i = Math.max(0, rows[0]); i <= rows[1]; ++i) {
    if (!drawable(data[i], log)) { flush(i - 1); continue; }
    if (start >= 0 && t[i] === t[i - 1] && data[i] !== data[i - 1]) flush(i - 1);
    if (start < 0) start = i;
  }
  flush(rows[1]);
}

function piece(path: Pen, t: Float64Array, y: Float64Array, first: number, last: number, x_of: (t: number) => number, y_of: (y: number) => number): void {
  const x0 = x_of(t[first]);
  const dash = t.length === 1 ? 6 : 1.5;
  path.moveTo(first === last ? x0 - dash : x0, y_of(y[first]));           // a single value between gaps is drawn as a dash
  if (first === last) { path.lineTo(x0 + dash, y_of(y[first])); return; }
  if (last - first < 2.5 * (x_of(t[last]) - x0)) {
    for (let i = first + 1; i <= last; ++i) path.lineTo(x_of(t[i]), y_of(y[i]));
    return;
  }
  for (let i = first; i <= last;) {
    const pixel = Math.floor(x_of(t[i]));
    let low = i, high = i, end = i;
    while (end + 1 <= last && Math.floor(x_of(t[end + 1])) === pixel) {
      ++end;
      if (y[end] < y[low]) low = end;
      if (y[end] > y[high]) high = end;
    }
    for (const k of [i, Math.min(low, high), Math.max(low, high), end]) path.lineTo(x_of(t[k]), y_of(y[k]));
    i = end + 1;
  }
}

// Returns the path builder that uPlot calls for a column, in canvas pixels.
export function curve_paths(column: Column, log: boolean, range: () => [number, number]): uPlot.Series.PathBuilder {
  return (u) => {
    const path = new Path2D();
    const { left, top, width, height } = u.bbox;
    const [from, to] = range(), { min = 0, max = 1 } = u.scales.y;
    const scaled = log ? Math.log10 : (y: number): number => y;
    const low = scaled(min), span = scaled(max) - low || 1;
    const x_of = (t: number): number => left + ((t - from) / (to - from || 1)) * width;
    const y_of = (y: number): number => top + height * (1 - (scaled(y) - low) / span);
    trace_curve(path, column, rows_within(column.t, from, to), log, x_of, y_of);
    return { stroke: path, fill: undefined, clip: undefined, flags: 1 };
  };
}
