// The data of a report page as the C++ side writes them (CONTRACT.md), and the decoded data that the viewer uses.

import type { RawScene } from './scene.ts';

export interface RawColumn { name: string; html: string; unit: string; group: string; data: string; t?: string }
// columns: the number of columns of the group in the run; fewer may be plotted.
export interface Group { id: string; title: string; log: boolean; columns?: number }
export interface Event { t: number; name: string }
// The modes of a contact: spans [from, to, mode] of time with the mode 0 (open), 1 (slips) or 2 (sticks).
export interface Band { name: string; spans: [number, number, number][] }
export interface RawCase {
  name: string; rows: number; shown: number; t: string; unit: string;
  caution?: string; rough?: boolean;        // a warning on what the picture shows wrongly, and whether paths would be wrong
  columns: RawColumn[]; groups: Group[];
  frames: null | { t: string; data: Record<string, string> };
  events: Event[]; bands?: Band[]; scene: null | RawScene;
}
export interface RawReport { format: number; title: string; cases: RawCase[] }

// Columns that share their times share the array, so `a.t === b.t` tells that row k of one is row k of the other.
export interface Column { name: string; html: string; unit: string; group: string; t: Float64Array; data: Float64Array }

// A sampled function of time; rows of equal t are the two sides of a jump.
export interface Samples { t: Float64Array; value: Float64Array }

export interface Case {
  name: string; rows: number; shown: number; unit: string;
  caution: string; rough: boolean;
  start: number; end: number;
  columns: Column[]; groups: Group[]; events: Event[]; bands: Band[];
  frames: Float64Array;                     // times of the animation's rows
  animated(column: number): Samples;        // rows of a column for the animation
  scene: RawScene | null;
}

export interface Report { title: string; cases: Case[] }

const little = new Uint8Array(new Uint32Array([1]).buffer)[0] === 1;

export function decode(base64: string): Float64Array {
  const single = base64.startsWith('f:'), size = single ? 4 : 8;
  const text = atob(single ? base64.slice(2) : base64);
  if (text.length % size !== 0) throw new Error(`a column has ${text.length} bytes, which is no whole number of ${single ? 'floats' : 'doubles'}`);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  const view = new DataView(bytes.buffer);
  // Floats become the decimals with the 7 digits that they have: 1.2, not 1.2000000476837158.
  if (single) return Float64Array.from({ length: bytes.length / 4 }, (_, k) => Number(view.getFloat32(4 * k, true).toPrecision(7)));
  if (little) return new Float64Array(bytes.buffer);
  return Float64Array.from({ length: bytes.length / 8 }, (_, k) => view.getFloat64(8 * k, true));
}

export function read_report(raw: RawReport): Report {
  if (raw.format !== 1) throw new Error(`the data have format ${raw.format}; this viewer reads format 1`);
  return { title: raw.title ?? '', cases: raw.cases.map(read_case) };
}

export function read_case(raw: RawCase): Case {
  const times = decode(raw.t);
  const columns = raw.columns.map((c): Column => {
    const t = c.t === undefined || c.t === null ? times : decode(c.t);
    const data = decode(c.data);
    if (t.length !== data.length) throw new Error(`column ${c.name} has ${data.length} values at ${t.length} times`);
    return { name: c.name, html: c.html ?? '', unit: c.unit ?? '', group: c.group, t, data };
  });
  const frames = raw.frames ? decode(raw.frames.t) : longest(times, columns);
  const in_frames = new Map<number, Float64Array>();
  const animated = (k: number): Samples => {
    const text = raw.frames?.data[String(k)];
    if (text === undefined) {
      if (!columns[k]) throw new Error(`the scene reads column ${k}; there are ${columns.length}`);
      return { t: columns[k].t, value: columns[k].data };
    }
    let value = in_frames.get(k);
    if (!value) in_frames.set(k, value = decode(text));
    if (value.length !== frames.length) throw new Error(`column ${k} has ${value.length} values at ${frames.length} frames`);
    return { t: frames, value };
  };
  // If the case has common times, columns with times of their own, such as the step sizes, do not change start and end.
  const [start, end] = extent(times.length > 0 ? [times, frames] : [frames, ...columns.map((c) => c.t)]);
  return {
    name: raw.name ?? '', rows: raw.rows, shown: raw.shown, unit: raw.unit ?? '', start, end,
    caution: raw.caution ?? '', rough: raw.rough ?? false,
    columns, groups: raw.groups ?? [], events: raw.events ?? [], bands: raw.bands ?? [], frames, animated, scene: raw.scene ?? null,
  };
}

// Returns the common times, or if they are empty the longest list of times of a column.
function longest(times: Float64Array, columns: Column[]): Float64Array {
  return times.length > 0 ? times : columns.reduce((best, c) => (c.t.length > best.length ? c.t : best), times);
}

function extent(all: Float64Array[]): [number, number] {
  let start = Infinity, end = -Infinity;
  for (const t of all) {
    if (t.length === 0) continue;
    start = Math.min(start, t[0]);
    end = Math.max(end, t[t.length - 1]);
  }
  return start <= end ? [start, end] : [0, 0];
}
