// The player and the plots of a motion in places that may show another motion later. The time and the camera are then kept.

import { Clock } from './clock.ts';
import { read_report, type RawReport } from './data.ts';
import { h } from './dom.ts';
import { Player } from './player.ts';
import { Plots } from './plots.ts';
import { SceneModel } from './scene.ts';

export interface Places { player: HTMLElement; plots: HTMLElement }

export class MotionView {
  private clock = new Clock(0, 0);
  private player: Player | null = null;
  private plots: Plots | null = null;

  // Shows the first case of the data. `places` is called after the plots of the last motion are closed, and returns the new places.
  show(raw: RawReport, places: () => Places): void {
    const look = this.player?.look ?? null, { time, playing } = this.clock, before = this.player;
    this.plots?.close();
    this.clock.pause();
    this.player = this.plots = null;
    const { player, plots } = places();
    try {
      const [data] = read_report(raw).cases;
      this.clock = new Clock(data.start, data.end);
      if (data.scene) {
        this.player = new Player(player, data, new SceneModel(data, data.scene), this.clock);
        if (look) this.player.look = look;
      } else player.remove();
      this.plots = new Plots(plots, data, this.clock);
      this.clock.seek(time);
      if (playing) this.clock.play();
      this.player?.wake();
    } catch (e) { plots.replaceChildren(h('p', { class: 'sorry' }, `It cannot be shown: ${(e as Error).message}`)); }
    before?.close();          // closed after the new player is drawn, which can reuse the shaders
  }
}
