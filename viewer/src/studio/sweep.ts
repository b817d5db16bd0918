// The studio of a sweep: the map of its cases, and beside it the motion of the chosen case.

import { h } from '../dom.ts';
import { theme_switch, watch_theme } from '../theme.ts';
import { failed, replaced, type Engine, type Store, type SweepMap } from './engine.ts';
import { Preview } from './preview.ts';

interface MapHost { invitation: string; picked(number: number, row: number): void; unknown?(number: number): void }
// The function of map.js, which the page loads first.
declare function anholon_map(root: HTMLElement, data: SweepMap, host: MapHost): { pick(row: number): void };

export class SweepStudio {
  private edition = 1;
  private shown = -1;          // the case whose motion is shown
  private readonly status = h('span', { class: 'status', role: 'status' });
  private readonly place = h('div', { class: 'left sweep', role: 'region', 'aria-label': 'Cases', tabindex: '0' });
  private readonly preview: Preview;

  constructor(private readonly engine: Engine, private readonly store: Store) {
    const tools = h('div', { class: 'tools' }), shown = h('div', { class: 'shown' });
    document.body.classList.add('studio');
    document.body.append(
      h('header', { class: 'studio-bar' }, h('h1', {}, 'Anholon studio'), this.status, tools),
      h('div', { class: 'columns' }, this.place, shown));
    watch_theme();
    theme_switch(tools);
    this.preview = new Preview(shown, 'The motion of a case');
    void this.open();
  }

  private say(text: string): void { this.status.textContent = text; }

  private async open(): Promise<void> {
    try {
      const map = await this.store.sweep();
      if (failed(map)) {
        this.say('the sweep cannot be shown');
        this.place.append(h('p', { class: 'sorry', role: 'alert' }, map.error.text, map.error.hint ? h('span', { class: 'hint' }, ` hint: ${map.error.hint}`) : null));
      } else this.begin(map);
    } catch (e) { this.say(`The sweep cannot be opened: ${(e as Error).message}`); }
    document.documentElement.dataset.done = '1';
  }

  private begin(map: SweepMap): void {
    document.title = `${map.title} – Anholon studio`;
    this.place.append(h('h2', { dir: 'auto' }, map.title));
    if (map.parts < map.all_parts)
      this.place.append(h('p', { class: 'note growing' }, `${map.parts} of ${map.all_parts} parts are there. Reload the page to see more.`));
    if (map.other_program)
      this.place.append(h('p', { class: 'note' }, `The folder was made by ${map.program}; the motions are computed by ${map.other_program}, and their last digits may differ.`));
    const root = h('div');
    this.place.append(root);
    anholon_map(root, map, {
      invitation: 'A click on a cell shows the motion of its case.',
      picked: (number) => void this.show(number), unknown: (number) => void this.show(number),
    });
    this.say('');
  }

  private async show(number: number): Promise<void> {
    const edition = ++this.edition, began = performance.now();
    this.say(`computing case ${number} …`);
    const motion = await this.engine.motion_of_case(number, edition);
    if (edition !== this.edition || replaced(motion)) return;
    if (failed(motion)) {
      this.preview.stale(`Case ${number}: ${motion.error.text}`, motion.error.hint, this.shown < 0 ? 'There is no motion.' : `Shown is case ${this.shown}.`);
      this.say(`no motion of case ${number}`);
    } else {
      this.preview.show(motion);
      this.shown = number;
      this.say(`motion of case ${number} in ${((performance.now() - began) / 1000).toFixed(2)} s`);
    }
    document.documentElement.dataset.shown = String(number);
  }
}
