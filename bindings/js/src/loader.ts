// SPDX-License-Identifier: Apache-2.0
import { Loader, type LoadingManager } from 'three';
import { SacArgumentError, type SacError } from './errors.js';
import { SacMesh, type SacOptions } from './mesh.js';
import { WorkerPool } from './pool.js';
import type { SacSource } from './source.js';

/** Where a clip may come from. */
export type SacInput = string | URL | Blob | ArrayBuffer | Uint8Array | ReadableStream<Uint8Array>;

/**
 * Loads streams as meshes that play.
 *
 *     const mesh = await new SacLoader().loadAsync('walker.sac');
 *     scene.add(mesh);
 *     mesh.play();
 */
export class SacLoader extends Loader<SacMesh> {
  private readonly pool = new WorkerPool();

  constructor(manager?: LoadingManager) {
    super(manager);
  }

  /** The folder of worker.js and sac.wasm, where they are not beside this module. */
  setDecoderPath(path: string): this {
    this.pool.options.path = path.endsWith('/') ? path : `${path}/`;
    return this;
  }

  /** Workers at most; clips beyond share them. */
  setWorkerLimit(limit: number): this {
    if (!Number.isInteger(limit) || limit < 1) throw new SacArgumentError(`${limit} is no number of workers`);
    this.pool.options.limit = limit;
    return this;
  }

  /** Compiles the decoder and warms it up while the page does other things. */
  preload(): this {
    void this.pool.preload().catch(() => undefined);  // load() tells
    return this;
  }

  /** Workers that run and clips that are open in them. */
  get counts(): { workers: number; clips: number } {
    return this.pool.counts;
  }

  /** A mesh at once; its shape comes. It tells what happens by events, and `ready` waits for the first shape. */
  open(input: SacInput, options: SacOptions = {}): SacMesh {
    let source: SacSource = { kind: 'chunks' };
    if (typeof input === 'string' || input instanceof URL) {
      const url = typeof input === 'string' ? this.manager.resolveURL(this.path + input) : input.href;
      source = { kind: 'url', url: new URL(url, document.baseURI).href, headers: this.requestHeader };
      if (this.withCredentials) source.credentials = 'include';
    } else if (input instanceof Blob) {
      source = { kind: 'blob', blob: input };
    }
    const mesh = new SacMesh(this.pool, source, options);
    if (input instanceof ArrayBuffer) {
      mesh.feed(new Uint8Array(input));
      mesh.feed(null);
    } else if (input instanceof Uint8Array) {
      mesh.feed(input);
      mesh.feed(null);
    } else if (input instanceof ReadableStream) {
      void pump(input, mesh);
    }
    return mesh;
  }

  /** Calls `onLoad` with the mesh when its first shape is there. */
  override load(url: string, onLoad: (mesh: SacMesh) => void, onProgress?: (event: ProgressEvent) => void,
    onError?: (error: unknown) => void, options: SacOptions = {}): void {
    this.manager.itemStart(url);
    const mesh = this.open(url, options);
    if (onProgress) {
      (mesh as unknown as { addEventListener(type: string, f: (e: { bytes: number }) => void): void })
        .addEventListener('progress', ({ bytes }) => onProgress(new ProgressEvent('progress', { loaded: bytes })));
    }
    mesh.ready.then(
      () => {
        onLoad(mesh);
        this.manager.itemEnd(url);
      },
      (error: SacError) => {
        mesh.dispose();
        if (onError) onError(error);
        else console.error(error);
        this.manager.itemError(url);
        this.manager.itemEnd(url);
      });
  }

  /** The mesh when its first shape is there. */
  override loadAsync(url: string, onProgress?: (event: ProgressEvent) => void, options: SacOptions = {}): Promise<SacMesh> {
    return new Promise((resolve, reject) => this.load(url, resolve, onProgress, reject, options));
  }

  /** Ends the workers. Meshes that were loaded show what they show, and are to be disposed of by themselves. */
  dispose(): void {
    this.pool.dispose();
  }
}

async function pump(stream: ReadableStream<Uint8Array>, mesh: SacMesh): Promise<void> {
  const reader = stream.getReader();
  try {
    for (;;) {
      const { done, value } = await reader.read();
      mesh.feed(done ? null : value);
      if (done) return;
    }
  } catch (error) {
    mesh.feed(null, `the stream of bytes broke off: ${String(error)}`);
  }
}
