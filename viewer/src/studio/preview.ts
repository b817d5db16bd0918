// The results that the studio shows: sections of a report, the player and the plots. A new motion replaces the last one; the time
// and the camera are kept.

import { add_copy_buttons } from '../copy.ts';
import type { RawReport } from '../data.ts';
import { h } from '../dom.ts';
import { MotionView } from '../motion_view.ts';
import type { Motion, Section } from './engine.ts';

const order = ['motion', 'system', 'equations', 'structure', 'proof', 'report'];

export class Preview {
  private readonly view = new MotionView();
  private picture = '';
  readonly note = h('div', { class: 'stale', role: 'status', hidden: true });
  private readonly main: HTMLElement;

  constructor(place: HTMLElement, label = 'The motion and its equations') {
    this.main = h('main', { 'aria-label': label, tabindex: '0' });
    place.append(this.note, this.main);
  }

  // Inserts the sections. Equal sections are not replaced, so that the reader's scroll position and selection stay.
  sections(list: Section[]): void {
    for (const s of list) {
      const old = this.main.querySelector<HTMLElement>(`#${s.id}`);
      if (old?.dataset.html === s.html) continue;
      const element = h('section', { id: s.id });
      element.innerHTML = s.html;            // markup by the program, which escapes all text of the model
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
    if (picture === this.picture && old) return this.sections(motion.sections.filter((s) => s.id !== 'motion'));
    this.picture = picture;
    this.view.show(JSON.parse(picture) as RawReport, () => {
      old?.remove();
      this.sections(motion.sections);
      const place = (kind: string): HTMLElement => this.main.querySelector<HTMLElement>(`.${kind}`)!;
      return { player: place('player'), plots: place('plots') };
    });
  }

  // Shows why the results are not those of the current text; an empty text removes the message.
  stale(why: string, hint = '', shown = 'Shown is an earlier text.'): void {
    this.note.hidden = why === '';
    this.note.replaceChildren(...(why === '' ? [] : [h('strong', {}, `${shown} `), why, hint ? h('span', { class: 'hint' }, ` hint: ${hint}`) : '']));
    this.main.classList.toggle('old', why !== '');
  }
}
