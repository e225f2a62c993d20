// SPDX-License-Identifier: Apache-2.0
import type { Run, Shape } from './clip.js';
import type { SacDecoderOptions } from './decoder.js';
import { makeError, SacError, SacNetworkError } from './errors.js';
import { compileSac } from './instance.js';
import type { FromWorker, ToWorker } from './protocol.js';
import type { ShapeBuffers } from './segment.js';
import type { SacSource } from './source.js';

/** What a clip in a worker tells. */
export interface ClipListener {
  mesh(message: Extract<FromWorker, { type: 'mesh' }>): void;
  shape(shape: Shape, memory: number, loaded: number): void;
  length(frames: number, bytes: number): void;
  end(epoch: number, travel: number): void;
  error(error: SacError): void;
}

interface PoolWorker {
  worker: Worker;
  ready: Promise<void>;
  clips: Map<number, ClipListener>;
}

export interface PoolOptions {
  /** The folder of worker.js and sac.wasm, with a slash at its end; undefined: beside this module. */
  path: string | undefined;
  /** Workers at most; more clips share them. */
  limit: number;
  /** Whether new workers decode a small clip, for the browser to compile everything in time. */
  warm: boolean;
}

/** A clip that a worker decodes. */
export class ClipHandle {
  private readonly id: number;
  private readonly send: (message: ToWorker, transfer?: Transferable[]) => void;
  private readonly end: () => void;

  constructor(id: number, send: (message: ToWorker, transfer?: Transferable[]) => void, end: () => void) {
    this.id = id;
    this.send = send;
    this.end = end;
  }

  play(run: Run): void {
    this.send({ type: 'play', id: this.id, run });
  }

  /** Gives shapes back to be filled again. */
  credit(shapes: Shape[], epoch: number, wanted: number): void {
    const buffers: ShapeBuffers[] = shapes.map((s) => s.buffers);
    this.send({ type: 'credit', id: this.id, buffers, epoch, wanted },
      buffers.flatMap((b) => [b.positions.buffer, b.normals.buffer]));
  }

  chunk(bytes: Uint8Array | null, error?: string): void {
    this.send({ type: 'chunk', id: this.id, bytes, ...(error === undefined ? {} : { error }) });
  }

  close(): void {
    this.end();
  }
}

/** The workers of a loader. The decoder is compiled once for all of them. */
export class WorkerPool {
  readonly options: PoolOptions = { path: undefined, limit: defaultLimit(), warm: true };
  private module: Promise<WebAssembly.Module> | null = null;
  private workers: PoolWorker[] = [];
  private nextId = 1;

  /** Compiles the decoder and starts a worker ahead of the first clip. */
  async preload(): Promise<void> {
    await this.acquire().ready;
  }

  /** How many workers there are, and clips that are open in them. */
  get counts(): { workers: number; clips: number } {
    return { workers: this.workers.length, clips: this.workers.reduce((sum, w) => sum + w.clips.size, 0) };
  }

  open(source: SacSource, options: SacDecoderOptions & { ahead: number }, listener: ClipListener): ClipHandle {
    const entry = this.acquire();
    const id = this.nextId++;
    entry.clips.set(id, listener);
    let open = true;
    const started = entry.ready.then(
      () => entry.worker.postMessage({ type: 'open', id, source, options } satisfies ToWorker),
      (error) => {
        if (open) listener.error(error instanceof SacError ? error : new SacNetworkError(String(error)));
        open = false;
      });
    const send = (message: ToWorker, transfer: Transferable[] = []) => {
      void started.then(() => open && entry.worker.postMessage(message, transfer));
    };
    return new ClipHandle(id, send, () => {
      if (!open) return;
      entry.clips.delete(id);
      // A clip whose worker has not begun need not be opened, but messages keep their order.
      void started.then(() => entry.worker.postMessage({ type: 'close', id } satisfies ToWorker));
      open = false;
    });
  }

  /** Ends all workers. Clips that are open end without a word. */
  dispose(): void {
    for (const { worker } of this.workers) worker.terminate();
    this.workers = [];
    this.module = null;
  }

  private url(file: string): URL {
    if (this.options.path === undefined) {
      // Bundlers look for these two expressions as they stand.
      return file === 'worker.js' ? new URL('./worker.js', import.meta.url) : new URL('./sac.wasm', import.meta.url);
    }
    return new URL(file, new URL(this.options.path, document.baseURI));
  }

  /** A worker that is free; a new one where none is and there may be more; else the one with the fewest clips. */
  private acquire(): PoolWorker {
    const least = this.workers.reduce<PoolWorker | null>((a, b) => (a && a.clips.size <= b.clips.size ? a : b), null);
    if (least && (least.clips.size === 0 || this.workers.length >= this.options.limit)) return least;
    const entry = this.startWorker();
    this.workers.push(entry);
    return entry;
  }

  private startWorker(): PoolWorker {
    const worker = this.makeWorker();
    const clips = new Map<number, ClipListener>();
    let settle: { resolve: () => void; reject: (error: Error) => void };
    const ready = new Promise<void>((resolve, reject) => (settle = { resolve, reject }));
    const entry: PoolWorker = { worker, ready, clips };
    const drop = (error: SacError) => {
      this.workers = this.workers.filter((w) => w !== entry);
      worker.terminate();
      settle.reject(error);
      for (const listener of clips.values()) listener.error(error);
      clips.clear();
    };
    worker.onmessage = ({ data }: MessageEvent<FromWorker>) => {
      if (data.type === 'ready') settle.resolve();
      else deliver(data, clips.get(data.id));
    };
    worker.onerror = (event) => {
      event.preventDefault();
      drop(new SacNetworkError(`the decoder's worker cannot run: ${event.message ?? 'it was not found'}`));
    };
    this.module ??= compileSac(this.url('sac.wasm'));
    this.module.then(
      (module) => worker.postMessage({ type: 'init', module, warm: this.options.warm } satisfies ToWorker),
      (error: Error) => {
        this.module = null;  // the next attempt may find it
        drop(error instanceof SacError ? error : new SacNetworkError(`the decoder cannot be compiled: ${error.message}`));
      });
    ready.catch(() => undefined);  // told to each clip
    return entry;
  }

  private makeWorker(): Worker {
    if (this.options.path === undefined) {
      const here = this.url('worker.js');
      if (here.origin === location.origin) return new Worker(new URL('./worker.js', import.meta.url), { type: 'module' });
    }
    const url = this.url('worker.js');
    if (url.origin === location.origin) return new Worker(url, { type: 'module' });
    // A worker must be of the page's own origin; what it imports may be of another.
    const blob = new Blob([`import ${JSON.stringify(url.href)};`], { type: 'text/javascript' });
    const own = URL.createObjectURL(blob);
    const worker = new Worker(own, { type: 'module' });
    setTimeout(() => URL.revokeObjectURL(own), 60000);
    return worker;
  }
}

function deliver(message: Exclude<FromWorker, { type: 'ready' }>, listener: ClipListener | undefined): void {
  if (!listener) return;
  switch (message.type) {
    case 'mesh':
      return listener.mesh(message);
    case 'shape':
      return listener.shape(message.shape, message.memory, message.loaded);
    case 'length':
      return listener.length(message.frames, message.bytes);
    case 'end':
      return listener.end(message.epoch, message.travel);
    case 'error':
      return listener.error(makeError(message.code, message.message));
  }
}

function defaultLimit(): number {
  const cores = typeof navigator === 'undefined' ? 2 : (navigator.hardwareConcurrency ?? 2);
  return Math.min(Math.max(cores - 1, 1), 4);
}
