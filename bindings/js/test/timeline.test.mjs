// SPDX-License-Identifier: Apache-2.0
// Which shape is shown when, by a clock of the test's own.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Timeline } from '../dist/testing.js';

/** A timeline with a worker that is always in time: the queue holds `ahead` shapes. */
function make({ frames = 10, ahead = 4, loop = true } = {}) {
  const log = { runs: [], released: 0 };
  let next = 0;
  const timeline = new Timeline((run) => { log.runs.push({ ...run }); next = 0; }, (shapes) => { log.released += shapes.length; });
  timeline.loop = loop;
  timeline.frames = frames;
  timeline.frameRate = 10;
  timeline.restart(0);
  const fill = () => {
    const { epoch, start, direction, step } = timeline.run;
    while (timeline.queue.length < ahead) {
      let frame = start + direction * next * step;
      if (!loop && (frame < 0 || frame >= frames)) return timeline.end(epoch, (next - 1) * step);
      frame = ((frame % frames) + frames) % frames;
      timeline.push({ epoch, travel: next * step, frame });
      ++next;
    }
  };
  const run = (seconds, tick = 1 / 60) => {
    const shown = [];
    for (let t = 0; t < seconds - 1e-9; t += tick) {
      fill();
      timeline.advance(tick);
      if (timeline.update()) shown.push(timeline.shown.frame);
    }
    return shown;
  };
  fill();
  timeline.update();
  return { timeline, log, run, fill };
}

test('plays in its rate, over the loop without a gap', () => {
  const { timeline, run, log } = make();
  assert.equal(timeline.shown.frame, 0);
  timeline.playing = true;
  assert.deepEqual(run(2.25), [...Array(22).keys()].map((i) => (i + 1) % 10));
  assert.equal(log.runs.length, 1);
  assert.ok(Math.abs(timeline.currentTime - 0.25) < 0.02);
});

test('pauses, and goes on where it was', () => {
  const { timeline, run } = make();
  timeline.playing = true;
  run(0.35);
  timeline.playing = false;
  assert.deepEqual(run(1), []);
  timeline.playing = true;
  assert.deepEqual(run(0.2), [4, 5]);
});

test('rates: slower, faster, with frames left out, backwards', () => {
  const { timeline, run, log } = make();
  timeline.playing = true;
  timeline.playbackRate = 0.5;
  assert.deepEqual(run(0.85), [1, 2, 3, 4]);
  assert.equal(log.runs.length, 1);
  timeline.playbackRate = 20;  // 200 frames a second: every third is shown
  assert.deepEqual(log.runs.at(-1), { epoch: 2, start: 4, direction: 1, step: 3, loop: true });
  timeline.playbackRate = -1;
  assert.equal(log.runs.at(-1).direction, -1);
  assert.equal(log.runs.at(-1).start, 5);
  assert.deepEqual(run(0.65).slice(1), [4, 3, 2, 1, 0, 9, 8]);
});

test('ends without a loop, and waits there', () => {
  const { timeline, run } = make({ loop: false });
  timeline.playing = true;
  assert.deepEqual(run(3), [1, 2, 3, 4, 5, 6, 7, 8, 9]);
  assert.ok(timeline.ended && !timeline.playing);
  assert.ok(Math.abs(timeline.currentTime - 1) < 1e-9);
});

test('a seek empties the queue and keeps what is shown until another shape is there', () => {
  const { timeline, log, fill } = make();
  timeline.seek(0.72);
  assert.equal(timeline.queue.length, 0);
  assert.equal(timeline.shown.frame, 0);
  assert.equal(timeline.update(), false);
  timeline.push({ epoch: 1, travel: 1, frame: 1 });  // of the run before
  assert.equal(timeline.queue.length, 0);
  fill();
  assert.ok(timeline.update());
  assert.equal(timeline.shown.frame, 7);
  assert.ok(Math.abs(timeline.fraction - 0.2) < 1e-6);
  assert.equal(log.runs.at(-1).start, 7);
  timeline.seek(99);
  assert.equal(log.runs.at(-1).start, 9);
  timeline.seek(-1);
  assert.equal(log.runs.at(-1).start, 0);
  timeline.seek(NaN);
  assert.equal(log.runs.at(-1).start, 0);
});

test('every shape is given back once', () => {
  const { timeline, log, run } = make();
  timeline.playing = true;
  let pushed = 0;
  const push = timeline.push.bind(timeline);
  timeline.push = (s) => { ++pushed; push(s); };
  run(5);
  assert.equal(log.released + timeline.queue.length + 1, pushed + 4);
});

test('without shapes the clock waits', () => {
  const { timeline } = make({ ahead: 1 });
  timeline.playing = true;
  for (let i = 0; i < 1000; ++i) {
    timeline.advance(0.1);
    timeline.update();
  }
  assert.ok(timeline.wanted <= 8);
});

test('another clock: its rate, jumps, pauses and loop', () => {
  const { timeline, log, fill } = make();
  const clock = { currentTime: 0, paused: false, playbackRate: 1, loop: true };
  const shown = [];
  const tick = (to) => {
    clock.currentTime = to;
    fill();
    timeline.follow(clock);
    fill();
    if (timeline.update()) shown.push(timeline.shown.frame);
  };
  for (let t = 0; t < 0.55; t += 0.05) tick(t);
  assert.deepEqual(shown, [1, 2, 3, 4, 5]);
  clock.paused = true;
  tick(0.5);
  assert.equal(timeline.playing, false);
  clock.paused = false;
  shown.length = 0;
  for (const t of [0.7, 0.8, 0.95, 0.02, 0.13]) tick(t);
  assert.deepEqual(shown, [7, 8, 9, 0, 1]);
  assert.equal(log.runs.length, 1);
  tick(0.61);  // a jump
  assert.equal(log.runs.length, 2);
  assert.equal(timeline.run.start, 6);
  tick(0.61);
  assert.equal(timeline.shown.frame, 6);
  assert.equal(log.runs.length, 2);
});
