// The viewer as a module for anywidget: the picture and the plots of a motion in a notebook. The model of the widget has
//   data      the JSON of CONTRACT.md, a text
//   plots     whether plots are shown below the picture
//   time      the time that is shown
//   playing   whether the motion plays; Python sets time and playing

import css from './viewer.css?inline';
import { case_handle, type CaseHandle } from './api.ts';
import { Clock } from './clock.ts';
import { read_report } from './data.ts';
import { h } from './dom.ts';
import { Player } from './player.ts';
import { Plots } from './plots.ts';
import { SceneModel } from './scene.ts';
import { rgb, take_colours_from } from './theme.ts';

interface Model {
  get(name: string): unknown;
  on(event: string, f: () => void): void;
  off(event: string, f: () => void): void;
}

// The colours of report pages, src/report/page.css.
const light = `--paper:#fdfdfb;--ink:#1c2126;--quiet:#5d6670;--line:#dcdfe3;--accent:#1f5fa8;--warn:#9a5b00;--panel:#f4f5f3;
--c0:#1f5fa8;--c1:#c2491d;--c2:#2f7d4f;--c3:#7a4fa3;--c4:#a07400;--c5:#1b8a94;--c6:#b03060;--c7:#5b6670`;
const dark = `--paper:#14171b;--ink:#e4e7ea;--quiet:#98a2ad;--line:#323941;--accent:#7db4f2;--warn:#e3ab57;--panel:#1c2127;
--c0:#7db4f2;--c1:#f0956c;--c2:#7fcb9b;--c3:#c3a1e6;--c4:#dfbc55;--c5:#6ccfd8;--c6:#ee8fb0;--c7:#a9b3bd`;
const style = `:host{display:block;${light}}:host([data-dark]){${dark}}.plots{margin-top:1rem}${css}`;

// Notebooks mark dark themes in different ways, but all of them have a background, whose colour is tested.
function on_dark(element: Element): boolean {
  for (let e: Element | null = element; e; e = e.parentElement ?? ((e.getRootNode() as ShadowRoot).host ?? null)) {
    const painted = getComputedStyle(e).backgroundColor;
    if (!/^rgba\(.*, 0\)$|^transparent$/.test(painted)) return rgb(painted).reduce((sum, x) => sum + x, 0) < 384;
  }
  return false;
}

// Adds the font to the document, since a style sheet within a shadow tree cannot define one.
function bring_font(): void {
  const font = css.match(/@font-face\s*\{[^}]*\}/)?.[0];
  if (font && !document.querySelector('style[data-anholon-font]')) document.head.append(h('style', { 'data-anholon-font': true }, font));
}

export function render({ model, el }: { model: Model; el: HTMLElement }): () => void {
  const host = h('div', { class: 'anholon-widget' });
  const root = host.attachShadow({ mode: 'open' });
  el.append(host);
  bring_font();
  root.append(h('style', {}, style));
  host.toggleAttribute('data-dark', on_dark(el));
  take_colours_from(host);

  let clock = new Clock(0, 0);
  let handle: CaseHandle | null = null;
  try {
    const [data] = read_report(JSON.parse(model.get('data') as string)).cases;
    clock = new Clock(data.start, data.end);
    let player: Player | null = null;
    if (data.caution) root.append(h('p', { class: 'sorry' }, `${data.caution}.`));
    const scene = data.scene ? new SceneModel(data, data.scene) : null;
    if (scene) {
      const place = h('div', { class: 'player' });
      root.append(place);
      player = new Player(place, data, scene, clock);
    }
    if (model.get('plots') || !scene) {
      const place = h('div', { class: 'plots' });
      root.append(place);
      new Plots(place, data, clock);
    }
    handle = case_handle(data.name, clock, scene, () => player);
  } catch (e) {
    root.append(h('p', { class: 'sorry' }, `The motion cannot be shown: ${(e as Error).message}`));
  }
  const seek = (): void => handle?.seek(model.get('time') as number);
  const play = (): void => { if (model.get('playing')) clock.play(); else clock.pause(); };
  model.on('change:time', seek);
  model.on('change:playing', play);
  if (model.get('time')) seek();
  if (model.get('playing')) play();
  return () => {
    model.off('change:time', seek);
    model.off('change:playing', play);
    clock.pause();
    host.remove();
  };
}

export default { render };
