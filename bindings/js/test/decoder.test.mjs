// SPDX-License-Identifier: Apache-2.0
// The core in Node.js: all vectors, errors by class, seeking, a lost instance.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { join } from 'node:path';
import { test } from 'node:test';
import { compileSac, SacArgumentError, SacCorruptError, SacDecoder, SacError, SacLimitError, SacUnsupportedError } from '../dist/core.js';
import { compare, decodeAll } from './conformance.mjs';
import { conformance, manifest, packageFolder, root, vector, wasm } from './files.mjs';

const module = await compileSac(wasm);
const classes = { corrupt: SacCorruptError, limit: SacLimitError, unsupported: SacUnsupportedError };
const pyramids = vector('valid/pyramids.sac');

test('every valid vector decodes as the manifest says', () => {
  assert.ok(manifest.valid.length >= 33);
  const decoder = new SacDecoder(module);
  for (const expected of manifest.valid) {
    const decoded = decodeAll(decoder, vector(expected.file));
    assert.deepEqual(compare(expected, decoded), [], expected.file);
    assert.equal(decoder.frames, expected.frames, expected.file);
    decoder.reset();
  }
});

test('a manifest that says otherwise is noticed', () => {
  const expected = structuredClone(manifest.valid.find((v) => v.file === 'valid/pyramids.sac'));
  const decoded = decodeAll(new SacDecoder(module), pyramids);
  expected.positions[3][2] += 1e-4;
  expected.triangles_crc32 = '00000000';
  assert.equal(compare(expected, decoded).length, 2);
});

test('every invalid vector is refused by its class', () => {
  assert.ok(manifest.invalid.length >= 149);
  const decoder = new SacDecoder(module);
  for (const { file, class: name } of manifest.invalid) {
    assert.throws(() => decodeAll(decoder, vector(file)), (error) => {
      assert.ok(error instanceof classes[name], `${file}: ${error}`);
      assert.ok(error.message.length > 0 && !error.message.includes('\n'), file);
      assert.equal(error.code, name);
      return true;
    }, file);
    decoder.reset();
  }
});

test('the cut of the bytes changes nothing', () => {
  const whole = decodeAll(new SacDecoder(module), pyramids);
  for (const chunk of [1, 7]) {
    const cut = decodeAll(new SacDecoder(module), pyramids, chunk);
    assert.equal(cut.frames.length, whole.frames.length);
    whole.frames.forEach((f, i) => assert.deepEqual(cut.frames[i].positions, f.positions));
  }
});

test('a truncated stream is told as one', () => {
  const decoder = new SacDecoder(module);
  assert.throws(() => decodeAll(decoder, pyramids.subarray(0, 900)), SacCorruptError);
});

test('seeking and interpolation agree with straight decoding', () => {
  const { frames } = decodeAll(new SacDecoder(module), pyramids);
  const decoder = new SacDecoder(module);
  assert.equal(decoder.seek(0), null);
  decodeAll(decoder, pyramids);
  const positions = new Float32Array(frames[0].positions.length);
  const feed = (from, get) => {
    for (let rest = pyramids.subarray(from); ;) {
      const info = get();
      if (info) return info;
      assert.ok(rest.length > 0);
      rest = rest.subarray(decoder.send(rest));
    }
  };
  for (const frame of [44, 0, 17, 18, 3]) {
    const info = feed(decoder.seek(frame), () => decoder.receive({ positions }));
    assert.equal(info.index, frame);
    assert.deepEqual(positions, frames[frame].positions);
  }
  const byte = decoder.seek(20);
  feed(byte, () => decoder.interpolate(20.5, { positions }));
  const between = (a, x, b) => x >= Math.min(a, b) - 0.05 && x <= Math.max(a, b) + 0.05;
  assert.ok(positions.every((x, i) => between(frames[20].positions[i], x, frames[21].positions[i])));
  assert.notDeepEqual(positions, frames[20].positions);
  assert.throws(() => decoder.seek(45), SacArgumentError);
  assert.throws(() => decoder.seek(-1), SacArgumentError);
  assert.throws(() => decoder.seekTime(0.25), /no frame rate/);
  const rows = new SacDecoder(module);
  const timed = decodeAll(rows, vector('valid/rows.sac'));
  assert.equal(timed.mesh.frameRate, 25);
  for (let rest = vector('valid/rows.sac').subarray(rows.seekTime(0.05)), info; !info;) {
    rest = rest.subarray(rows.send(rest));
    info = rows.receive();
    if (info) assert.equal(info.index, 1);
  }
});

test('an index tells of groups that have not come', () => {
  const decoder = new SacDecoder(module);
  let at = 0;
  while (!decoder.mesh()) at += decoder.send(pyramids.subarray(at, at + 64));
  assert.equal(decoder.frames, undefined);
  let size = 8;
  for (let needed; (needed = decoder.addIndex(pyramids.subarray(pyramids.length - size))) > 0;) size = needed;
  assert.equal(decoder.frames, 45);
  const byte = decoder.seek(40);
  assert.ok(byte > at && byte < pyramids.length);
  assert.throws(() => new SacDecoder(module).addIndex(new Uint8Array(8)), SacError);
});

test('buffers of other formats', () => {
  const decoder = new SacDecoder(module);
  const { mesh, frames } = decodeAll(decoder, pyramids);
  decoder.reset();
  const positions = new Uint16Array(3 * mesh.vertices), normals = new Int16Array(4 * mesh.vertices);
  let info = null;
  for (let rest = pyramids; !info;) {
    rest = rest.subarray(decoder.send(rest));
    info = decoder.receive({ positions, normals });
  }
  for (let i = 0; i < positions.length; ++i) {
    const k = i % 3, { low, high } = info.box;
    const x = low[k] + ((high[k] - low[k]) * positions[i]) / 65535;
    assert.ok(Math.abs(x - frames[0].positions[i]) <= (high[k] - low[k]) / 65535);
    assert.ok(Math.abs(normals[4 * ((i - k) / 3) + k] / 32767 - frames[0].normals[i]) < 1e-4);
  }
});

test('layers: as many as are asked for', () => {
  const bytes = vector('valid/layers.sac');
  const all = decodeAll(new SacDecoder(module), bytes).frames;
  const off = [1, 2, 99].map((layers) => {
    const { frames } = decodeAll(new SacDecoder(module, { layers }), bytes);
    assert.equal(frames.length, all.length);
    return frames.reduce((sum, f, i) => sum + f.positions.reduce((s, x, k) => s + Math.abs(x - all[i].positions[k]), 0), 0);
  });
  assert.ok(off[0] > off[1] && off[1] >= 0 && off[2] === 0, String(off));
  const counted = new SacDecoder(module);
  assert.equal(counted.layers, 0);
  decodeAll(counted, bytes);
  assert.ok(counted.layers >= 3, String(counted.layers));
  assert.throws(() => new SacDecoder(module, { layers: 0 }), SacArgumentError);
});

test('damage is left out where that is asked for', () => {
  const damaged = vector('valid/pyramids.sac');
  damaged[1000] ^= 0x55;
  assert.throws(() => decodeAll(new SacDecoder(module), damaged), SacCorruptError);
  const decoder = new SacDecoder(module, { skipDamage: true });
  let frames = 0;
  const drain = () => { while (decoder.receive()) ++frames; };
  for (let rest = damaged; rest.length > 0;) {
    rest = rest.subarray(decoder.send(rest));
    drain();
  }
  decoder.finish();
  drain();
  const lost = decoder.lostFrames.reduce((sum, { count }) => sum + count, 0);
  assert.ok(lost > 0 && frames + lost === 45, `${frames} frames, ${lost} lost`);
});

test('limits are kept, and options that cannot be used are refused', () => {
  for (const limits of [{ vertices: 10 }, { memory: 1000 }, { work: 10 }]) {
    assert.throws(() => decodeAll(new SacDecoder(module, { limits }), pyramids), SacLimitError);
  }
  assert.throws(() => new SacDecoder(module, { limits: { memory: -1 } }), SacArgumentError);
  assert.throws(() => new SacDecoder(module, { frameStep: 0 }), SacArgumentError);
  const every = new SacDecoder(module, { frameStep: 5 });
  let count = 0;
  for (let rest = pyramids; rest.length > 0;) {
    rest = rest.subarray(every.send(rest));
    while (every.receive()) ++count;
  }
  assert.equal(count, 9);
});

test('an instance that ran out of memory is replaced', () => {
  const decoder = new SacDecoder(module);
  // Memory that somebody holds, so that the decoder finds none.
  const instance = decoder.instance;
  for (let size = 2 ** 30; size > 1000; size /= 2) {
    while (instance.call('malloc', size) !== 0) { /* take it all */ }
  }
  assert.throws(() => decodeAll(decoder, pyramids), SacLimitError);
  assert.throws(() => decoder.send(pyramids), SacLimitError);
  decoder.reset();
  assert.equal(decodeAll(decoder, pyramids).frames.length, 45);
});

test('a closed decoder says so', () => {
  const decoder = new SacDecoder(module);
  const instance = decoder.close();
  assert.throws(() => decoder.receive(), SacArgumentError);
  assert.equal(decodeAll(new SacDecoder(module, {}, instance), pyramids).frames.length, 45);
  const { library, stream } = SacDecoder.versions(module);
  assert.match(library, /^\d+\.\d+\.\d+$/);
  assert.match(stream, /^\d+\.\d+$/);
});

test('integers of all vectors are those of the manifest', () => {
  const tools = join(packageFolder, 'wasm/tools/run.mjs');
  const program = join(root, 'build/wasm/bindings/js/wasm/coefficients.wasm');
  const files = manifest.valid.map((v) => v.file);
  const printed = execFileSync(process.execPath, ['--no-warnings', tools, program, ...files], { cwd: conformance });
  const lines = printed.toString().trim().split('\n').map((line) => line.trim());
  assert.deepEqual(lines, manifest.valid.map((v) => `${v.file} ${v.coefficients_crc32}`));
});
