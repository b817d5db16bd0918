// The size of a scene and the range of its motion, for the first position of the camera.

import { radius } from './shapes.ts';
import type { Frame, Item, SceneModel } from './scene.ts';
import type { Vector } from './rotation.ts';

export interface Extent {
  points: { at: Vector; r: number }[];     // balls that the motion fills
  center: Vector;
  radius: number;                          // of a ball about the centre that contains all these balls
  unit: number;                            // size of the largest body, or if no body has a size, a length for drawing
  far: boolean;                            // the range is so large that bodies would be tiny: the camera should follow one
}

export const placed = (item: Item): boolean => item.kind === 'body' || item.kind === 'point' || item.kind === 'frame';

// Math.max(...) accepts some ten thousand numbers at most, and a long chain has more points.
function greatest<T>(list: T[], of: (element: T) => number): number {
  let most = -Infinity;
  for (const element of list) most = Math.max(most, of(element));
  return most;
}

export function extent(model: SceneModel, frame: Frame): Extent {
  const items = model.items.filter((i) => placed(i) || i.kind === 'line');
  const sizes = items.map(radius);
  const index = new Map(items.map((item, k) => [item, k]));
  const largest = Math.max(0, ...sizes);
  const points: Extent['points'] = [];
  for (const time of model.sample_times()) {
    const poses = model.pose(time);
    model.items.forEach((item, k) => {
      const at_index = index.get(item);
      if (at_index === undefined) return;
      for (const p of poses[k].points ?? [poses[k].position]) {
        const at = model.in_frame(frame, time, p);
        if (at.every(Number.isFinite)) points.push({ at, r: sizes[at_index] });
      }
    });
  }
  leave_runaways(points, largest);
  if (points.length === 0) points.push({ at: [0, 0, 0], r: largest });
  const center = [0, 1, 2].map((k) => {
    const low = -greatest(points, (p) => p.r - p.at[k]), high = greatest(points, (p) => p.at[k] + p.r);
    return (low + high) / 2;
  }) as Vector;
  const reach = greatest(points, (p) => Math.hypot(...p.at.map((x, k) => x - center[k])) + p.r);
  const ball = reach > 0 ? reach : 1;
  const unit = largest > 0 ? largest : 0.3 * ball;
  return { points, center, radius: ball, unit, far: largest > 0 && ball > 30 * largest };
}

// Removes the balls of the last moments of a motion that grows without bound, beside which the rest would be tiny. It removes
// a tenth of the balls at most, and only if some are a thousand times as far as the others.
export function leave_runaways(points: Extent['points'], least: number): void {
  if (points.length < 10) return;
  const typical = (values: number[], part: number): number => [...values].sort((a, b) => a - b)[Math.floor(part * (values.length - 1))];
  const middle = [0, 1, 2].map((k) => typical(points.map((p) => p.at[k]), 0.5));
  const far = points.map((p) => Math.hypot(...p.at.map((x, k) => x - middle[k])));
  const usual = Math.max(typical(far, 0.9), least);
  if (!(usual > 0) || !(greatest(far, (x) => x) > 1000 * usual)) return;
  let kept = 0;
  points.forEach((p, k) => { if (far[k] <= 10 * usual) points[kept++] = p; });
  points.length = kept;
}

// Returns the radius about a followed item in which the other items stay, limited so that the item remains visible.
export function company(model: SceneModel, name: string, unit: number): number {
  const k = model.items.findIndex((i) => i.name === name && placed(i));
  let reach = 0;
  for (const time of model.sample_times(60)) {
    const poses = model.pose(time);
    model.items.forEach((item, j) => {
      if (!placed(item)) return;
      const d = Math.hypot(...poses[j].position.map((x, c) => x - poses[k].position[c])) + radius(item);
      if (Number.isFinite(d)) reach = Math.max(reach, d);
    });
  }
  return Math.min(Math.max(1.2 * reach, 3 * unit), 9 * unit);
}
