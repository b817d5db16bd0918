// Finds the elements of the page that are meant for the viewer, and fills them.

import './viewer.css';
import { case_handle, stage, type Handle } from './api.ts';
import { Clock } from './clock.ts';
import { add_copy_buttons } from './copy.ts';
import { read_case, type Case, type RawReport } from './data.ts';
import { h } from './dom.ts';
import { MotionView } from './motion_view.ts';
import { Player } from './player.ts';
import { Plots } from './plots.ts';
import { SceneModel } from './scene.ts';
import { theme_switch, watch_theme } from './theme.ts';

declare global { interface Window { anholon: Handle } }

function raw_report(errors: string[]): RawReport | null {
  const text = document.getElementById('anholon-data')?.textContent;
  if (!text) return null;
  try {
    const raw = JSON.parse(text) as RawReport;
    if (raw.format !== 1) throw new Error(`the data have format ${raw.format}; this viewer reads format 1`);
    return raw;
  } catch (e) { errors.push(`The data of this page cannot be read: ${(e as Error).message}`); return null; }
}

// Runs `f`. An error is shown at `place`, and the rest of the page works; the result is then null.
function attempt<T>(errors: string[], place: HTMLElement | null, what: string, f: () => T): T | null {
  try { return f(); } catch (e) {
    const text = `${what}: ${(e as Error).message}`;
    errors.push(text);
    console.warn(text);
    place?.append(h('p', { class: 'sorry' }, text));
    return null;
  }
}

function mount(): Handle {
  const errors: string[] = [];
  watch_theme();
  const tools = document.querySelector('header.page .tools') ?? document.querySelector('.tools');
  if (tools) theme_switch(tools);
  add_copy_buttons();
  const view = new MotionView();
  const handle: Handle = {
    cases: [], plots: [], errors, ready: Promise.resolve(), show: (data, at) => view.show(data, at), stage: () => undefined,
  };
  const players: (Player | null)[] = [];
  const places = (kind: string, k: number): HTMLElement[] => [...document.querySelectorAll<HTMLElement>(`.${kind}[data-case="${k}"]`)];
  (raw_report(errors)?.cases ?? []).forEach((raw, k) => {
    const [player_place = null] = places('player', k), [plots_place = null] = places('plots', k);
    const data = attempt(errors, plots_place ?? player_place, 'The data of this case are damaged', (): Case => read_case(raw));
    const clock = new Clock(data?.start ?? 0, data?.end ?? 0);
    const model = data?.scene ? attempt(errors, player_place, 'The motion cannot be shown', () => new SceneModel(data, data.scene!)) : null;
    players[k] = data && model && player_place
      ? attempt(errors, player_place, 'The motion cannot be shown', () => new Player(player_place, data, model, clock)) : null;
    handle.plots[k] = data && plots_place && data.columns.length > 0
      ? attempt(errors, plots_place, 'The plots cannot be shown', () => new Plots(plots_place, data, clock)) : null;
    handle.cases[k] = case_handle(data?.name ?? '', clock, model, () => players[k]);
  });
  handle.stage = (width, height, frame) => { if (players[0]) stage(players[0], width, height, frame); };
  document.documentElement.dataset.live = '1';
  if (location.hash === '#stage') handle.stage();
  handle.ready = document.fonts ? document.fonts.ready.then(() => undefined) : Promise.resolve();
  return handle;
}

if (document.readyState === 'loading') addEventListener('DOMContentLoaded', () => { window.anholon = mount(); });
else window.anholon = mount();
