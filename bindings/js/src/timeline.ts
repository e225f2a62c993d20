// SPDX-License-Identifier: Apache-2.0
import type { Run } from './clip.js';

/** A shape that waits to be shown: how far from its run's start it is, in frames. */
export interface Queued {
  epoch: number;
  travel: number;
}

/** A clock that another keeps: a video or its sound. HTMLMediaElement is one. */
export interface MediaClock {
  readonly currentTime: number;
  readonly paused: boolean;
  readonly playbackRate: number;
  readonly loop: boolean;
}

// Seconds by which a media clock may be off what was expected before it counts as a jump.
const JUMP = 0.25;
// Screens show no more shapes than that a second: a faster clip leaves frames out.
const SCREEN_RATE = 60;

/**
 * Where in a clip a player is: turns a clock into the shape to show, and tells when the worker has to begin anew. Times
 * are seconds. It knows neither workers nor three.js.
 */
export class Timeline<T extends Queued> {
  /** Frames per second. */
  frameRate = 30;
  frames: number | undefined;
  playing = false;
  loop = true;
  /** Shapes a frame; 1 or the parts into which the decoder divides a frame. */
  subdivision = 1;
  /** The shapes that are there, in playing order. */
  readonly queue: T[] = [];
  /** What is shown, and what follows it when it is there. */
  shown: T | null = null;

  private rate_ = 1;
  private run_: Run = { epoch: 0, start: 0, direction: 1, step: 1, loop: true };
  private travel = 0;
  private endTravel: number | null = null;  // of the last shape of the run
  private readonly begin: (run: Run) => void;
  private readonly release: (shapes: T[]) => void;

  /** `begin` has the worker begin a run; `release` gives back shapes that were shown or are of no use. */
  constructor(begin: (run: Run) => void, release: (shapes: T[]) => void) {
    this.begin = begin;
    this.release = release;
  }

  get run(): Run {
    return this.run_;
  }

  get duration(): number | undefined {
    return this.frames === undefined ? undefined : this.frames / this.frameRate;
  }

  get currentTime(): number {
    return this.frame / this.frameRate;
  }

  /** The time in frames, within the clip. */
  get frame(): number {
    const at = this.run_.start + this.run_.direction * this.travel;
    if (!this.frames) return Math.max(at, 0);
    if (!this.loop) return Math.min(Math.max(at, 0), this.frames);
    const wrapped = at % this.frames;
    return wrapped < 0 ? wrapped + this.frames : wrapped;
  }

  /** The frame whose turn it is, whole, backwards too. */
  get frameIndex(): number {
    return Math.min(Math.floor(this.frame + 1e-6), Math.max((this.frames ?? Infinity) - 1, 0));
  }

  get playbackRate(): number {
    return this.rate_;
  }

  /** Times the clip's own speed; negative: backwards. */
  set playbackRate(rate: number) {
    if (!Number.isFinite(rate)) return;
    const before = this.plan(this.rate_), after = this.plan(rate);
    this.rate_ = rate;
    if (before.direction !== after.direction || before.step !== after.step) this.restart(this.frame);
  }

  /** Whether the last shape is shown and none will follow. */
  get ended(): boolean {
    return this.endTravel !== null && this.shown?.epoch === this.run_.epoch && this.shown.travel >= this.endTravel;
  }

  /** How far the time is between the shown shape and the next, 0 to 1. */
  get fraction(): number {
    const next = this.queue[0];
    if (!this.shown || !next || this.shown.epoch !== this.run_.epoch) return 0;
    const width = next.travel - this.shown.travel;
    return width > 0 ? Math.min(Math.max((this.travel - this.shown.travel) / width, 0), 1) : 0;
  }

  /** Begins a run at a time. */
  seek(seconds: number): void {
    const last = this.frames === undefined ? Infinity : Math.max(this.frames - 1 / this.subdivision, 0);
    const frame = Math.min(Math.max(Number.isFinite(seconds) ? seconds * this.frameRate : 0, 0), last);
    this.restart(frame);
  }

  /** Begins a run at a frame, which may lie between two. */
  restart(frame: number): void {
    const { direction, step } = this.plan(this.rate_);
    // Shapes are those of whole steps; the time is what was asked for.
    const unit = Math.min(step, 1);
    const start = direction > 0 ? Math.floor(frame / unit + 1e-6) * unit : Math.ceil(frame / unit - 1e-6) * unit;
    const inside = this.frames === undefined ? start : Math.min(start, Math.max(this.frames - unit, 0));
    this.run_ = { epoch: this.run_.epoch + 1, start: inside, direction, step, loop: this.loop };
    this.travel = Math.max(direction * (frame - inside), 0);
    this.endTravel = null;
    this.release(this.queue.splice(0));
    this.begin(this.run_);
  }

  /** Takes a shape that was decoded. */
  push(shape: T): void {
    if (shape.epoch !== this.run_.epoch) this.release([shape]);
    else this.queue.push(shape);
  }

  end(epoch: number, travel: number): void {
    if (epoch === this.run_.epoch) this.endTravel = travel;
  }

  /** Goes on by so many seconds of the player's own clock. */
  advance(seconds: number): void {
    if (!this.playing || !(seconds > 0)) return;
    this.travel += seconds * Math.abs(this.rate_) * this.frameRate;
    this.hold();
  }

  /** Goes to where another clock is. */
  follow(clock: MediaClock): void {
    this.playing = !clock.paused;
    const frame = clock.currentTime * this.frameRate;
    const { direction, start } = this.run_;
    let ahead = direction * (frame - this.frame);
    // A clock that loops with its clip goes on.
    if (this.frames && this.loop) {
      if (ahead < -this.frames / 2) ahead += this.frames;
      else if (ahead > this.frames / 2) ahead -= this.frames;
    }
    if (Math.abs(ahead) > JUMP * this.frameRate * Math.max(Math.abs(clock.playbackRate), 1) || this.travel + ahead < 0) {
      if (frame !== start || this.travel !== 0) this.seek(clock.currentTime);
      return;
    }
    // Media clocks go in steps and sometimes a little back, shapes do not.
    if (ahead > 0) this.travel += ahead;
  }

  /** The time of the run, in frames from its start: what a worker that lags need not decode any more. */
  get wanted(): number {
    return this.travel;
  }

  /** Chooses the shape for the time; true when it is another than before. */
  update(): boolean {
    const { queue } = this;
    let due = -1;
    // The first shape of a run is shown at once, even when its time has not come by a rounding error.
    while (due + 1 < queue.length && (queue[due + 1]!.travel <= this.travel + 1e-6 || (due < 0 && this.stale))) ++due;
    if (due < 0) return false;
    const before = this.shown;
    this.shown = queue[due]!;
    const used = queue.splice(0, due + 1).slice(0, -1);
    this.release(before ? [before, ...used] : used);
    return true;
  }

  private get stale(): boolean {
    return this.shown === null || this.shown.epoch !== this.run_.epoch;
  }

  /** The own clock waits for the first shape, for bytes, and at the end. */
  private hold(): void {
    const last = this.queue.at(-1) ?? (this.stale ? null : this.shown);
    const limit = last === null ? this.travelOfFirst() : last.travel + 8 * this.run_.step;
    if (this.endTravel !== null && !this.loop) {
      this.travel = Math.min(this.travel, this.endTravel + this.run_.step);
      if (this.travel >= this.endTravel + this.run_.step) this.playing = false;
    } else {
      this.travel = Math.min(this.travel, limit);
    }
  }

  private travelOfFirst(): number {
    return this.run_.step;
  }

  private plan(rate: number): { direction: 1 | -1; step: number } {
    const direction = rate < 0 ? -1 : 1;
    const skip = Math.max(Math.floor((Math.abs(rate) * this.frameRate) / SCREEN_RATE), 1);
    return { direction, step: skip > 1 ? skip : 1 / this.subdivision };
  }
}
