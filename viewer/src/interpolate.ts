// Values between rows: the polynomial through value, first and second derivative at both ends of the interval (quintic
// Hermite), through value and first derivative (cubic), or the straight line, depending on which derivatives exist and are finite.
//
// Rows of equal t are the two sides of a jump. No interval lies between them, so the interpolation never crosses a jump.

import type { Samples } from './data.ts';

export interface Input extends Samples {
  d1: Float64Array | null;    // derivatives by t, at the same rows
  d2: Float64Array | null;
}

// The side of a jump. At other times both sides are the same.
export type Side = 'before' | 'after';

// Returns the i with t[i] <= time < t[i+1] (before: t[i] < time <= t[i+1]), kept within 0 ... t.length - 2.
export function interval(t: Float64Array, time: number, side: Side = 'after'): number {
  let low = 0, high = t.length;
  while (low < high) {                                   // number of rows at or before time (before: strictly before)
    const middle = (low + high) >> 1;
    if (side === 'after' ? t[middle] <= time : t[middle] < time) low = middle + 1; else high = middle;
  }
  return Math.max(0, Math.min(low - 1, t.length - 2));
}

export function interpolate(input: Input, time: number, side: Side = 'after'): number {
  const { t, value, d1, d2 } = input;
  const n = t.length;
  if (n === 0) return NaN;
  if (n === 1 || time < t[0] || (side === 'before' && time === t[0])) return value[0];
  if (time > t[n - 1]) return value[n - 1];
  const i = interval(t, time, side);
  const h = t[i + 1] - t[i];
  if (time === t[i + 1]) return value[i + 1];            // stored rows keep their bits
  if (time === t[i] || !(h > 0)) return value[i];
  const s = (time - t[i]) / h;
  const a = value[i], b = value[i + 1];
  if (!d1 || !Number.isFinite(d1[i]) || !Number.isFinite(d1[i + 1])) return a + (b - a) * s;
  const va = h * d1[i], vb = h * d1[i + 1];
  if (!d2 || !Number.isFinite(d2[i]) || !Number.isFinite(d2[i + 1])) {
    // a + (b - a) s^2 (3 - 2 s) + va s (1 - s)^2 - vb s^2 (1 - s)
    return a + s * s * (3 - 2 * s) * (b - a) + s * (1 - s) * ((1 - s) * va - s * vb);
  }
  const wa = h * h * d2[i], wb = h * h * d2[i + 1];
  // Taylor part of the left end, then s^3 times the quadratic that meets value, slope and curvature on the right.
  const p = b - a - va - wa / 2, q = vb - va - wa, r = wb - wa;
  const c3 = 10 * p - 4 * q + r / 2, c4 = -15 * p + 7 * q - r, c5 = 6 * p - 3 * q + r / 2;
  return a + s * (va + s * (wa / 2 + s * (c3 + s * (c4 + s * c5))));
}

// Returns the stored row nearest to a time; of two rows with equal t, the one on the side from which `time` is approached.
export function nearest(t: Float64Array, time: number): number {
  const n = t.length;
  if (n < 2 || time <= t[0]) return n === 0 ? -1 : 0;
  const i = interval(t, time);
  if (i + 1 >= n || time >= t[n - 1]) return n - 1;
  return time - t[i] <= t[i + 1] - time ? i : i + 1;
}
