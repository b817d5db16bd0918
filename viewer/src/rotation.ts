// Rotations of the observer: unit quaternions (w, x, y, z) between rows, applied to points and axes.

import { interval } from './interpolate.ts';

export type Vector = [number, number, number];
export type Quaternion = [number, number, number, number];

// Interpolates on the great circle between two rows, the short way, as q and -q are the same rotation.
export function slerp(values: Float64Array, i: number, s: number): Quaternion {
  const a: Quaternion = [values[4 * i], values[4 * i + 1], values[4 * i + 2], values[4 * i + 3]];
  const b: Quaternion = [values[4 * i + 4], values[4 * i + 5], values[4 * i + 6], values[4 * i + 7]];
  let dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
  const turn = dot < 0 ? -1 : 1;
  dot = Math.min(1, Math.abs(dot));
  const angle = Math.acos(dot);
  // Below this angle sin(angle) loses digits, and chord and arc differ by the cube of the angle only.
  const [wa, wb] = angle < 1e-4 ? [1 - s, s] : [Math.sin((1 - s) * angle) / Math.sin(angle), Math.sin(s * angle) / Math.sin(angle)];
  const q = a.map((x, k) => wa * x + turn * wb * b[k]);
  const norm = Math.hypot(...q);
  return q.map((x) => x / norm) as Quaternion;
}

export interface Motion { t: Float64Array; quaternion: Float64Array; origin: Float64Array }
export interface Placement { quaternion: Quaternion; origin: Vector }

export function placement(motion: Motion, time: number): Placement {
  const { t, quaternion, origin } = motion;
  const last = t.length - 1;
  const at = (i: number): Placement => ({
    quaternion: Array.from(quaternion.subarray(4 * i, 4 * i + 4)) as Quaternion,
    origin: Array.from(origin.subarray(3 * i, 3 * i + 3)) as Vector,
  });
  if (last <= 0 || time <= t[0]) return at(0);
  if (time >= t[last]) return at(last);
  const i = interval(t, time), h = t[i + 1] - t[i];
  const s = h > 0 ? (time - t[i]) / h : 0;
  const mix = (k: number): number => origin[3 * i + k] + (origin[3 * i + 3 + k] - origin[3 * i + k]) * s;
  return { quaternion: slerp(quaternion, i, s), origin: [mix(0), mix(1), mix(2)] };
}

// Returns v + 2 w (u x v) + 2 u x (u x v) for q = (w, u).
export function rotate(q: Quaternion, v: Vector): Vector {
  const [w, x, y, z] = q;
  const c: Vector = [y * v[2] - z * v[1], z * v[0] - x * v[2], x * v[1] - y * v[0]];
  return [
    v[0] + 2 * (w * c[0] + y * c[2] - z * c[1]),
    v[1] + 2 * (w * c[1] + z * c[0] - x * c[2]),
    v[2] + 2 * (w * c[2] + x * c[1] - y * c[0]),
  ];
}

export function place(p: Placement, v: Vector): Vector {
  const r = rotate(p.quaternion, v);
  return [r[0] + p.origin[0], r[1] + p.origin[1], r[2] + p.origin[2]];
}
