// The modes of contacts within a range of time.

import type { Band } from './data.ts';

export interface Strip { x: number; width: number; mode: number }

// Returns the strips of a band within a range; x and width are fractions of the range.
export function strips(band: Band, from: number, to: number): Strip[] {
  const part = (t: number): number => (Math.min(to, Math.max(from, t)) - from) / (to - from || 1);
  return band.spans.map(([begin, end, mode]) => ({ x: part(begin), width: part(end) - part(begin), mode })).filter((s) => s.width > 0);
}
