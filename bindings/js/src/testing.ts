// SPDX-License-Identifier: Apache-2.0
// What tests look at beside the package's interface.
export { Clip } from './clip.js';
export { makeRenderMesh, CornerNormals } from './geometry.js';
export { SourceReader } from './source.js';
export { ByteStore } from './store.js';
export { Timeline } from './timeline.js';
