// SPDX-License-Identifier: Apache-2.0
// Compares a USD file with a PC2 file of the same clip.
// usage: node compare_usd.mjs CLIP.usda FRAMES.pc2
// npm's tinyusdz gives meshes without a time alone. It therefore reads the file once as it is, and once for each frame
// with that frame's time sample in place of the value without a time.
import fs from 'node:fs';
import { createRequire } from 'node:module';
import path from 'node:path';
import { pathToFileURL } from 'node:url';
import { readPc2 } from './three_clip.mjs';

const [file, cache] = process.argv.slice(2);
const fail = (message) => { console.error(`${file}: ${message}`); process.exit(1); };
const { points, frames } = readPc2(cache);

// It is built for browsers.
globalThis.window ??= globalThis;
process.type ??= 'renderer';
const folder = path.dirname(createRequire(import.meta.url).resolve('tinyusdz/tinyusdz.js'));
const { default: createModule } = await import(pathToFileURL(path.join(folder, 'tinyusdz.js')));
const module = await createModule({ wasmBinary: fs.readFileSync(path.join(folder, 'tinyusdz.wasm')) });

function readMesh(text) {
  const usd = new module.TinyUSDZLoaderNative();
  if (!usd.loadFromBinary(new TextEncoder().encode(text), 'clip.usda')) fail(`tinyusdz cannot read it: ${usd.error()}`);
  if (usd.numMeshes() !== 1) fail(`${usd.numMeshes()} meshes`);
  return usd.getMesh(0);
}

function compare(mesh, frame, what) {
  // tinyusdz gives each corner a point of its own where it likes to.
  const want = new Set();
  const key = (p, i) => `${Math.fround(p[i])} ${Math.fround(p[i + 1])} ${Math.fround(p[i + 2])}`;
  for (let i = 0; i < frame.length; i += 3) want.add(key(frame, i));
  const got = new Set();
  for (let i = 0; i < mesh.points.length; i += 3) got.add(key(mesh.points, i));
  if (want.size !== got.size || [...want].some((p) => !got.has(p))) fail(`${what}: other points`);
}

const text = fs.readFileSync(file, 'utf8');
compare(readMesh(text), frames[0], 'without a time');
const samples = /point3f\[\] points\.timeSamples = \{\n([^}]*)\}/.exec(text)[1].trim().split('\n');
if (samples.length !== frames.length) fail(`${samples.length} time samples, not ${frames.length}`);
samples.forEach((sample, f) => {
  const [, time, list] = /^\s*(\S+): (\[.*\]),$/.exec(sample);
  if (Number(time) !== f) fail(`time ${time} of sample ${f}`);
  compare(readMesh(text.replace(/point3f\[\] points = \[.*\]/, `point3f[] points = ${list}`)
    .replace(/point3f\[\] points\.timeSamples = \{[^}]*\}/, '')), frames[f], `frame ${f}`);
});
console.log(`${frames.length} frames, ${points} vertices, equal`);
