// The bar below the pictures: playing, time, and the choice of the items that are shown.

import type { Shown } from './actors.ts';
import type { Clock } from './clock.ts';
import { h, icon, set_icon, type Icon } from './dom.ts';
import { exact, fixed, short, time_decimals, with_unit } from './format.ts';

export function icon_button(name: Icon, label: string, click: () => void): HTMLButtonElement {
  return h('button', { type: 'button', class: 'icon-button', title: label, 'aria-label': label, click }, icon(name));
}

export function check(label: string, on: boolean, changed: (on: boolean) => void): HTMLElement {
  const input = h('input', { type: 'checkbox', checked: on, change: () => changed(input.checked) });
  return h('label', { class: 'check' }, input, h('span', {}, label));
}

export function choice(label: string, options: [string, string][], value: string, changed: (value: string) => void): HTMLElement {
  const select = h('select', { change: () => changed(select.value) }, ...options.map(([v, text]) => h('option', { value: v }, text)));
  select.value = value;
  return h('label', { class: 'select' }, h('span', {}, label), select);
}

export function play_bar(clock: Clock, unit: string): HTMLElement {
  const decimals = time_decimals(clock.end - clock.start);
  const written = (t: number): string => with_unit(fixed(t, decimals), unit);
  const play = h('button', { type: 'button', class: 'play', click: () => clock.toggle() }, icon('play'));
  const slider = h('input', {
    type: 'range', class: 'scrub', min: String(clock.start), max: String(clock.end), step: 'any', 'aria-label': 'Time',
    input: () => clock.seek(Number(slider.value)),
    keydown: (e) => step(e as KeyboardEvent),
  });
  const now = h('output', { class: 'now' });
  const said = h('span', { class: 'unseen', 'aria-live': 'polite' });
  const loop = icon_button('loop', 'Start over at the end', () => { clock.loop = !clock.loop; clock.changed(); });

  // The arrow keys would move a range of step "any" by 1, whatever the length of the run.
  const step = (e: KeyboardEvent): void => {
    const duration = clock.end - clock.start;
    const by: Record<string, number> = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -20, PageUp: 20 };
    if (e.key === ' ') clock.toggle();
    else if (e.key in by) clock.seek(clock.time + (by[e.key] * duration) / 200);
    else return;
    e.preventDefault();
  };

  // For screen readers: says the time at most once in two seconds, and always when the time stops.
  let timer = 0;
  const say = (): void => {
    if (timer !== 0) return;
    timer = window.setTimeout(() => { timer = 0; said.textContent = `t = ${written(clock.time)}`; }, 2000);
  };

  const update = (): void => {
    slider.value = String(clock.time);
    slider.style.setProperty('--part', String((clock.time - clock.start) / (clock.end - clock.start || 1)));
    slider.setAttribute('aria-valuetext', written(clock.time));
    now.textContent = written(clock.time);
    now.title = `t = ${exact(clock.time)}`;
    play.setAttribute('aria-label', clock.playing ? 'Pause' : 'Play');
    play.title = clock.playing ? 'Pause (space)' : 'Play (space)';
    if (play.dataset.playing !== String(clock.playing)) set_icon(play, clock.playing ? 'pause' : 'play');
    play.dataset.playing = String(clock.playing);
    loop.setAttribute('aria-pressed', String(clock.loop));
    say();
  };
  clock.listen(update);
  update();
  now.style.minWidth = `${written(clock.end).length + 0.5}ch`;
  const of = h('span', { class: 'of' }, `/ ${written(clock.end)}`);
  return h('div', { class: 'play-bar' }, play, slider, h('span', { class: 'time' }, now, of), speed(clock, unit), loop, said);
}

// Returns factors of the first speed, with the speeds relative to real time as texts: 1× is real time for every run.
export function speed_options(rate: number, unit: string): [string, string][] {
  const factors = [0.1, 0.2, 0.5, 1, 2, 5, 10];
  if (!factors.some((f) => Math.abs(f * rate - 1) < 1e-12)) factors.push(1 / rate);
  const text = (r: number): string => (unit === 's' ? `${short(r)}\u00d7` : `${short(r)} per s`);
  return factors.sort((a, b) => a - b).map((f) => [String(f), text(f * rate)]);
}

function speed(clock: Clock, unit: string): HTMLElement {
  const label = choice('Speed', speed_options(clock.rate, unit), '1', (v) => { clock.speed = Number(v); clock.changed(); });
  const describe = (): void => {
    const rate = clock.rate * clock.speed;
    label.title = rate === 1 && unit === 's' ? 'Real time' : `${with_unit(short(rate), unit)} of the motion in each second`;
  };
  clock.listen(describe);
  describe();
  return label;
}

export interface Offered { traces: boolean; frames: boolean; labels: boolean; vectors: string[] }

const plural: Record<string, string> = { velocity: 'Velocities', reaction: 'Reactions', force: 'Forces' };

export function show_bar(shown: Shown, offered: Offered, changed: () => void): HTMLElement {
  const toggle = (label: string, key: 'traces' | 'frames' | 'labels' | 'grid'): HTMLElement =>
    check(label, shown[key], (on) => { shown[key] = on; changed(); });
  const scale = h('input', {
    type: 'range', min: '-1', max: '1', step: '0.01', value: '0', 'aria-label': 'Length of the arrows',
    input: () => { shown.scale = 10 ** Number(scale.value); changed(); },
  });
  const length = h('label', { class: 'length', hidden: true }, h('span', {}, 'Arrows'), scale);
  const arrows = offered.vectors.map((what) => check(plural[what] ?? what, shown.vectors.has(what), (on) => {
    if (on) shown.vectors.add(what); else shown.vectors.delete(what);
    length.hidden = shown.vectors.size === 0;
    changed();
  }));
  return h('div', { class: 'show-bar', role: 'group', 'aria-label': 'Shown' },
    offered.traces ? toggle('Paths', 'traces') : null, offered.frames ? toggle('Axes', 'frames') : null,
    ...arrows, offered.vectors.length > 0 ? length : null,
    offered.labels ? toggle('Names', 'labels') : null, toggle('Grid', 'grid'));
}
