// SPDX-License-Identifier: Apache-2.0
// The decoder itself, which pages leave to workers, is in core.ts.
export type { SacBox, SacDecoderOptions, SacLimits } from './decoder.js';
export {
  SacArgumentError, SacCorruptError, SacError, SacLimitError, SacNetworkError, SacUnsupportedError, type SacErrorCode,
} from './errors.js';
export { SacLoader, type SacInput } from './loader.js';
export { SacMesh, type SacMeshEventMap, type SacOptions, type SacStats } from './mesh.js';
export type { MediaClock } from './timeline.js';
