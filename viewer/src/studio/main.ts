// The studio: a model in an editor, and beside it the results of the program, renewed after each change.

import '../viewer.css';
import './studio.css';
import { h } from '../dom.ts';
import { theme_switch, watch_theme } from '../theme.ts';
import { Editor } from './editor.ts';
import { CaseChoice } from './case_choice.ts';
import { failed, replaced, type Answer, type Engine, type Problem, type Store } from './engine.ts';
import { http_engine } from './http_engine.ts';
import { Preview } from './preview.ts';
import { SweepStudio } from './sweep.ts';

const pause = 40;      // ms without a key press before the text is computed

class Studio {
  private edition = 1;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private saved = '';
  private readonly status = h('span', { class: 'status', role: 'status' });
  private readonly problems = h('ul', { class: 'problems', 'aria-label': 'Messages' });
  private readonly save_button = h('button', { type: 'button', click: () => void this.save(false) }, 'Save');
  private readonly file = h('span', { class: 'file' });
  private readonly cases = new CaseChoice(() => this.changed());
  private readonly preview: Preview;
  private editor!: Editor;

  constructor(private readonly engine: Engine, private readonly store: Store) {
    const tools = h('div', { class: 'tools' });
    const editing = h('div', { class: 'editing' }), shown = h('div', { class: 'shown' });
    document.body.classList.add('studio');
    document.body.append(
      h('header', { class: 'studio-bar' }, h('h1', {}, 'Anholon studio'), this.file, this.cases.element, this.save_button, this.status, tools),
      h('div', { class: 'columns' }, h('div', { class: 'left', role: 'region', 'aria-label': 'Model' }, editing, this.problems), shown));
    watch_theme();
    theme_switch(tools);
    this.preview = new Preview(shown);
    void this.open(editing);
  }

  private async open(place: HTMLElement): Promise<void> {
    try {
      const opened = await this.store.open();
      this.saved = opened.text;
      this.file.textContent = opened.name;
      document.title = `${opened.name} – Anholon studio`;
      if (opened.no_saving) {
        this.save_button.disabled = true;
        this.save_button.title = opened.no_saving;
        this.file.title = opened.no_saving;
        this.file.append(' (not saved)');
      }
      this.editor = new Editor(place, opened.text, () => this.changed(), () => void this.save(false));
      this.mark();
      void this.compute();
      this.editor.language = await this.store.language();
      addEventListener('beforeunload', (e) => { if (!opened.no_saving && this.editor.text !== this.saved) e.preventDefault(); });
    } catch (e) { this.say(`The model cannot be opened: ${(e as Error).message}`); }
  }

  private say(text: string): void { this.status.textContent = text; }
  private mark(): void { this.save_button.classList.toggle('due', this.editor.text !== this.saved); }

  private changed(): void {
    this.mark();
    ++this.edition;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => void this.compute(), pause);
  }

  // Computes the motion first, since the reader waits for it, then the equations, then the proof.
  private async compute(): Promise<void> {
    const { edition } = this, of = { text: this.editor.text, case_name: this.cases.chosen }, began = performance.now();
    const old = (a: unknown): boolean => edition !== this.edition || replaced(a as Answer<object>);
    this.say('computing …');
    void this.engine.check(of, edition).then((a) => {
      if (old(a)) return;
      if (failed(a)) return this.list(a.error.diagnostics, a.error.text);
      if (!replaced(a)) {
        if (a.moves) this.cases.offer(a.cases);
        if (a.names.length > 0) this.editor.names = a.names;
        this.list(a.diagnostics, '');
      }
    });
    const motion = await this.engine.simulate(of, edition);
    if (old(motion) || replaced(motion)) return;
    if (failed(motion)) {
      this.preview.stale(motion.error.text, motion.error.hint);
      this.say('no motion');
    } else {
      this.preview.show(motion);
      this.say(`motion in ${((performance.now() - began) / 1000).toFixed(2)} s`);
    }
    document.documentElement.dataset.shown = String(edition);
    const equations = await this.engine.derive(of, edition);
    if (old(equations) || replaced(equations)) return;
    if (!failed(equations)) this.preview.sections(equations.sections);
    if (failed(motion)) return;
    const proof = await this.engine.prove(of, edition);
    if (old(proof) || replaced(proof)) return;
    if (failed(proof)) this.preview.remove(['proof']); else this.preview.sections(proof.sections);
    document.documentElement.dataset.done = String(edition);
  }

  private list(problems: Problem[], text: string): void {
    this.editor.show(problems);
    this.problems.replaceChildren(...problems.map((p) => h('li', { class: p.severity },
      h('button', { type: 'button', class: 'plain', click: () => this.editor.go_to(p) }, p.line > 0 ? `${p.file || 'line'} ${p.line}` : p.file || 'the text'), ` ${p.severity}: ${p.message}`,
      p.hint ? h('span', { class: 'hint' }, ` hint: ${p.hint}`) : null)));
    if (text !== '' && problems.length === 0) this.problems.replaceChildren(h('li', { class: 'error' }, text));
  }

  private async save(anyway: boolean): Promise<void> {
    if (this.save_button.disabled) return;
    const { text } = this.editor;
    const result = await this.store.save(text, anyway);
    if (result === 'saved') {
      this.saved = text;
      this.mark();
      this.say('saved');
    } else if (result.changed) {
      this.say(`not saved: ${result.why} `);
      this.status.append(h('button', { type: 'button', class: 'plain', click: () => void this.save(true) }, 'Save over it'));
    } else this.say(`not saved: ${result.why}`);
  }
}

if (document.body.dataset.opens === 'sweep') new SweepStudio(http_engine, http_engine);
else new Studio(http_engine, http_engine);
