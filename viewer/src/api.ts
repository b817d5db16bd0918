// The interface of the page for programs: `anholon render` and the tests use it through window.anholon.

import type { Clock } from './clock.ts';
import type { RawReport } from './data.ts';
import type { Places } from './motion_view.ts';
import type { Plots } from './plots.ts';
import type { Player } from './player.ts';
import type { Frame, Pose, SceneModel } from './scene.ts';

export interface CaseHandle {
  readonly name: string;
  readonly times: { start: number; end: number };
  readonly time: number;
  play(): void;
  pause(): void;
  seek(time: number): void;                // the picture is drawn when this returns
  pose(time: number): Pose[];              // in the observer's axes; [] without a scene
}

export interface Handle {
  cases: CaseHandle[];
  plots: (Plots | null)[];
  errors: string[];
  ready: Promise<void>;
  show(data: RawReport, places: () => Places): void;      // replaces what the last call showed
  stage(width?: number, height?: number, frame?: Frame): void;
}

export function case_handle(name: string, clock: Clock, model: SceneModel | null, player: () => Player | null): CaseHandle {
  return {
    name, times: { start: clock.start, end: clock.end },
    get time() { return clock.time; },
    play: () => clock.play(),
    pause: () => clock.pause(),
    seek(time) { clock.seek(time); player()?.draw_now(); },
    pose: (time) => (model ? model.pose(Math.min(clock.end, Math.max(clock.start, time))) : []),
  };
}

// Shows the picture alone, over the whole window or with the given size, as the moving or an inertial observer sees it.
export function stage(player: Player, width?: number, height?: number, frame?: Frame): void {
  let box = document.querySelector<HTMLElement>('body > .anholon-stage');
  if (!box) {
    box = document.createElement('div');
    box.className = 'anholon-stage';
    document.body.append(box);
    box.append(player.views);
    document.documentElement.dataset.stage = '1';
  }
  box.style.width = width ? `${width}px` : '';
  box.style.height = height ? `${height}px` : '';
  if (frame && player.model.motion) player.set_frames([frame]);
  player.wake();
}
