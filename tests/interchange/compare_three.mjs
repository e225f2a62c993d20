// SPDX-License-Identifier: Apache-2.0
// Compares the frames of a PC2 file with those that three.js makes of a glTF file.
// usage: node compare_three.mjs CLIP.glb FRAMES.pc2 FPS LARGEST_ERROR [ANIMATION [SCENE]]
// LARGEST_ERROR is a fraction of the diagonal of all frames' bounding box. Prints the largest error; exit code 1 if
// numbers of frames or vertices differ or the error is larger.
import { evaluate, loadClip, readPc2 } from './three_clip.mjs';

const [file, cache, fps, bound, animation = '0', scene] = process.argv.slice(2);
const { points, frames } = readPc2(cache);
const gltf = await loadClip(file);
const fail = (message) => { console.error(`${file}: ${message}`); process.exit(1); };

const duration = gltf.animations[animation]?.duration ?? 0;
const expected = Math.floor(duration * fps + 1e-3) + 1;
if (frames.length !== expected) fail(`${frames.length} frames, three.js has ${expected}`);

const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
let worst = 0, f = 0;
for (const positions of evaluate(gltf, frames.map((_, i) => i / fps), Number(animation), scene && Number(scene))) {
  if (positions.length !== 3 * points) fail(`${points} vertices, three.js has ${positions.length / 3}`);
  for (let i = 0; i < positions.length; ++i) {
    low[i % 3] = Math.min(low[i % 3], positions[i]);
    high[i % 3] = Math.max(high[i % 3], positions[i]);
    worst = Math.max(worst, Math.abs(positions[i] - frames[f][i]));
    if (Number.isNaN(positions[i])) fail(`frame ${f}: NaN`);
  }
  ++f;
}
const diagonal = Math.hypot(...high.map((x, k) => x - low[k]));
console.log(`${frames.length} frames, ${points} vertices, largest error ${(worst / diagonal).toExponential(2)} diagonals`);
if (!(worst / diagonal <= Number(bound))) fail(`the error is larger than ${bound} diagonals`);
