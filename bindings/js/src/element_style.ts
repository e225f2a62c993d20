// SPDX-License-Identifier: Apache-2.0

export const template = `
<style>
  :host { display: block; position: relative; aspect-ratio: 16 / 10; overflow: hidden; border-radius: 14px;
    background: radial-gradient(120% 90% at 50% 20%, #39414f 0%, #1d222b 55%, #12151b 100%);
    color: #f2f4f8; font: 500 13px/1 system-ui, sans-serif; --accent: #5db2ff; }
  :host([hidden]) { display: none; }
  canvas { position: absolute; inset: 0; width: 100%; height: 100%; display: block; touch-action: none; outline: none; }
  :host(:focus-visible) { outline: 2px solid var(--accent); outline-offset: 2px; }
  .bar { position: absolute; left: 12px; right: 12px; bottom: 12px; display: flex; align-items: center; gap: 6px;
    padding: 6px 8px; border-radius: 12px; background: #0d1017b8; backdrop-filter: blur(14px) saturate(1.4);
    box-shadow: 0 6px 24px #0006, inset 0 0 0 1px #ffffff14; transition: opacity .25s; }
  :host([controls="false"]) .bar { display: none; }
  button, select { all: unset; box-sizing: border-box; height: 34px; min-width: 34px; padding: 0 8px; border-radius: 8px;
    display: inline-grid; place-items: center; cursor: pointer; color: inherit; }
  button:hover, select:hover { background: #ffffff1c; }
  button:focus-visible, select:focus-visible, input:focus-visible { outline: 2px solid var(--accent); }
  button[aria-pressed="true"] { color: var(--accent); }
  svg { width: 18px; height: 18px; fill: none; stroke: currentColor; stroke-width: 1.9; stroke-linecap: round;
    stroke-linejoin: round; display: block; }
  svg.solid { fill: currentColor; stroke-width: 1.2; }
  option { color: #111; }
  input { flex: 1; min-width: 40px; height: 34px; margin: 0 4px; appearance: none; background: none; cursor: pointer;
    --done: 0%; }
  input::-webkit-slider-runnable-track { height: 4px; border-radius: 2px;
    background: linear-gradient(90deg, var(--accent) var(--done), #ffffff38 var(--done)); }
  input::-moz-range-track { height: 4px; border-radius: 2px;
    background: linear-gradient(90deg, var(--accent) var(--done), #ffffff38 var(--done)); }
  input::-webkit-slider-thumb { appearance: none; width: 14px; height: 14px; margin-top: -5px; border-radius: 50%;
    background: #fff; box-shadow: 0 1px 4px #0008; }
  input::-moz-range-thumb { border: 0; width: 14px; height: 14px; border-radius: 50%; background: #fff; }
  time { font-variant-numeric: tabular-nums; white-space: nowrap; opacity: .85; padding: 0 4px; }
  .note { position: absolute; inset: 0; display: grid; place-items: center; text-align: center; padding: 24px 24px 72px;
    pointer-events: none; font-size: 14px; line-height: 1.5; }
  .note.error { color: #ffb4a9; }
  .note:empty { display: none; }
  .spin::after { content: ""; width: 26px; height: 26px; border-radius: 50%; border: 3px solid #fff3;
    border-top-color: var(--accent); animation: turn .8s linear infinite; }
  @keyframes turn { to { transform: rotate(1turn); } }
  @media (prefers-reduced-motion: reduce) { .spin::after { animation-duration: 4s; } }
  @container (max-width: 460px) { .wide { display: none; } }
  .frame { position: absolute; inset: 0; container-type: inline-size; }
</style>
<div class="frame">
  <canvas part="canvas"></canvas>
  <div class="note" role="status"></div>
  <div class="bar" part="controls">
    <button class="play" aria-label="Play" title="Play or pause (space)">
      <svg class="solid" viewBox="0 0 24 24"><path d="M8 5.5v13l10.5-6.5z"/></svg></button>
    <input type="range" min="0" max="1" step="any" value="0" aria-label="Time">
    <time>0:00.0</time>
    <select class="rate wide" aria-label="Speed" title="Speed ([ and ])">
      <option value="-1">-1×</option><option value="0.1">0.1×</option><option value="0.25">0.25×</option>
      <option value="0.5">0.5×</option><option value="1" selected>1×</option><option value="1.5">1.5×</option>
      <option value="2">2×</option><option value="4">4×</option>
    </select>
    <button class="loop wide" aria-label="Loop" aria-pressed="true" title="Loop (L)">
      <svg viewBox="0 0 24 24"><path d="M17 3l3 3-3 3M4 11V9a3 3 0 013-3h13M7 21l-3-3 3-3M20 13v2a3 3 0 01-3 3H4"/></svg></button>
    <button class="wire wide" aria-label="Wireframe" aria-pressed="false" title="Wireframe (W)">
      <svg viewBox="0 0 24 24"><path d="M12 3l8 5v8l-8 5-8-5V8zM12 3v18M4 8l8 5 8-5M4 16l8-3 8 3"/></svg></button>
    <button class="home wide" aria-label="Whole shape" title="Show the whole shape (R)">
      <svg viewBox="0 0 24 24"><path d="M4 9V4h5M20 9V4h-5M4 15v5h5M20 15v5h-5"/></svg></button>
    <button class="full" aria-label="Full screen" title="Full screen (F)">
      <svg viewBox="0 0 24 24"><path d="M14 10l6-6M15 4h5v5M10 14l-6 6M9 20H4v-5"/></svg></button>
  </div>
</div>`;

export const icons = {
  play: '<path d="M8 5.5v13l10.5-6.5z"/>',
  pause: '<path d="M8 5.5v13M16 5.5v13" stroke-width="4"/>',
};
