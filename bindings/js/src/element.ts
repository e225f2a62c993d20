// SPDX-License-Identifier: Apache-2.0
// <sac-player src="clip.sac">: a player for pages that have no three.js of their own.
import { icons, template } from './element_style.js';
import type { SacError } from './errors.js';
import { SacLoader, type SacInput } from './loader.js';
import type { SacMesh, SacOptions } from './mesh.js';
import { SacViewer } from './viewer.js';

export { SacLoader, SacMesh, SacViewer, type SacOptions };
export type { SacInput };
export { SacError } from './errors.js';

/** Seconds as m:ss.d. */
export function clock(seconds: number): string {
  const tenths = Math.floor(Math.max(seconds, 0) * 10 + 1e-6);
  return `${Math.floor(tenths / 600)}:${String(Math.floor(tenths / 10) % 60).padStart(2, '0')}.${tenths % 10}`;
}

// All players of a page share their workers.
let loader: SacLoader | null = null;

/**
 * Attributes: `src`, `autoplay`, `loop` (on unless "false"), `controls` (on unless "false"), `rate`, `wireframe`,
 * `follow` (on unless "false"), `layers` (of each group, fewer are coarser), `decoder-path`. Events: those of SacMesh, as `sac-mesh`, `sac-frame`, `sac-ended`,
 * `sac-error`. Keys: space, arrows, Home, End, L, W, R, F, [ and ].
 */
export class SacPlayer extends HTMLElement {
  static readonly observedAttributes = ['src', 'loop', 'rate', 'wireframe', 'follow'];
  /** The mesh that is shown. */
  mesh: SacMesh | null = null;
  viewer: SacViewer | null = null;
  /** How clips are opened. */
  options: SacOptions = {};

  private readonly root = this.attachShadow({ mode: 'open' });
  private scrubbing = false;

  constructor() {
    super();
    this.root.innerHTML = template;
    this.wire();
  }

  connectedCallback(): void {
    if (!this.hasAttribute('tabindex')) this.tabIndex = 0;
    loader ??= new SacLoader();
    const path = this.getAttribute('decoder-path');
    if (path) loader.setDecoderPath(path);
    loader.preload();
    this.viewer = new SacViewer(this.find<HTMLCanvasElement>('canvas'));
    this.viewer.onRender = () => this.tick();
    this.attributeChangedCallback('follow');
    const src = this.getAttribute('src');
    if (src) this.load(src);
  }

  disconnectedCallback(): void {
    this.mesh?.dispose();
    this.mesh = null;
    this.viewer?.dispose();
    this.viewer = null;
    // A canvas whose context was given up cannot have another.
    const canvas = this.find('canvas');
    canvas.replaceWith(canvas.cloneNode());
  }

  attributeChangedCallback(name: string): void {
    if (name === 'src' && this.viewer) this.load(this.getAttribute('src') ?? '');
    if (name === 'loop' && this.mesh) this.mesh.loop = this.getAttribute('loop') !== 'false';
    if (name === 'rate') this.playbackRate = Number(this.getAttribute('rate') ?? 1);
    if (name === 'wireframe') this.wireframe = this.hasAttribute('wireframe');
    if (name === 'follow' && this.viewer) this.viewer.follow = this.getAttribute('follow') !== 'false';
  }

  /** Plays another clip: an address, a file, bytes. Resolves with its mesh when there is something to see. */
  load(input: SacInput): Promise<SacMesh> {
    this.mesh?.dispose();
    this.note('', 'spin');
    const mesh = loader!.open(input, {
      autoplay: this.hasAttribute('autoplay'),
      loop: this.getAttribute('loop') !== 'false',
      ...(this.hasAttribute('layers') ? { layers: Number(this.getAttribute('layers')) } : {}),
      ...this.options,
    });
    this.mesh = mesh;
    mesh.playbackRate = Number(this.getAttribute('rate') ?? 1) || 1;
    const events = mesh as unknown as { addEventListener(type: string, f: (e: object) => void): void };
    for (const type of ['mesh', 'frame', 'length', 'ended', 'error']) {
      events.addEventListener(type, (event) => {
        if (this.mesh === mesh) this.dispatchEvent(new CustomEvent(`sac-${type}`, { detail: event }));
      });
    }
    this.viewer!.show(mesh);
    mesh.ready.then(
      () => {
        if (this.mesh !== mesh) return;
        this.note('');
        this.wireframe = this.hasAttribute('wireframe');
      },
      () => undefined);
    events.addEventListener('error', (event) => {
      if (this.mesh === mesh) this.note((event as { error: SacError }).error.message, 'error');
    });
    return mesh.ready;
  }

  play(): void {
    this.mesh?.play();
  }

  pause(): void {
    this.mesh?.pause();
  }

  get paused(): boolean {
    return this.mesh?.paused ?? true;
  }

  get currentTime(): number {
    return this.mesh?.currentTime ?? 0;
  }

  set currentTime(seconds: number) {
    this.mesh?.seek(seconds);
  }

  get duration(): number {
    return this.mesh?.duration ?? NaN;
  }

  get playbackRate(): number {
    return this.mesh?.playbackRate ?? 1;
  }

  set playbackRate(rate: number) {
    if (!Number.isFinite(rate) || rate === 0) return;
    if (this.mesh) this.mesh.playbackRate = rate;
    this.find<HTMLSelectElement>('.rate').value = String(rate);
  }

  set wireframe(on: boolean) {
    if (this.viewer) this.viewer.wireframe = on;
    this.find('.wire').setAttribute('aria-pressed', String(on));
  }

  get wireframe(): boolean {
    return this.find('.wire').getAttribute('aria-pressed') === 'true';
  }

  private find<T extends HTMLElement = HTMLElement>(selector: string): T {
    return this.root.querySelector<T>(selector)!;
  }

  private note(text: string, kind = ''): void {
    const note = this.find('.note');
    note.textContent = text || (kind === 'spin' ? '\u200b' : '');
    note.className = `note ${kind}`;
  }

  private toggle(): void {
    if (this.mesh) this.mesh.paused ? this.mesh.play() : this.mesh.pause();
  }

  private step(frames: number): void {
    const { mesh } = this;
    if (!mesh) return;
    mesh.pause();
    const last = mesh.frames ?? Infinity;
    let frame = Math.floor(mesh.currentTime * mesh.frameRate + 1e-6) + frames;
    if (mesh.loop && Number.isFinite(last)) frame = (frame + last) % last;
    mesh.seek(Math.min(Math.max(frame, 0), last) / mesh.frameRate);
  }

  private fullScreen(): void {
    if (document.fullscreenElement) void document.exitFullscreen();
    else void this.requestFullscreen?.().catch(() => undefined);
  }

  private changeRate(by: number): void {
    const { options } = this.find<HTMLSelectElement>('.rate');
    const rates = [...options].map((o) => Number(o.value));
    const next = rates[rates.indexOf(this.playbackRate) + by];
    if (next !== undefined) this.playbackRate = next;
  }

  private toggleLoop(): void {
    if (!this.mesh) return;
    this.mesh.loop = !this.mesh.loop;
    this.find('.loop').setAttribute('aria-pressed', String(this.mesh.loop));
  }

  private wire(): void {
    const on = (selector: string, type: string, action: () => void) => this.find(selector).addEventListener(type, action);
    on('.play', 'click', () => this.toggle());
    on('.loop', 'click', () => this.toggleLoop());
    on('.wire', 'click', () => (this.wireframe = !this.wireframe));
    on('.home', 'click', () => this.viewer?.frameMesh());
    on('.full', 'click', () => this.fullScreen());
    on('.rate', 'change', () => (this.playbackRate = Number(this.find<HTMLSelectElement>('.rate').value)));
    const slider = this.find<HTMLInputElement>('input');
    on('input', 'input', () => {
      this.scrubbing = true;
      if (this.mesh?.duration) this.mesh.seek(Number(slider.value) * this.mesh.duration);
    });
    on('input', 'change', () => (this.scrubbing = false));
    const keys: Record<string, () => void> = {
      ' ': () => this.toggle(),
      ArrowLeft: () => this.step(-1),
      ArrowRight: () => this.step(1),
      Home: () => this.mesh?.seek(0),
      End: () => this.mesh?.seek(Infinity),
      l: () => this.toggleLoop(),
      w: () => (this.wireframe = !this.wireframe),
      r: () => this.viewer?.frameMesh(),
      f: () => this.fullScreen(),
      '[': () => this.changeRate(-1),
      ']': () => this.changeRate(1),
    };
    this.addEventListener('keydown', (event) => {
      const inside = event.composedPath()[0] as HTMLElement;
      // Buttons and menus have keys of their own.
      if (event.ctrlKey || event.metaKey || event.altKey || inside.matches('select') ||
        (event.key === ' ' && inside.matches('button'))) return;
      const action = keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
      if (!action) return;
      event.preventDefault();
      action();
    });
  }

  /** Brings the controls up to date with the mesh. */
  private tick(): void {
    const { mesh } = this;
    if (!mesh) return;
    const playing = String(!mesh.paused);
    const play = this.find('.play');
    if (play.dataset.playing !== playing) {
      play.dataset.playing = playing;
      play.setAttribute('aria-label', mesh.paused ? 'Play' : 'Pause');
      play.firstElementChild!.innerHTML = mesh.paused ? icons.play : icons.pause;
    }
    const { duration, currentTime } = mesh;
    const text = duration ? `${clock(currentTime)} / ${clock(duration)}` : clock(currentTime);
    const time = this.find('time');
    if (time.textContent !== text) time.textContent = text;
    const slider = this.find<HTMLInputElement>('input');
    const done = duration ? currentTime / duration : 0;
    if (!this.scrubbing) slider.value = String(done);
    slider.style.setProperty('--done', `${100 * done}%`);
  }
}

if (!customElements.get('sac-player')) customElements.define('sac-player', SacPlayer);
