// The plane z = const with a grid that fades out around the point looked at, and receives shadows.

import { BufferAttribute, BufferGeometry, Color, Group, LineBasicMaterial, LineSegments, Mesh, PlaneGeometry, ShadowMaterial } from 'three';
import { nice } from './format.ts';

const cells = 30;          // on each side of the centre

export class Ground {
  readonly group = new Group();
  spacing = 1;
  private readonly grid: LineSegments;
  private readonly shade: Mesh;

  constructor(private readonly z: number, color: string, dark: boolean, solid: boolean) {
    this.grid = new LineSegments(faded_grid(new Color(color)), new LineBasicMaterial({ vertexColors: true, transparent: true, depthWrite: false }));
    this.grid.renderOrder = -1;
    this.shade = new Mesh(new PlaneGeometry(2 * cells, 2 * cells), new ShadowMaterial({ opacity: dark ? 0.45 : 0.16, depthWrite: false }));
    this.shade.renderOrder = -2;
    this.shade.receiveShadow = true;
    this.shade.visible = solid;
    this.group.add(this.shade, this.grid);
  }

  show(lines: boolean): void { this.grid.visible = lines; }

  // `span`: the length of the visible part of the plane.
  follow(x: number, y: number, span: number): void {
    if (!(span > 0) || !Number.isFinite(x + y)) return;
    this.spacing = nice(span / 14);
    const step = 5 * this.spacing;
    this.group.position.set(Math.round(x / step) * step, Math.round(y / step) * step, this.z);
    this.group.scale.set(this.spacing, this.spacing, 1);
  }
}

// Every fifth line is stronger. Lines are cut at the crossings so that they can fade with the distance.
function faded_grid(color: Color): BufferGeometry {
  const points: number[] = [], colors: number[] = [];
  const add = (x: number, y: number, strong: boolean): void => {
    points.push(x, y, 0);
    const fade = Math.max(0, 1 - (x * x + y * y) / (cells * cells));
    colors.push(color.r, color.g, color.b, fade * fade * (strong ? 0.3 : 0.12));
  };
  for (let i = -cells; i <= cells; ++i) {
    for (let j = -cells; j < cells; ++j) {
      add(i, j, i % 5 === 0); add(i, j + 1, i % 5 === 0);
      add(j, i, i % 5 === 0); add(j + 1, i, i % 5 === 0);
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(new Float32Array(points), 3));
  geometry.setAttribute('color', new BufferAttribute(new Float32Array(colors), 4));
  return geometry;
}
