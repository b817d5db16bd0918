// Computes the positions of all items of a scene at a time, without drawing. The player, the headless recording and the tests
// use these positions.

import { decode, type Case } from './data.ts';
import { interpolate, type Input, type Side } from './interpolate.ts';
import { compile, type Entry, type Program } from './program.ts';
import { place, placement, type Motion, type Placement, type Vector } from './rotation.ts';

type Slots3 = [number, number, number];
export type Kind = 'body' | 'point' | 'frame' | 'line' | 'vector' | 'trace';
export type Frame = 'observer' | 'inertial';

export interface Item {
  name: string; label?: string; kind: Kind; color?: string | null;
  shape?: string; sizes?: number[]; position?: Slots3; axes?: number[] | null;
  points?: Slots3[]; what?: string; of?: string; vector?: Slots3;
}

export interface RawScene {
  inputs: { column: number; d1?: number; d2?: number }[];
  code: Entry[];
  items: Item[];
  observer: null | { t: string; quaternion: string; origin: string };
  camera: { eye: Slots3 | null; target: Slots3 | null; up: Vector; flat: boolean; follow: string | null };
  floor: null | false | { z: number };     // false: no floor and no grid
}

export interface Pose { name: string; kind: Kind; position: Vector; axes: number[] | null; vector?: Vector; points?: Vector[] }

export class SceneModel {
  readonly items: Item[];
  readonly camera: RawScene['camera'];
  readonly floor: RawScene['floor'];
  readonly motion: Motion | null;
  private readonly program: Program;
  private readonly inputs: (Input | null)[];      // null: the time itself
  private readonly input_values: Float64Array;
  private readonly slots: Float64Array;
  private at: { time: number; side: Side } | null = null;

  constructor(private readonly data: Case, raw: RawScene) {
    this.items = raw.items ?? [];
    this.camera = { ...{ eye: null, target: null, up: [0, 0, 1], flat: false, follow: null }, ...raw.camera };
    this.floor = raw.floor ?? null;
    this.inputs = raw.inputs.map((i) => this.input(i));
    this.program = compile(raw.code, this.inputs.length);
    this.input_values = new Float64Array(this.inputs.length);
    this.slots = new Float64Array(this.program.size);
    this.motion = raw.observer && {
      t: decode(raw.observer.t), quaternion: decode(raw.observer.quaternion), origin: decode(raw.observer.origin),
    };
    for (const item of this.items) this.check(item);
  }

  // A derivative whose times differ from those of the value is not used, and the interpolation has a lower degree.
  private input(raw: { column: number; d1?: number; d2?: number }): Input | null {
    if (raw.column < 0) return null;
    const { t, value } = this.data.animated(raw.column);
    const beside = (k: number | undefined): Float64Array | null => {
      if (k === undefined || k === null || k < 0) return null;
      const s = this.data.animated(k);
      return s.t === t ? s.value : null;
    };
    return { t, value, d1: beside(raw.d1), d2: beside(raw.d2) };
  }

  private check(item: Item): void {
    const slots = [item.position, item.axes, item.vector, ...(item.points ?? [])].flatMap((s) => s ?? []);
    if (slots.some((s) => !(Number.isInteger(s) && s >= 0 && s < this.program.size))) {
      throw new Error(`${item.kind} ${item.name} reads a slot that the scene does not have`);
    }
    if (item.kind !== 'line' && !item.position) throw new Error(`${item.kind} ${item.name} has no position`);
  }

  private evaluate(time: number, side: Side): void {
    if (this.at && this.at.time === time && this.at.side === side) return;
    this.inputs.forEach((input, k) => { this.input_values[k] = input ? interpolate(input, time, side) : time; });
    this.program.run(this.input_values, this.slots);
    this.at = { time, side };
  }

  private vector3(s: Slots3): Vector { return [this.slots[s[0]], this.slots[s[1]], this.slots[s[2]]]; }

  // Returns the poses of all items in the observer's axes.
  pose(time: number, side: Side = 'after'): Pose[] {
    this.evaluate(time, side);
    return this.items.map((item) => this.pose_of(item));
  }

  private pose_of(item: Item): Pose {
    const points = item.points?.map((p) => this.vector3(p));
    return {
      name: item.name, kind: item.kind,
      position: item.position ? this.vector3(item.position) : points?.[0] ?? [0, 0, 0],
      axes: item.axes ? item.axes.map((s) => this.slots[s]) : null,
      ...(item.vector ? { vector: this.vector3(item.vector) } : {}),
      ...(points ? { points } : {}),
    };
  }

  position(item: Item, time: number, side: Side = 'after'): Vector {
    this.evaluate(time, side);
    return this.pose_of(item).position;
  }

  vector(item: Item, time: number): Vector {
    this.evaluate(time, 'after');
    return item.vector ? this.vector3(item.vector) : [0, 0, 0];
  }

  // Returns the point whose coordinates are three slots of the camera; null without slots.
  point(s: Slots3 | null, time: number): Vector | null {
    if (!s) return null;
    this.evaluate(time, 'after');
    return this.vector3(s);
  }

  // Returns the placement of the observer at a time; null if no observer moves.
  observer(time: number): Placement | null { return this.motion && placement(this.motion, time); }

  in_frame(frame: Frame, time: number, v: Vector): Vector {
    const p = frame === 'inertial' ? this.observer(time) : null;
    return p ? place(p, v) : v;
  }

  // Returns the times at which a path is drawn: the rows, with subdivided intervals if there are few rows. A jump has two times.
  path_times(at_least = 2000): { time: number; side: Side }[] {
    const t = this.data.frames;
    if (t.length === 0) return [{ time: this.data.start, side: 'after' }];
    const parts = Math.max(1, Math.ceil(at_least / Math.max(1, t.length - 1)));
    const times: { time: number; side: Side }[] = [{ time: t[0], side: 'after' }];
    for (let i = 1; i < t.length; ++i) {
      if (!(t[i] > t[i - 1])) { times.push({ time: t[i], side: 'after' }); continue; }
      for (let k = 1; k < parts; ++k) times.push({ time: t[i - 1] + ((t[i] - t[i - 1]) * k) / parts, side: 'after' });
      times.push({ time: t[i], side: t[i + 1] === t[i] ? 'before' : 'after' });
    }
    return times;
  }

  // Returns equally spaced times over the run, for extents and scales.
  sample_times(count = 300): number[] {
    const { start, end } = this.data;
    return Array.from({ length: count }, (_, k) => start + ((end - start) * k) / (count - 1));
  }
}
