// The shapes of bodies. All have a pattern, so that a turn about their axis of symmetry is visible.

import {
  BoxGeometry, BufferAttribute, CircleGeometry, Color, CylinderGeometry, DoubleSide, EdgesGeometry, Group, LineBasicMaterial,
  LineSegments, Mesh, MeshPhongMaterial, RingGeometry, SphereGeometry, TorusGeometry, type BufferGeometry, type Object3D,
} from 'three';
import { Triad } from './lines.ts';
import type { Item } from './scene.ts';

export interface Tones { base: Color; light: Color; mark: Color; dark: boolean }

export function tones(color: string, dark: boolean): Tones {
  const base = new Color(color);
  const light = base.clone().lerp(new Color('#ffffff'), dark ? 0.5 : 0.62);
  return { base, light, mark: base.clone().lerp(new Color('#000000'), 0.55), dark };
}

// Returns half the largest dimension.
export function radius(item: Item): number {
  const s = (item.sizes ?? []).map(Math.abs).filter((x) => x > 0 && Number.isFinite(x));
  if (s.length === 0) return 0;
  switch (item.shape) {
    case 'disc': case 'ring': case 'ball': case 'shell': return s[0];
    case 'torus': return s[0] + (s[1] ?? 0);
    case 'cylinder': return Math.hypot(s[0], (s[1] ?? 0) / 2);
    case 'rod': return s[0] / 2;
    case 'box': return Math.hypot(...s) / 2;
    case 'ellipsoid': return Math.max(...s);
    default: return 0;
  }
}

// Makes the shape of a body. `unit` is a length of the scene, the size of bodies without a size.
export function body(item: Item, unit: number, t: Tones): Object3D {
  const [a, b, c] = (item.sizes ?? []).map(Math.abs);
  const sized = radius(item) > 0;
  switch (sized ? item.shape : 'point') {
    case 'disc': return disc(a, t);
    case 'ring': return ring(a, t);
    case 'torus': return torus(a, b ?? 0.2 * a, t);
    case 'cylinder': return cylinder(a, b ?? a, t);
    case 'ball': return ball(a, t, false);
    case 'shell': return ball(a, t, true);
    case 'ellipsoid': return ellipsoid(a, b ?? a, c ?? b ?? a, t);
    case 'rod': return rod(a, unit, t);
    case 'box': return box(a, b ?? a, c ?? b ?? a, t);
    default: return point(item, unit, t);
  }
}

// Makes the shape of a body without a size: a ball, with axes if the body turns.
function point(item: Item, unit: number, t: Tones): Object3D {
  const group = new Group();
  group.add(ball((item.axes ? 0.07 : 0.1) * unit, { ...t, light: t.base }, false));
  if (item.axes) {
    const axes = new Triad(0.45 * unit, 0.018 * unit, t.dark, false);
    axes.set([0, 0, 0], [1, 0, 0, 0, 1, 0, 0, 0, 1]);
    group.add(axes.group);
  }
  return group;
}

const around = (x: number, y: number, parts: number): number => Math.floor(((Math.atan2(y, x) / (2 * Math.PI) + 1) % 1) * parts);

// Colours each triangle in the tone that `pick` returns for its centroid.
function patterned(geometry: BufferGeometry, pick: (x: number, y: number, z: number) => Color, translucent = false): Mesh {
  const flat = geometry.index ? geometry.toNonIndexed() : geometry;
  const p = flat.getAttribute('position');
  const colors = new Float32Array(3 * p.count);
  for (let i = 0; i + 2 < p.count; i += 3) {
    const mean = (f: (k: number) => number): number => (f(i) + f(i + 1) + f(i + 2)) / 3;
    const color = pick(mean((k) => p.getX(k)), mean((k) => p.getY(k)), mean((k) => p.getZ(k)));
    for (let k = i; k < i + 3; ++k) color.toArray(colors, 3 * k);
  }
  flat.setAttribute('color', new BufferAttribute(colors, 3));
  const material = new MeshPhongMaterial({
    vertexColors: true, shininess: 40, specular: 0x1c1c1c,
    ...(translucent ? { transparent: true, opacity: 0.55, side: DoubleSide, forceSinglePass: false, depthWrite: false } : {}),
  });
  const mesh = new Mesh(flat, material);
  mesh.castShadow = true;
  return mesh;
}

// Makes the face of a disc: quadrants within a rim, and a mark towards the body's x axis. Both faces have the same pattern, so
// that a sector has its tone on both sides.
function face(R: number, z: number, t: Tones): Mesh[] {
  const quadrant = (x: number, y: number): Color => (around(x, y, 4) % 2 === 0 ? t.base : t.light);
  const parts: [BufferGeometry, (x: number, y: number) => Color, number][] = [
    [new RingGeometry(0.001 * R, 0.86 * R, 64, 1), quadrant, 0],
    [new RingGeometry(0.86 * R, R, 64, 1), () => t.base, 0],
    [new CircleGeometry(0.075 * R, 24).translate(0.68 * R, 0, 0), () => t.mark, 0.002 * R],
  ];
  return parts.map(([geometry, pick, lift]) => {
    if (z < 0) geometry.rotateX(Math.PI);
    return patterned(geometry.translate(0, 0, z + Math.sign(z) * lift), pick);
  });
}

function round(R: number, height: number, t: Tones, pick: (x: number, y: number) => Color): Object3D {
  const side = new CylinderGeometry(R, R, height, 64, 1, true).rotateX(Math.PI / 2);
  const group = new Group();
  group.add(patterned(side, pick), ...face(R, height / 2, t), ...face(R, -height / 2, t));
  return group;
}

function disc(R: number, t: Tones): Object3D { return round(R, 0.035 * R, t, (x, y) => (around(x, y, 32) % 2 === 0 ? t.base : t.mark)); }

function cylinder(R: number, height: number, t: Tones): Object3D {
  return round(R, height, t, (x, y) => (around(x, y, 4) % 2 === 0 ? t.base : t.light));
}

function ring(R: number, t: Tones): Object3D {
  const tube = 0.04 * R;
  const group = new Group();
  group.add(patterned(new TorusGeometry(R - tube, tube, 14, 96), (x, y) => (around(x, y, 12) % 2 === 0 ? t.base : t.light)));
  const spokes = [0, 1, 2, 3].map((k) => new CylinderGeometry(0.25 * tube, 0.25 * tube, 2 * (R - tube), 8).rotateZ((k * Math.PI) / 4));
  for (const s of spokes) group.add(patterned(s, () => t.base));
  group.add(patterned(new SphereGeometry(1.5 * tube, 20, 12).translate(R - tube, 0, 0), () => t.mark));
  return group;
}

// Makes a torus: the circle in the middle of the tube has the radius R, the tube the radius r. A mark shows the body's x axis.
function torus(R: number, r: number, t: Tones): Object3D {
  const group = new Group();
  group.add(patterned(new TorusGeometry(R, r, 28, 96), (x, y) => (around(x, y, 12) % 2 === 0 ? t.base : t.light)));
  group.add(patterned(new SphereGeometry(0.3 * r, 20, 12).translate(R + r, 0, 0), () => t.mark));
  return group;
}

function ball(R: number, t: Tones, shell: boolean): Object3D {
  const sphere = new SphereGeometry(R, 48, 32).rotateX(Math.PI / 2);
  const octant = (x: number, y: number, z: number): Color => (x * y * z > 0 ? t.base : t.light);
  const lune = (x: number, y: number): Color => (around(x, y, 12) % 2 === 0 ? t.base : t.light);
  return patterned(sphere, shell ? lune : octant, shell);
}

// Makes an ellipsoid. The half axes scale the geometry, not the object, whose pose must be a rotation.
function ellipsoid(a: number, b: number, c: number, t: Tones): Object3D {
  const sphere = new SphereGeometry(1, 64, 40).rotateX(Math.PI / 2).scale(a, b, c);
  sphere.computeVertexNormals();
  return patterned(sphere, (x, y, z) => (x * y * z > 0 ? t.base : t.light));
}

function rod(length: number, unit: number, t: Tones): Object3D {
  const r = Math.min(0.03 * length, 0.035 * unit);
  const group = new Group();
  group.add(patterned(new CylinderGeometry(r, r, length, 20).rotateZ(Math.PI / 2), () => t.base));
  for (const end of [-1, 1]) group.add(patterned(new SphereGeometry(1.7 * r, 20, 12).translate((end * length) / 2, 0, 0), () => t.mark));
  return group;
}

function box(a: number, b: number, c: number, t: Tones): Object3D {
  const least = 0.01 * Math.max(a, b, c);                // the two faces of a plate without thickness would overlap
  const geometry = new BoxGeometry(Math.max(a, least), Math.max(b, least), Math.max(c, least), 8);
  const group = new Group();
  // The end towards the body's x axis is light, to show the direction.
  group.add(patterned(geometry, (x) => (x > 0.376 * a ? t.light : t.base)));
  const edges = new LineSegments(new EdgesGeometry(geometry), new LineBasicMaterial({ color: t.mark, transparent: true, opacity: 0.6 }));
  group.add(edges);
  return group;
}
