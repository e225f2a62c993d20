// SPDX-License-Identifier: Apache-2.0
// What needs neither a browser nor three.js.
export { SacDecoder } from './decoder.js';
export type { SacBox, SacDecoderOptions, SacFrameBuffers, SacFrameInfo, SacLimits, SacMeshData } from './decoder.js';
export {
  SacArgumentError, SacCorruptError, SacError, SacLimitError, SacNetworkError, SacUnsupportedError,
} from './errors.js';
export type { SacErrorCode } from './errors.js';
export { compileSac, SacInstance } from './instance.js';
