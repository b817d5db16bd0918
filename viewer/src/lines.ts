// Lines of a width in pixels, and arrows.

import { Color, ConeGeometry, CylinderGeometry, Group, Mesh, MeshBasicMaterial, Quaternion, Vector3 } from 'three';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';
import { LineSegments2 } from 'three/examples/jsm/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/examples/jsm/lines/LineSegmentsGeometry.js';
import type { Vector } from './rotation.ts';

export function segments(points: Float32Array, color: string, width: number): LineSegments2 {
  const geometry = new LineSegmentsGeometry();
  if (points.length > 0) geometry.setPositions(points);
  const material = new LineMaterial({ linewidth: width, transparent: true, depthWrite: false });
  material.color = new Color(color);
  const lines = new LineSegments2(geometry, material);
  lines.frustumCulled = false;
  lines.renderOrder = 4;       // after the ground and the bodies, which hide what is behind them
  lines.visible = points.length > 0;
  return lines;
}

// The graphics card has single precision, so the ends of segments are stored relative to an origin near them. Coordinates
// beyond this limit, in motions that grow without bound, are not drawn, since the squares of lengths must be floats, too.
const farthest = 1e18;

export function near(origin: Vector, at: Vector): Vector { return at.map((x, k) => x - origin[k]) as Vector; }

// Returns the middle of the box around the points, without those that have no value or lie beyond the limit.
export function middle(points: Vector[]): Vector {
  const known = points.filter((p) => p.every((x) => Math.abs(x) < farthest));
  if (known.length === 0) return [0, 0, 0];
  return [0, 1, 2].map((k) => {
    let low = Infinity, high = -Infinity;
    for (const p of known) { low = Math.min(low, p[k]); high = Math.max(high, p[k]); }
    return low + (high - low) / 2;
  }) as Vector;
}

const drawable = (at: Vector): boolean => at.every((x) => Math.abs(x) < farthest);

// Returns the ends of the segments along a chain of points, relative to the origin. A point without a value leaves a gap.
export function chain(points: Vector[], origin: Vector): Float32Array {
  const out: number[] = [];
  for (let i = 1; i < points.length; ++i) {
    const a = near(origin, points[i - 1]), b = near(origin, points[i]);
    if (drawable(a) && drawable(b)) out.push(...a, ...b);
  }
  return new Float32Array(out);
}

// The path of a point over the whole run in a faint colour, and in a strong one up to the present time.
export class Trace {
  readonly group = new Group();
  private readonly whole: LineSegments2;
  private readonly past: LineSegments2;
  private readonly tip: LineSegments2;
  private readonly starts: Vector[] = [];       // relative to the origin
  private readonly origin: Vector;
  private readonly times: number[] = [];        // [start, end] of each segment

  // `faint` is an opaque colour, since a transparent one would show where segments overlap.
  constructor(path: { time: number; at: Vector }[], color: string, faint: string, width: number) {
    const out: number[] = [];
    this.origin = middle(path.map((p) => p.at));
    for (let i = 1; i < path.length; ++i) {
      const a = near(this.origin, path[i - 1].at), b = near(this.origin, path[i].at);
      if (!(path[i].time > path[i - 1].time) || !drawable(a) || !drawable(b)) continue;      // no segment joins the two sides of a jump
      out.push(...a, ...b);
      this.starts.push(a);
      this.times.push(path[i - 1].time, path[i].time);
    }
    const points = new Float32Array(out);
    this.whole = segments(points, faint, width);
    this.past = segments(points, color, width);
    this.tip = segments(new Float32Array(points.length > 0 ? 6 : 0), color, width);
    this.whole.renderOrder = 2;
    this.past.renderOrder = this.tip.renderOrder = 3;
    this.group.position.set(...this.origin);
    this.group.add(this.whole, this.past, this.tip);
  }

  show(time: number, at: Vector): void {
    let low = 0, high = this.starts.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.times[2 * middle + 1] <= time) low = middle + 1; else high = middle;
    }
    this.past.geometry.instanceCount = low;
    this.past.visible = low > 0;
    const within = low < this.starts.length && this.times[2 * low] < time && drawable(near(this.origin, at));
    this.tip.visible = within;
    if (within) this.tip.geometry.setPositions(new Float32Array([...this.starts[low], ...near(this.origin, at)]));
  }
}

// An arrow. By default it is drawn over bodies, since a reaction starts inside one.
export class Arrow {
  readonly group = new Group();
  private readonly shaft: Mesh;
  private readonly head: Mesh;
  private readonly direction = new Vector3();

  constructor(color: string, private readonly thickness: number, over = true) {
    const material = new MeshBasicMaterial({ color, depthTest: !over, transparent: over });
    this.shaft = new Mesh(new CylinderGeometry(1, 1, 1, 12).translate(0, 0.5, 0), material);
    this.head = new Mesh(new ConeGeometry(1, 1, 20).translate(0, 0.5, 0), material);
    this.group.add(this.shaft, this.head);
    if (over) this.shaft.renderOrder = this.head.renderOrder = 10;
  }

  set(from: Vector, along: Vector): void {
    const length = Math.hypot(...along);
    this.group.visible = length > 1e-3 * this.thickness && [...from, ...along].every(Number.isFinite);
    if (!this.group.visible) return;
    const head = Math.min(5.5 * this.thickness, 0.45 * length);
    this.group.position.set(...from);
    this.group.quaternion.copy(new Quaternion().setFromUnitVectors(new Vector3(0, 1, 0), this.direction.set(...along).normalize()));
    this.shaft.scale.set(this.thickness, Math.max(length - head, 1e-9), this.thickness);
    this.head.scale.set(head * 0.38, head, head * 0.38);
    this.head.position.set(0, length - head, 0);
  }
}

export class Triad {
  readonly group = new Group();
  private readonly arrows: Arrow[];

  constructor(private readonly length: number, thickness: number, dark: boolean, over = true) {
    const colors = dark ? ['#ef7f74', '#7cc08a', '#7fa8ec'] : ['#c0392b', '#2f8f4e', '#2f62b8'];
    this.arrows = colors.map((c) => new Arrow(c, thickness, over));
    this.group.add(...this.arrows.map((a) => a.group));
  }

  set(origin: Vector, axes: number[]): void {
    this.arrows.forEach((arrow, k) => arrow.set(origin, [0, 1, 2].map((j) => this.length * axes[3 * k + j]) as Vector));
  }
}
