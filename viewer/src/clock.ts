// The time that a case's player and plots share.

export class Clock {
  time: number;
  loop = false;
  speed = 1;
  playing = false;
  readonly rate: number;               // units of the run's time per second on screen, at speed 1
  private listeners: (() => void)[] = [];
  private last = 0;
  private request = 0;

  constructor(readonly start: number, readonly end: number) {
    this.time = start;
    this.rate = comfortable_rate(end - start);
  }

  // `f` is called after each change of time, speed, loop or playing.
  listen(f: () => void): void { this.listeners.push(f); }
  changed(): void { for (const f of this.listeners) f(); }

  play(): void {
    if (this.playing || !(this.end > this.start)) return;
    if (this.time >= this.end) this.time = this.start;
    this.playing = true;
    this.last = performance.now();
    this.request = requestAnimationFrame((now) => this.tick(now));
    this.changed();
  }

  pause(): void {
    if (!this.playing) return;
    this.playing = false;
    cancelAnimationFrame(this.request);
    this.changed();
  }

  toggle(): void { if (this.playing) this.pause(); else this.play(); }

  seek(time: number): void {
    if (Number.isNaN(time)) return;
    this.time = Math.min(this.end, Math.max(this.start, time));
    this.changed();
  }

  private tick(now: number): void {
    // A page that was in the background continues at its time.
    const elapsed = Math.min(0.1, Math.max(0, (now - this.last) / 1000));
    this.last = now;
    const length = this.end - this.start;
    let time = this.time + elapsed * this.rate * this.speed;
    if (time >= this.end) {
      if (this.loop) time = this.start + ((time - this.start) % length);
      else { time = this.end; this.playing = false; }
    }
    this.time = time;
    if (this.playing) this.request = requestAnimationFrame((next) => this.tick(next));
    this.changed();
  }
}

// Returns the first speed: real time for runs of 2 to 60 s, else the speed at which the run takes ten seconds.
export function comfortable_rate(duration: number): number {
  if (!(duration > 0)) return 1;
  return duration >= 2 && duration <= 60 ? 1 : duration / 10;
}
