// SPDX-License-Identifier: Apache-2.0
import type { Run, Shape } from './clip.js';
import type { SacDecoderOptions } from './decoder.js';
import type { SacErrorCode } from './errors.js';
import type { RenderMesh } from './geometry.js';
import type { MeshAbout, ShapeBuffers } from './segment.js';
import type { SacSource } from './source.js';

/** What the page tells a worker. `id` names a clip. */
export type ToWorker =
  | { type: 'init'; module: WebAssembly.Module; warm: boolean }
  | { type: 'open'; id: number; source: SacSource; options: SacDecoderOptions & { ahead: number } }
  | { type: 'chunk'; id: number; bytes: Uint8Array | null; error?: string }  // null: the end
  | { type: 'play'; id: number; run: Run }
  | { type: 'credit'; id: number; buffers: ShapeBuffers[]; epoch: number; wanted: number }
  | { type: 'close'; id: number };

/** What a worker tells the page. */
export type FromWorker =
  | { type: 'ready' }
  | { type: 'mesh'; id: number; mesh: RenderMesh; about: MeshAbout }
  | { type: 'shape'; id: number; shape: Shape; memory: number; loaded: number }
  | { type: 'length'; id: number; frames: number; bytes: number }
  | { type: 'end'; id: number; epoch: number; travel: number }
  | { type: 'error'; id: number; code: SacErrorCode; message: string }
  | { type: 'closed'; id: number };
