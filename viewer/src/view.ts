// One picture of a scene, as its observer or an inertial one sees it: a canvas, a camera, mouse and keys.

import {
  DirectionalLight, Group, HemisphereLight, OrthographicCamera, PerspectiveCamera, Scene, Vector3, type Mesh, type Object3D,
} from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { make_actors, vector_scales, type Actor, type Shown } from './actors.ts';
import { h } from './dom.ts';
import { company, extent, placed, type Extent } from './extent.ts';
import { short } from './format.ts';
import { paint } from './gl.ts';
import { Ground } from './ground.ts';
import { draw_labels } from './labels.ts';
import { Triad } from './lines.ts';
import type { Vector } from './rotation.ts';
import type { Frame, SceneModel } from './scene.ts';
import { radius } from './shapes.ts';
import { theme } from './theme.ts';

const fov = 32;

// The camera relative to its target, which may move.
export interface Look { offset: Vector; shift: Vector; zoom: number }

export class View {
  readonly canvas = h('canvas', { class: 'view', tabindex: '0' });
  readonly note = h('span', { class: 'note grid-note' });
  readonly extent: Extent;
  private ground: Ground | null = null;
  private readonly pen: CanvasRenderingContext2D;
  private readonly camera: PerspectiveCamera | OrthographicCamera;
  private readonly controls: OrbitControls;
  private world = new Scene();
  private carrier = new Group();                 // objects that are fixed to the observer's axes
  private key = new DirectionalLight();
  private actors: Actor[] = [];
  private triad: Triad | null = null;            // the observer's axes, in an inertial view
  private follow = '';
  private anchor: { eye: Vector; target: Vector } = { eye: [0, 0, 0], target: [0, 0, 0] };
  private half = 1;                              // half the height of an orthographic picture at zoom 1
  private requested = 0;                         // the animation frame that will draw; 0 for none
  private built = false;
  private untouched = true;                      // the reader has not turned the camera yet

  constructor(private readonly model: SceneModel, readonly frame: Frame, private readonly shown: Shown, private readonly now: () => number) {
    this.pen = this.canvas.getContext('2d')!;
    this.extent = extent(model, frame);
    this.camera = model.camera.flat ? new OrthographicCamera() : new PerspectiveCamera(fov);
    this.camera.up.set(...(model.camera.flat ? [0, 1, 0] as Vector : model.camera.up));
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.enableDamping = false;
    if (model.camera.flat) {
      this.controls.enableRotate = false;
      this.controls.mouseButtons.LEFT = this.controls.mouseButtons.RIGHT;
      this.controls.touches.ONE = 1;             // pan
    }
    this.controls.addEventListener('change', () => this.request());
    this.controls.addEventListener('start', () => { this.untouched = false; });
    this.canvas.addEventListener('keydown', (e) => this.pressed(e));
    this.canvas.addEventListener('pointerdown', () => this.canvas.focus({ preventScroll: true }));
    // The wheel scrolls the page unless this picture has the focus.
    this.canvas.addEventListener('wheel', (e) => {
      if (document.activeElement !== this.canvas && !e.ctrlKey) e.stopImmediatePropagation();
    }, { capture: true, passive: true });
  }

  // Builds the objects, for the first time or with other colours.
  build(): void {
    this.dispose();
    this.built = true;
    const t = theme(), { unit } = this.extent, { flat } = this.model.camera;
    this.world = new Scene();
    this.carrier = new Group();
    this.world.add(this.carrier, new HemisphereLight(0xffffff, t.dark ? 0x9a9ea8 : 0xd8d4cc, flat ? 2.7 : 2.5));
    this.key = new DirectionalLight(0xffffff, flat ? 0.5 : 1.1);
    this.key.castShadow = !flat && !!this.model.floor;
    this.key.shadow.mapSize.set(1024, 1024);
    this.key.shadow.radius = 3;
    // This light comes from the camera, so that no visible face is dark.
    const fill = new DirectionalLight(0xffffff, flat ? 0 : 1.2);
    this.camera.clear().add(fill, fill.target);
    fill.target.position.set(0, 0, -1);
    this.world.add(this.key, this.key.target, this.camera);
    const style = {
      theme: t, unit, pixel: this.ratio(), frame: this.frame,
      scales: vector_scales(this.model, Math.max(1.3 * unit, 0.22 * Math.min(this.extent.radius, 8 * unit))),
    };
    this.actors = make_actors(this.model, style);
    for (const a of this.actors) (a.item.kind === 'trace' ? this.world : this.carrier).add(a.object);
    this.ground = new Ground(this.model.floor ? this.model.floor.z : 0, t.ink, t.dark, this.key.castShadow);
    this.carrier.add(this.ground.group);
    this.triad = this.frame === 'inertial' && this.model.motion ? new Triad(1.1 * unit, 0.018 * unit, t.dark) : null;
    if (this.triad) this.carrier.add(this.triad.group);
  }

  get ready(): boolean { return this.built; }

  close(): void {
    this.dispose();
    this.built = false;
    this.controls.dispose();
  }

  get look(): Look | null {
    if (this.untouched) return null;
    const { target } = this.controls;
    return {
      offset: this.camera.position.clone().sub(target).toArray() as Vector,
      shift: target.clone().sub(new Vector3(...this.anchor.target)).toArray() as Vector, zoom: this.camera.zoom,
    };
  }
  set look(look: Look | null) {
    if (!look) return;
    this.reset();
    this.untouched = false;
    this.controls.target.set(...this.anchor.target).add(new Vector3(...look.shift));
    this.camera.position.copy(this.controls.target).add(new Vector3(...look.offset));
    this.camera.zoom = look.zoom;
    this.controls.update();
  }

  private ratio(): number { return Math.min(2, devicePixelRatio || 1); }

  // Adapts the canvas to its size on the page. Returns true if that drew the picture.
  resize(): boolean {
    const width = Math.round(this.canvas.clientWidth * this.ratio()), height = Math.round(this.canvas.clientHeight * this.ratio());
    if (width === 0 || height === 0 || (width === this.canvas.width && height === this.canvas.height)) return false;
    this.canvas.width = width;
    this.canvas.height = height;
    if (this.untouched) this.reset();
    this.draw();
    return this.built;
  }

  request(): void {
    if (this.requested || !this.built) return;
    this.requested = requestAnimationFrame(() => this.draw());
  }

  // Draws at once and cancels a requested drawing.
  draw(): void {
    cancelAnimationFrame(this.requested);
    this.requested = 0;
    if (!this.built || this.canvas.width === 0) return;
    const time = this.now();
    const poses = this.model.pose(time);
    const observer = this.frame === 'inertial' ? this.model.observer(time) : null;
    if (observer) {
      const [w, x, y, z] = observer.quaternion;
      this.carrier.quaternion.set(x, y, z, w);
      this.carrier.position.set(...observer.origin);
    }
    this.actors.forEach((a, k) => a.update(poses[k], time, this.shown));
    this.triad?.set([0, 0, 0], [1, 0, 0, 0, 1, 0, 0, 0, 1]);
    this.move_with(this.anchors(time));
    this.project();
    this.light();
    const look = this.carrier.worldToLocal(this.controls.target.clone());
    this.ground?.show(this.shown.grid);
    this.ground?.follow(look.x, look.y, this.span());
    const note = this.shown.grid && this.ground ? `grid ${short(this.ground.spacing)}` : '';
    if (this.note.textContent !== note) this.note.textContent = note;
    this.world.updateMatrixWorld();
    paint(this.world, this.camera, this.pen);
    if (this.shown.labels) this.labels(poses.map((p) => this.model.in_frame(this.frame, time, p.position)));
  }

  private labels(positions: Vector[]): void {
    const t = theme();
    const texts = this.model.items.flatMap((item, k) => {
      const text = item.label ?? '';
      if (!placed(item) || text === '' || !this.actors[k].object.visible || !positions[k].every(Number.isFinite)) return [];
      const at = new Vector3(...positions[k]);
      const below = item.kind === 'point';
      const lift = new Vector3().setFromMatrixColumn(this.camera.matrixWorld, 1).multiplyScalar(Math.max(radius(item) * 1.04, 0.06 * this.extent.unit));
      const on_screen = at.addScaledVector(lift, below ? -1 : item.shape === 'rod' ? 0.12 : 1).project(this.camera);
      if (on_screen.z > 1) return [];
      return [{ text, below, x: ((on_screen.x + 1) / 2) * this.canvas.width, y: ((1 - on_screen.y) / 2) * this.canvas.height }];
    });
    draw_labels(this.pen, texts, this.ratio(), t);
  }

  // Returns the points of the motion that the eye and the target of the camera follow.
  private anchors(time: number): { eye: Vector; target: Vector } {
    const zero: Vector = [0, 0, 0];
    const { eye, target } = this.model.camera;
    const in_frame = (v: Vector | null): Vector => (v && v.every(Number.isFinite) ? this.model.in_frame(this.frame, time, v) : zero);
    const item = this.followed();
    if (item) { const p = in_frame(this.model.position(item, time)); return { eye: p, target: p }; }
    return { eye: in_frame(this.model.point(eye, time)), target: in_frame(this.model.point(target, time)) };
  }

  private followed() { return this.model.items.find((i) => placed(i) && i.name === this.follow); }

  private move_with(next: { eye: Vector; target: Vector }): void {
    const before = this.anchor;
    this.anchor = next;
    const by = (a: Vector, b: Vector): Vector3 => new Vector3(...b).sub(new Vector3(...a));
    const eye = by(before.eye, next.eye), target = by(before.target, next.target);
    if (eye.lengthSq() + target.lengthSq() === 0) return;
    this.camera.position.add(eye);
    this.controls.target.add(target);
    this.camera.lookAt(this.controls.target);
  }

  set_follow(name: string): void {
    this.follow = name;
    this.anchor = this.anchors(this.now());
    if (this.untouched) { this.reset(); return; }
    if (this.followed()) {
      this.camera.position.add(new Vector3(...this.anchor.target).sub(this.controls.target));
      this.controls.target.set(...this.anchor.target);
    }
    this.controls.update();
    this.request();
  }

  // Resets the camera: to that of the model, else to the whole motion, or to the followed item and its surroundings.
  reset(): void {
    const time = this.now(), { camera } = this.model;
    this.untouched = true;
    this.anchor = this.anchors(time);
    const item = this.followed();
    const eye = this.model.point(camera.eye, time), own_target = this.model.point(camera.target, time);
    const center: Vector = item ? this.anchor.target : own_target ? this.model.in_frame(this.frame, time, own_target) : this.extent.center;
    const balls = item ? [{ at: center, r: company(this.model, item.name, this.extent.unit) }] : this.extent.points;
    const towards = camera.flat ? new Vector3(0, 0, 1) : this.first_direction();
    const offset = eye && own_target ? new Vector3(...eye).sub(new Vector3(...own_target)) : towards;
    this.controls.target.set(...center);
    this.camera.zoom = 1;
    if (this.camera instanceof OrthographicCamera) {
      this.half = this.fit_flat(balls, center);
      this.camera.position.set(...center).addScaledVector(towards, 4 * this.extent.radius);
    } else {
      const distance = eye && own_target ? 1 : this.fit(balls, center, offset);
      this.camera.position.set(...center).addScaledVector(offset, distance);
    }
    this.project();
    this.controls.update();
    this.request();
  }

  private first_direction(): Vector3 {
    const up = this.camera.up.clone().normalize();
    const side = Math.abs(up.z) > 0.9 ? new Vector3(1, 0, 0) : new Vector3(0, 0, 1);
    const right = side.clone().addScaledVector(up, -side.dot(up)).normalize();
    const back = right.clone().cross(up).normalize();
    return right.multiplyScalar(Math.cos(1.0) * 0.93).add(back.multiplyScalar(Math.sin(1.0) * 0.93)).addScaledVector(up, 0.4).normalize();
  }

  private aspect(): number { return this.canvas.width / Math.max(1, this.canvas.height); }

  private fit(balls: Extent['points'], center: Vector, towards: Vector3): number {
    const right = this.camera.up.clone().cross(towards).normalize(), up = towards.clone().cross(right);
    const ty = Math.tan((fov * Math.PI) / 360), tx = ty * this.aspect();
    let distance = 0;
    for (const { at, r } of balls) {
      const p = new Vector3(...at).sub(new Vector3(...center));
      const z = p.dot(towards), x = Math.abs(p.dot(right)) + 1.1 * r, y = Math.abs(p.dot(up)) + 1.1 * r;
      distance = Math.max(distance, z + x / tx, z + y / ty);
    }
    return 1.1 * (distance > 0 ? distance : 5 * this.extent.unit);
  }

  private fit_flat(balls: Extent['points'], center: Vector): number {
    let half = 0;
    for (const { at, r } of balls) {
      half = Math.max(half, Math.abs(at[1] - center[1]) + r, (Math.abs(at[0] - center[0]) + r) / this.aspect());
    }
    return 1.15 * (half > 0 ? half : this.extent.unit);
  }

  private project(): void {
    const { camera } = this;
    if (camera instanceof OrthographicCamera) {
      camera.top = this.half; camera.bottom = -this.half;
      camera.right = this.half * this.aspect(); camera.left = -camera.right;
      camera.near = -20 * this.extent.radius; camera.far = 20 * this.extent.radius;
    } else {
      const distance = Math.max(camera.position.distanceTo(this.controls.target), 1e-9);
      camera.aspect = this.aspect();
      camera.near = distance / 60; camera.far = 40 * distance + 4 * this.extent.radius;
    }
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
  }

  // Returns the height of the visible part of the world at the target.
  private span(): number {
    if (this.camera instanceof OrthographicCamera) return (2 * this.half) / this.camera.zoom;
    return 2 * Math.tan((fov * Math.PI) / 360) * this.camera.position.distanceTo(this.controls.target);
  }

  // Fits the shadow map to the present positions of the bodies, so that shadows are sharp.
  private light(): void {
    const bodies = this.actors.filter((a) => a.item.kind === 'body' && a.object.visible);
    const center = bodies.reduce((sum, a) => sum.add(a.object.position), new Vector3()).divideScalar(Math.max(1, bodies.length));
    const { unit } = this.extent;
    const reach = Math.min(12 * unit, Math.max(...bodies.map((a) => a.object.position.distanceTo(center) + radius(a.item)), unit) * 1.6);
    this.carrier.updateMatrixWorld();
    const up = this.camera.up;
    this.key.target.position.copy(this.carrier.localToWorld(center));
    this.key.position.copy(this.key.target.position).addScaledVector(up, 6 * reach).add(new Vector3(-0.33, -0.42, 0).multiplyScalar(6 * reach));
    Object.assign(this.key.shadow.camera, { left: -reach, right: reach, top: reach, bottom: -reach, near: reach, far: 14 * reach });
    this.key.shadow.camera.updateProjectionMatrix();
    this.key.shadow.normalBias = 0.01 * unit;
  }

  // Arrow keys turn the camera; in flat views, and with the shift key, they shift it. + and - zoom, 0 resets.
  private pressed(e: KeyboardEvent): void {
    if (e.ctrlKey || e.metaKey || e.altKey) return;
    const step: Record<string, [number, number]> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    if (step[e.key]) {
      if (e.shiftKey || this.model.camera.flat) this.shift(...step[e.key]); else this.turn(...step[e.key]);
    } else if (e.key === '+' || e.key === '=') this.zoom(1.15);
    else if (e.key === '-') this.zoom(1 / 1.15);
    else if (e.key === '0' || e.key === 'Home') { this.reset(); return; }
    else return;
    e.preventDefault();
    this.untouched = false;
    this.controls.update();
    this.request();
  }

  private turn(x: number, y: number): void {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const up = this.camera.up.clone().normalize();
    const polar = offset.angleTo(up), wanted = Math.min(Math.PI - 0.02, Math.max(0.02, polar - 0.08 * y));
    offset.applyAxisAngle(up.clone().cross(offset).normalize(), wanted - polar).applyAxisAngle(up, 0.1 * x);
    this.camera.position.copy(this.controls.target).add(offset);
  }

  private shift(x: number, y: number): void {
    const by = new Vector3().setFromMatrixColumn(this.camera.matrixWorld, 0).multiplyScalar(0.05 * x * this.span())
      .addScaledVector(new Vector3().setFromMatrixColumn(this.camera.matrixWorld, 1), 0.05 * y * this.span());
    this.camera.position.add(by);
    this.controls.target.add(by);
  }

  private zoom(factor: number): void {
    if (this.camera instanceof OrthographicCamera) this.camera.zoom *= factor;
    else this.camera.position.sub(this.controls.target).divideScalar(factor).add(this.controls.target);
  }

  private dispose(): void {
    this.world.traverse((o: Object3D) => {
      const mesh = o as Mesh;
      mesh.geometry?.dispose();
      for (const m of [mesh.material ?? []].flat()) m.dispose();
    });
    this.key.dispose();
  }
}
