// The player of one case: its pictures, the bars below them, and keys.

import type { Shown } from './actors.ts';
import type { Clock } from './clock.ts';
import { choice, icon_button, play_bar, show_bar } from './controls.ts';
import type { Case } from './data.ts';
import { h } from './dom.ts';
import { placed } from './extent.ts';
import { fixed, time_decimals, with_unit } from './format.ts';
import { gl, on_restored } from './gl.ts';
import type { Frame, SceneModel } from './scene.ts';
import { css_rgb, on_theme, theme } from './theme.ts';
import { View, type Look } from './view.ts';

export class Player {
  readonly views = h('div', { class: 'views' });
  private readonly shown: Shown;
  private readonly made = new Map<Frame, View>();
  private active: View[] = [];
  private follow = '';
  private visible = false;
  private missed = true;         // a change is not drawn yet
  private readonly ends: (() => void)[] = [];     // functions that close() calls

  constructor(readonly place: HTMLElement, private readonly data: Case, readonly model: SceneModel, private readonly clock: Clock) {
    const kinds = new Set(model.items.map((i) => i.kind));
    this.shown = {
      traces: !data.rough, frames: model.items.filter((i) => i.kind === 'frame').length <= 2, vectors: new Set(), scale: 1,
      labels: model.items.filter((i) => placed(i) && i.label).length <= 8, grid: model.floor !== false,
    };
    const offered = {
      traces: kinds.has('trace') && !data.rough, frames: kinds.has('frame'), labels: model.items.some((i) => placed(i) && i.label),
      vectors: [...new Set(model.items.filter((i) => i.kind === 'vector').map((i) => i.what ?? 'vectors'))],
    };
    place.replaceChildren();
    place.classList.add('live');
    if (!gl()) {
      place.append(h('p', { class: 'sorry' }, 'This browser shows no WebGL, which the picture of the motion needs. The time below still moves the plots.'),
        play_bar(clock, data.unit));
      return;
    }
    const stage = h('div', { class: 'picture' }, this.views, this.tools());
    place.append(stage, play_bar(clock, data.unit),
      h('div', { class: 'second-bar' }, show_bar(this.shown, offered, () => this.redraw()), this.looking()));
    place.addEventListener('keydown', (e) => this.pressed(e));
    this.set_frames(['observer']);
    this.set_follow(this.first_follow());
    clock.listen(() => this.redraw());
    this.ends.push(on_theme(() => { for (const v of this.made.values()) if (v.ready) { v.build(); v.draw(); } }), on_restored(() => this.redraw()));
    // The theme changes before this listener runs. Pictures that were never visible are drawn for the paper.
    const waking = (): void => this.wake();
    addEventListener('beforeprint', waking);
    const sized = new ResizeObserver(() => { if (this.visible) for (const v of this.active) v.resize(); });
    sized.observe(this.views);
    const seen = new IntersectionObserver((entries) => {
      this.visible = entries[entries.length - 1].isIntersecting;
      if (this.visible) this.wake();
    }, { rootMargin: '200px' });
    seen.observe(place);
    this.ends.push(() => removeEventListener('beforeprint', waking), () => sized.disconnect(), () => seen.disconnect());
  }

  // Frees the listeners of the page and the memory of the graphics card, so that the place can get another player.
  close(): void {
    for (const end of this.ends) end();
    for (const v of this.made.values()) v.close();
    this.visible = false;
  }

  // The camera of the observer's view as the reader has moved it; null if it was not moved.
  get look(): Look | null { return this.made.get('observer')?.look ?? null; }
  set look(look: Look | null) { if (look) this.view('observer').look = look; }

  // Builds views when they are first visible, since a page may have many cases, and draws those that have changed.
  wake(): void {
    for (const v of this.active) {
      const due = this.missed || !v.ready;
      if (!v.ready) v.build();
      if (!v.resize() && due) v.draw();
    }
    this.missed = false;
  }

  // Draws at once, so that a screenshot right after the call is up to date.
  draw_now(): void { for (const v of this.active) v.draw(); }

  private redraw(): void {
    if (!this.visible) { this.missed = true; return; }
    for (const v of this.active) v.request();
  }

  private view(frame: Frame): View {
    let view = this.made.get(frame);
    if (!view) {
      view = new View(this.model, frame, this.shown, () => this.clock.time);
      view.canvas.setAttribute('role', 'application');
      view.canvas.setAttribute('aria-label', `Picture of the motion${this.model.motion ? `, ${frame} frame` : ''}. `
        + `Arrow keys ${this.model.camera.flat ? 'shift' : 'turn'} it, plus and minus zoom, 0 resets, space plays.`);
      view.set_follow(this.follow);
      this.made.set(frame, view);
    }
    return view;
  }

  set_frames(frames: Frame[]): void {
    this.active = frames.map((f) => this.view(f));
    this.views.dataset.count = String(frames.length);
    this.views.replaceChildren(...this.active.map((v) => h('div', { class: 'view-box' }, v.canvas, v.note,
      this.model.motion ? h('span', { class: 'note frame-note' }, v.frame === 'observer' ? 'moving observer' : 'inertial frame') : null)));
    this.missed = true;          // a view that is not shown misses changes
    if (this.visible) this.wake();
  }

  // Returns the item to follow first: that of the model, else the first one if the motion goes so far that bodies would be tiny.
  private first_follow(): string {
    const { follow, eye } = this.model.camera;
    if (follow && this.followable().some(([name]) => name === follow)) return follow;
    return eye === null && this.view('observer').extent.far ? this.followable()[0]?.[0] ?? '' : '';
  }

  private followable(): [string, string][] {
    return this.model.items.filter((i) => placed(i) && i.kind !== 'frame').map((i) => [i.name, (i.label || i.name).slice(0, 40)]);
  }

  private set_follow(name: string): void {
    this.follow = name;
    for (const v of this.made.values()) v.set_follow(name);
  }

  private tools(): HTMLElement {
    const full = icon_button('full', 'Full screen', () => {
      if (document.fullscreenElement) void document.exitFullscreen();
      else void this.place.requestFullscreen?.();
    });
    return h('div', { class: 'view-tools' },
      icon_button('reset', 'Reset the view (0)', () => { for (const v of this.active) v.reset(); }),
      icon_button('image', 'Save the picture (PNG)', () => this.save()),
      document.fullscreenEnabled ? full : null);
  }

  private looking(): HTMLElement {
    const bar = h('div', { class: 'look-bar' },
      choice('Follow', [['', 'nothing'], ...this.followable()], this.first_follow(), (v) => this.set_follow(v)));
    if (this.model.motion) {
      bar.append(choice('Seen by', [['observer', 'the moving observer'], ['inertial', 'an inertial frame'], ['both', 'both, side by side']], 'observer',
        (v) => this.set_frames(v === 'both' ? ['observer', 'inertial'] : [v as Frame])));
    }
    return bar;
  }

  private pressed(e: KeyboardEvent): void {
    const target = e.target as HTMLElement;
    if (e.key !== ' ' || target.closest('button, select, input')) return;
    this.clock.toggle();
    e.preventDefault();
  }

  private save(): void {
    this.draw_now();
    const pictures = this.active.map((v) => v.canvas);
    const all = h('canvas');
    all.width = pictures.reduce((sum, c) => sum + c.width, 0);
    all.height = Math.max(...pictures.map((c) => c.height));
    const pen = all.getContext('2d');
    if (!pen) return;
    pen.fillStyle = css_rgb(theme().panel);
    pen.fillRect(0, 0, all.width, all.height);
    let x = 0;
    for (const c of pictures) { pen.drawImage(c, x, 0); x += c.width; }
    const time = fixed(this.clock.time, time_decimals(this.clock.end - this.clock.start));
    pen.fillStyle = css_rgb(theme().quiet);
    pen.font = `${0.022 * all.height + 8}px system-ui, sans-serif`;
    pen.fillText(`t = ${with_unit(time, this.data.unit)}`, 0.02 * all.width, 0.97 * all.height);
    all.toBlob((blob) => {
      if (!blob) return;
      const address = URL.createObjectURL(blob);
      h('a', { href: address, download: `${this.data.name.replace(/[^\w-]+/g, '_') || 'motion'}-t${time}.png` }).click();
      setTimeout(() => URL.revokeObjectURL(address), 10000);
    }, 'image/png');
  }
}
