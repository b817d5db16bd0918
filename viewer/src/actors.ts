// The objects that are drawn for the items of a scene, and their places at a time.

import { Group, Matrix4, Mesh, MeshBasicMaterial, SphereGeometry, type Object3D } from 'three';
import type { LineSegments2 } from 'three/examples/jsm/lines/LineSegments2.js';
import { Arrow, Trace, Triad, chain, middle, segments } from './lines.ts';
import type { Vector } from './rotation.ts';
import type { Frame, Item, Pose, SceneModel } from './scene.ts';
import { body, tones } from './shapes.ts';
import { mixed, type Theme } from './theme.ts';

export interface Shown { traces: boolean; frames: boolean; vectors: Set<string>; scale: number; labels: boolean; grid: boolean }

// Returns the colour of an item: the series colours go by the order of the bodies, and items of a body have its colour.
export function color_of(model: SceneModel, item: Item, theme: Theme): string {
  if (item.color && CSS.supports('color', item.color)) return item.color;
  const owner = item.of ?? item.name;
  const bodies = model.items.filter((i) => i.kind === 'body');
  const own = bodies.find((i) => i.name === owner);
  if (own?.color && own !== item) return color_of(model, own, theme);
  const k = own ? bodies.indexOf(own) : bodies.length + model.items.filter((i) => i.kind === item.kind).indexOf(item);
  return theme.series[k % theme.series.length];
}

export function vector_color(what: string, theme: Theme): string {
  return what === 'velocity' ? theme.series[2] : what === 'reaction' ? theme.warn : theme.series[4];
}

// Returns the drawn length of one unit of each quantity, so that the larger values of the run are about as long as a body.
export function vector_scales(model: SceneModel, length: number): Map<string, number> {
  const values = new Map<string, number[]>();
  const arrows = model.items.filter((i) => i.kind === 'vector');
  for (const time of arrows.length > 0 ? model.sample_times(200) : []) {
    for (const item of arrows) {
      const size = Math.hypot(...model.vector(item, time));
      if (!values.has(item.what ?? '')) values.set(item.what ?? '', []);
      if (Number.isFinite(size)) values.get(item.what ?? '')!.push(size);
    }
  }
  return new Map([...values].map(([what, sizes]) => {
    sizes.sort((a, b) => a - b);
    // The 97 % quantile: a short peak, as at an impact, must not make all other arrows invisible.
    const high = sizes[Math.floor(0.97 * (sizes.length - 1))] || sizes[sizes.length - 1];
    return [what, high > 0 ? length / high : 0];
  }));
}

export interface Actor { item: Item; object: Object3D; update(pose: Pose, time: number, shown: Shown): void }

export interface Style { theme: Theme; unit: number; pixel: number; frame: Frame; scales: Map<string, number> }

// Makes the actors. Paths are in the frame that is drawn, all other objects in the observer's axes.
export function make_actors(model: SceneModel, style: Style): Actor[] {
  const { theme, unit, pixel } = style;
  const paths = trace_paths(model, style.frame);
  return model.items.map((item, k): Actor => {
    const color = color_of(model, item, theme);
    switch (item.kind) {
      case 'body': return placed_actor(item, body(item, unit, tones(color, theme.dark)));
      case 'point': {
        const dot = new Mesh(new SphereGeometry(0.045 * unit, 20, 14), new MeshBasicMaterial({ color: item.color ? color : theme.ink }));
        return placed_actor(item, dot);
      }
      case 'frame': {
        const triad = new Triad(0.75 * unit, 0.018 * unit, theme.dark);
        return { item, object: triad.group, update: (pose, _, shown) => {
          triad.group.visible = shown.frames;
          if (pose.axes) triad.set(pose.position, pose.axes);
        } };
      }
      case 'line': return line_actor(item, item.color ? color : theme.ink, 2 * pixel);
      case 'vector': {
        const arrow = new Arrow(vector_color(item.what ?? '', theme), 0.022 * unit);
        return { item, object: arrow.group, update: (pose, _, shown) => {
          const scale = shown.vectors.has(item.what ?? '') ? shown.scale * (style.scales.get(item.what ?? '') ?? 0) : 0;
          arrow.set(pose.position, (pose.vector ?? [0, 0, 0]).map((x) => scale * x) as Vector);
        } };
      }
      case 'trace': {
        const trace = new Trace(paths.get(k) ?? [], color, mixed(theme.panel, color, 0.42), 2 * pixel);
        return { item, object: trace.group, update: (pose, time, shown) => {
          trace.group.visible = shown.traces;
          if (shown.traces) trace.show(time, model.in_frame(style.frame, time, pose.position));
        } };
      }
    }
  });
}

function trace_paths(model: SceneModel, frame: Frame): Map<number, { time: number; at: Vector }[]> {
  const traces = model.items.flatMap((item, k) => (item.kind === 'trace' ? [{ item, k }] : []));
  const paths = new Map(traces.map(({ k }) => [k, [] as { time: number; at: Vector }[]]));
  if (traces.length === 0) return paths;
  for (const { time, side } of model.path_times()) {
    for (const { item, k } of traces) paths.get(k)!.push({ time, at: model.in_frame(frame, time, model.position(item, time, side)) });
  }
  return paths;
}

const matrix = new Matrix4();

function placed_actor(item: Item, object: Object3D): Actor {
  return { item, object, update(pose) {
    const numbers = [...pose.position, ...(pose.axes ?? [])];
    object.visible = numbers.every(Number.isFinite);
    if (!object.visible) return;
    object.position.set(...pose.position);
    const a = pose.axes;
    if (!a) return;
    matrix.set(a[0], a[3], a[6], 0, a[1], a[4], a[7], 0, a[2], a[5], a[8], 0, 0, 0, 0, 1);
    object.quaternion.setFromRotationMatrix(matrix);
  } };
}

function line_actor(item: Item, color: string, width: number): Actor {
  const group = new Group();
  let lines: LineSegments2 | null = null;
  return { item, object: group, update(pose) {
    const origin = middle(pose.points ?? []), ends = chain(pose.points ?? [], origin);
    group.visible = ends.length > 0;
    if (!group.visible) return;
    group.position.set(...origin);
    if (!lines) { lines = segments(ends, color, width); group.add(lines); }
    else lines.geometry.setPositions(ends);
  } };
}
