// SPDX-License-Identifier: Apache-2.0
// The worker: decodes the clips that a page gives it, each in an instance of its own.
import { Clip } from './clip.js';
import { SacDecoder } from './decoder.js';
import { toSacError } from './errors.js';
import type { SacInstance } from './instance.js';
import type { FromWorker, ToWorker } from './protocol.js';
import { SourceReader } from './source.js';
import { warmStream } from './warm.js';

interface Scope {
  onmessage: ((event: { data: ToWorker }) => void) | null;
  postMessage(message: FromWorker, transfer?: Transferable[]): void;
}
const scope = globalThis as unknown as Scope;

interface Open {
  clip: Clip;
  reader: SourceReader;
  received: number;
}

let module: WebAssembly.Module;
const clips = new Map<number, Open>();
// An instance whose clip was closed serves the next, so that memories do not pile up until they are collected.
let idle: SacInstance | undefined;

/** Decodes a small stream, which has the browser compile the functions with all its optimizations. */
function warmUp(): void {
  const decoder = new SacDecoder(module);
  const stream = warmStream();
  for (let round = 0; round < 5; ++round) {
    for (let rest = stream; rest.length > 0;) {
      rest = rest.subarray(decoder.send(rest));
      const mesh = decoder.mesh();
      if (!mesh) continue;
      const buffers = { positions: new Float32Array(3 * mesh.vertices), normals: new Int16Array(4 * mesh.vertices) };
      while (decoder.receive(buffers)) { /* the frames are of no use */ }
    }
    decoder.reset();
  }
  idle = decoder.close() ?? undefined;
}

function open(message: Extract<ToWorker, { type: 'open' }>): void {
  const { id } = message;
  const reader = new SourceReader(message.source);
  const instance = idle;
  idle = undefined;
  try {
    const clip: Clip = new Clip(module, reader, message.options, {
      mesh: (mesh, about) => scope.postMessage({ type: 'mesh', id, mesh, about }),
      shape: (shape) => scope.postMessage(
        { type: 'shape', id, shape, memory: clip.memoryBytes, loaded: reader.store.loaded },
        [shape.buffers.positions.buffer, shape.buffers.normals.buffer]),
      length: (frames) => scope.postMessage({ type: 'length', id, frames, bytes: reader.store.length ?? reader.store.loaded }),
      end: (epoch, travel) => scope.postMessage({ type: 'end', id, epoch, travel }),
      error: ({ code, message }) => scope.postMessage({ type: 'error', id, code, message }),
    }, instance);
    clips.set(id, { clip, reader, received: 0 });
    reader.start();
  } catch (error) {
    const { code, message } = toSacError(error);
    scope.postMessage({ type: 'error', id, code, message });
  }
}

function take(message: Extract<ToWorker, { type: 'chunk' }>): void {
  const entry = clips.get(message.id);
  if (!entry) return;
  const { store } = entry.reader;
  if (message.error !== undefined) return store.fail(toSacError(new Error(message.error)));
  if (message.bytes === null) return store.end(entry.received);
  store.put(entry.received, message.bytes);
  entry.received += message.bytes.length;
}

scope.onmessage = ({ data: message }) => {
  switch (message.type) {
    case 'init':
      module = message.module;
      if (message.warm) warmUp();
      return scope.postMessage({ type: 'ready' });
    case 'open':
      return open(message);
    case 'chunk':
      return take(message);
    case 'play':
      return clips.get(message.id)?.clip.play(message.run);
    case 'credit':
      return clips.get(message.id)?.clip.credit(message.buffers, message.epoch, message.wanted);
    case 'close': {
      const instance = clips.get(message.id)?.clip.close();
      clips.delete(message.id);
      idle ??= instance ?? undefined;
      return scope.postMessage({ type: 'closed', id: message.id });
    }
  }
};
