// What the studio shows of a text: sections of a report, the player and the plots. A new motion takes the place of the one before
// at the same time of the motion, with the camera where the reader has put it.

import { Clock } from '../clock.ts';
import { add_copy_buttons } from '../copy.ts';
import { read_report, type RawReport } from '../data.ts';
import { h } from '../dom.ts';
import { Player } from '../player.ts';
import { Plots } from '../plots.ts';
import { SceneModel } from '../scene.ts';
import type { Motion, Section } from './engine.ts';

const order = ['motion', 'system', 'equations', 'structure', 'proof', 'report'];

export class Preview {
  private clock = new Clock(0, 0);
  private player: Player | null = null;
  private plots: Plots | null = null;
  private picture = '';
  readonly note = h('div', { class: 'stale', role: 'status', hidden: true });
  private readonly main = h('main', { 'aria-label': 'The motion and its equations', tabindex: '0' });

  constructor(place: HTMLElement) { place.append(this.note, this.main); }

  get time(): number { return this.clock.time; }

  // Puts each section in its place; one that is equal stays as it is, so that the reader's place and selection stay.
  sections(list: Section[]): void {
    for (const s of list) {
      const old = this.main.querySelector<HTMLElement>(`#${s.id}`);
      if (old?.dataset.html === s.html) continue;
      const element = h('section', { id: s.id });
      element.innerHTML = s.html;            // of the program, which escapes all text of the model
      element.prepend(h('h2', {}, s.title));
      element.dataset.html = s.html;
      if (old) old.replaceWith(element);
      else {
        const next = order.slice(order.indexOf(s.id) + 1).map((id) => this.main.querySelector(`#${id}`)).find((e) => e);
        this.main.insertBefore(element, next ?? null);
      }
    }
    add_copy_buttons();
  }

  remove(ids: string[]): void { for (const id of ids) this.main.querySelector(`#${id}`)?.remove(); }

  show(motion: Motion): void {
    this.stale('');
    const picture = motion.data;
    const old = this.main.querySelector('#motion');
    if (picture !== this.picture || !old) {
      const look = this.player?.look ?? null, { time, playing } = this.clock;
      const before = this.player;
      this.plots?.close();
      this.clock.pause();
      this.player = this.plots = null;
      old?.remove();
      this.sections(motion.sections);
      this.picture = picture;
      this.mount(JSON.parse(picture) as RawReport, time, playing, look);
      before?.close();          // after the new one is drawn, which can use its shaders
    } else this.sections(motion.sections.filter((s) => s.id !== 'motion'));
  }

  private mount(raw: RawReport, time: number, playing: boolean, look: Player['look']): void {
    const place = (kind: string): HTMLElement => this.main.querySelector<HTMLElement>(`.${kind}`)!;
    const said = (where: HTMLElement, e: unknown): void => { where.replaceChildren(h('p', { class: 'sorry' }, `It cannot be shown: ${(e as Error).message}`)); };
    try {
      const [data] = read_report(raw).cases;
      this.clock = new Clock(data.start, data.end);
      if (data.scene) {
        this.player = new Player(place('player'), data, new SceneModel(data, data.scene), this.clock);
        if (look) this.player.look = look;
      } else place('player').remove();
      this.plots = new Plots(place('plots'), data, this.clock);
      this.clock.seek(time);
      if (playing) this.clock.play();
      this.player?.wake();
    } catch (e) { said(place('plots'), e); }
  }

  // Says why what is shown is that of an earlier text; an empty text takes it away.
  stale(why: string, hint = ''): void {
    this.note.hidden = why === '';
    this.note.replaceChildren(...(why === '' ? [] : [h('strong', {}, 'Shown is an earlier text. '), why, hint ? h('span', { class: 'hint' }, ` ${hint}`) : '']));
    this.main.classList.toggle('old', why !== '');
  }
}
