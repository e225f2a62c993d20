// SPDX-License-Identifier: Apache-2.0
// What a worker does with a clip: order of shapes, loops, seeks, turns of direction, credit, sources of bytes.
import assert from 'node:assert/strict';
import { createServer } from 'node:http';
import { after, test } from 'node:test';
import { compileSac, SacDecoder } from '../dist/core.js';
import { Clip, SourceReader } from '../dist/testing.js';
import { decodeAll } from './conformance.mjs';
import { manifest, vector, wasm } from './files.mjs';

const module = await compileSac(wasm);

// The clips' own channel does not keep Node.js alive.
const alive = setInterval(() => undefined, 1000);
after(() => clearInterval(alive));

/** A clip whose shapes are collected; copies are kept and buffers given back at once unless `hold`. */
function open(source, { ahead = 4, hold = false, detour = undefined } = {}) {
  const seen = { shapes: [], frames: undefined, ended: null, error: null, mesh: null, meshes: 0 };
  const waiting = [];
  const told = () => waiting.splice(0).forEach((f) => f());
  const reader = new SourceReader(source, detour);
  const clip = new Clip(module, reader, { ahead }, {
    mesh: (mesh, about) => { seen.mesh = mesh; seen.about = about; seen.meshes += 1; told(); },
    shape: (shape) => {
      seen.shapes.push({ ...shape, mesh: seen.mesh, positions: shape.buffers.positions.slice(), normals: shape.buffers.normals.slice() });
      if (!hold) clip.credit([shape.buffers], shape.epoch, 0);
      told();
    },
    length: (frames) => { seen.frames = frames; told(); },
    end: (epoch, travel) => { seen.ended = { epoch, travel }; told(); },
    error: (error) => { seen.error = error; told(); },
  });
  reader.start();
  const until = async (condition) => {
    while (!condition()) {
      if (seen.error) throw seen.error;
      await new Promise((resolve) => waiting.push(resolve));
    }
  };
  const play = async (run, count) => {
    seen.shapes = [];
    seen.ended = null;
    clip.play({ epoch: 1, start: 0, direction: 1, step: 1, loop: true, ...run });
    await until(() => seen.shapes.length >= count || seen.ended);
    return seen.shapes.slice(0, count);
  };
  return { clip, reader, seen, until, play };
}

const blob = (bytes) => ({ kind: 'blob', blob: new Blob([bytes]) });
const numbers = (shapes) => shapes.map((s) => s.frame);
const range = (from, to) => Array.from({ length: Math.abs(to - from) }, (_, i) => from + Math.sign(to - from) * i);

for (const file of ['pyramids', 'previous', 'groups_of_one', 'low_delay_previous', 'repeated_start']) {
  test(`${file}: forward, over the loop, backward and from the middle as straight decoding`, async () => {
    const bytes = vector(`valid/${file}.sac`);
    const { frames } = decodeAll(new SacDecoder(module), bytes);
    const n = frames.length;
    const { clip, seen, play } = open(blob(bytes));
    const check = (shapes, expected) => {
      assert.deepEqual(numbers(shapes), expected);
      for (const s of shapes) assert.deepEqual(s.positions, frames[s.frame].positions, `frame ${s.frame}`);
      assert.deepEqual(shapes.map((s) => s.travel), range(0, shapes.length));
    };
    check(await play({ epoch: 1 }, 2 * n + 2), [...range(0, n), ...range(0, n), 0, 1]);
    assert.equal(seen.frames, n);
    check(await play({ epoch: 2, start: n - 1, direction: -1 }, n + 2), [...range(n - 1, -1), n - 1, n - 2]);
    const middle = Math.floor(n / 2);
    check(await play({ epoch: 3, start: middle }, 3), [0, 1, 2].map((i) => (middle + i) % n));
    assert.ok(seen.shapes.every((s) => s.epoch === 3));
    clip.close();
  });
}

test('a run without loop ends at the last frame, in both directions', async () => {
  const { clip, seen, play } = open(blob(vector('valid/pyramids.sac')));
  assert.deepEqual(numbers(await play({ loop: false, start: 40 }, 99)), range(40, 45));
  assert.deepEqual(seen.ended, { epoch: 1, travel: 4 });
  assert.deepEqual(numbers(await play({ epoch: 2, loop: false, start: 3, direction: -1 }, 99)), [3, 2, 1, 0]);
  assert.deepEqual(seen.ended, { epoch: 2, travel: 3 });
  clip.close();
});

test('steps of several frames and of half a frame', async () => {
  const { clip, play } = open(blob(vector('valid/pyramids.sac')));
  assert.deepEqual(numbers(await play({ step: 4 }, 14)), [...range(0, 12).map((i) => 4 * i), 3, 7]);
  const halves = await play({ epoch: 2, step: 0.5, start: 43 }, 6);
  assert.deepEqual(numbers(halves), [43, 43.5, 44, 44.5, 0, 0.5]);
  assert.notDeepEqual(halves[1].positions, halves[0].positions);
  assert.deepEqual(halves[3].positions, halves[2].positions);  // the last frame is held for its time
  assert.deepEqual(numbers(await play({ epoch: 3, step: 0.5, start: 1, direction: -1 }, 4)), [1, 0.5, 0, 44.5]);
  clip.close();
});

test('no more shapes than there are buffers', async () => {
  const { clip, seen, until } = open(blob(vector('valid/pyramids.sac')), { hold: true, ahead: 5 });
  clip.play({ epoch: 1, start: 0, direction: 1, step: 1, loop: true });
  await until(() => seen.shapes.length === 5);
  await new Promise((resolve) => setTimeout(resolve, 50));
  assert.equal(seen.shapes.length, 5);
  clip.credit(seen.shapes.slice(0, 2).map((s) => s.buffers), 1, 0);
  await until(() => seen.shapes.length === 7);
  // What comes too late is left out.
  clip.credit([seen.shapes[2].buffers], 1, 30);
  await until(() => seen.shapes.length === 8);
  assert.equal(seen.shapes[7].travel, 30);
  clip.close();
});

test('seams and hard edges become render vertices', async () => {
  const split = [];
  for (const file of ['seam', 'odd', 'hard_edges', 'odd_hard', 'pyramids']) {
    const bytes = vector(`valid/${file}.sac`);
    const { mesh, frames } = decodeAll(new SacDecoder(module), bytes);
    const { clip, seen, play } = open(blob(bytes));
    const [shape] = await play({}, 1);
    const corners = new Set([...mesh.triangleVertices].map((v, c) => `${v} ${mesh.triangleUvs?.[c]} ${mesh.triangleNormals?.[c]}`));
    const unused = mesh.vertices - new Set(mesh.triangleVertices).size;
    assert.equal(seen.mesh.vertices, corners.size + unused, file);
    if (seen.mesh.vertices > mesh.vertices) split.push(file);
    seen.mesh.index.forEach((r, corner) => {
      const v = mesh.triangleVertices[corner];
      for (let k = 0; k < 3; ++k) assert.equal(shape.positions[3 * r + k], frames[0].positions[3 * v + k]);
      if (mesh.triangleUvs) assert.equal(seen.mesh.uvs[2 * r], mesh.uvs[2 * mesh.triangleUvs[corner]]);
    });
    clip.close();
  }
  assert.ok(split.length >= 2 && split.length < 5, split.join(' '));
});

test('the normals of a cube with hard edges are its faces\'', async () => {
  const bytes = vector('valid/hard_edges.sac');
  const { clip, seen, play } = open(blob(bytes));
  for (const shape of await play({}, 3)) {
    const { index } = seen.mesh;
    for (let t = 0; t < index.length; t += 3) {
      const p = [0, 1, 2].map((k) => [...shape.positions.subarray(3 * index[t + k], 3 * index[t + k] + 3)]);
      const u = p[1].map((x, k) => x - p[0][k]), v = p[2].map((x, k) => x - p[0][k]);
      const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
      const length = Math.hypot(...n);
      for (const r of index.subarray(t, t + 3)) {
        const is = [...shape.normals.subarray(4 * r, 4 * r + 3)].map((x) => x / 32767);
        const cos = n.reduce((sum, x, k) => sum + (x / length) * is[k], 0);
        assert.ok(cos > 0.9, `cosine ${cos}`);
      }
    }
  }
  clip.close();
});

test('chunks as they come, and streams that break off', async () => {
  const bytes = vector('valid/pyramids.sac');
  const { clip, reader, play } = open({ kind: 'chunks' });
  const shapes = play({}, 50);
  for (let at = 0; at < bytes.length; at += 100) {
    reader.store.put(at, bytes.subarray(at, at + 100));
    await new Promise((resolve) => setTimeout(resolve, 1));
  }
  reader.store.end(bytes.length);
  assert.deepEqual(numbers(await shapes), [...range(0, 45), ...range(0, 5)]);
  clip.close();
  const cut = open(blob(bytes.subarray(0, 1200)));
  await assert.rejects(cut.play({}, 100), { name: 'SacCorruptError', code: 'corrupt' });
  const nothing = open(blob(new Uint8Array(0)));
  await assert.rejects(nothing.play({}, 1), { name: 'SacCorruptError' });
});

for (const { file, frames: n } of manifest.valid.filter((v) => v.segments)) {
  test(`${file}: another mesh from frame to frame, over the loop, backward and sought`, async () => {
    const bytes = vector(file);
    const straight = new SacDecoder(module);
    const { frames } = decodeAll(straight, bytes);
    const { clip, seen, play } = open(blob(bytes));
    const check = (shapes, expected) => {
      assert.deepEqual(numbers(shapes), expected);
      for (const s of shapes) {
        assert.deepEqual(s.positions, frames[s.frame].positions, `frame ${s.frame}`);
        assert.equal(s.mesh.vertices, frames[s.frame].positions.length / 3);
        assert.equal(s.normals.length, 4 * s.mesh.vertices);
        assert.ok(s.mesh.index.length > 0 && s.mesh.index.every((v) => v < s.mesh.vertices));
      }
    };
    check(await play({}, 2 * n + 1), [...range(0, n), ...range(0, n), 0]);
    check(await play({ epoch: 2, start: n - 1, direction: -1 }, n + 1), [...range(n - 1, -1), n - 1]);
    for (const start of [n - 1, 0, n - 2, 1]) {
      check(await play({ epoch: 3 + start, start }, 2), [start, (start + 1) % n]);
    }
    // Nothing lies between frames of two meshes: the one before is held.
    const halves = await play({ epoch: 90, step: 0.5 }, 2 * n);
    for (const s of halves) assert.equal(s.positions.length, frames[Math.floor(s.frame)].positions.length, `at ${s.frame}`);
    const change = frames.findIndex((f, i) => i > 0 && f.positions.length !== frames[i - 1].positions.length);
    if (change > 0) assert.deepEqual(halves[2 * change - 1].positions, frames[change - 1].positions);
    assert.ok(seen.meshes > 2);
    clip.close();
  });
}

test('a still comes with the mesh, before the first group', async () => {
  for (const file of ['pyramids', 'seam', 'hard_edges']) {
    const bytes = vector(`valid/${file}.sac`);
    const { frames, mesh } = decodeAll(new SacDecoder(module), bytes);
    const { clip, reader, seen, until } = open({ kind: 'chunks' });
    for (let at = 0; !seen.mesh; ++at) {
      assert.ok(at < bytes.length);
      reader.store.put(at, bytes.subarray(at, at + 1));
      await new Promise((resolve) => setImmediate(resolve));
    }
    await until(() => seen.mesh);
    assert.equal(seen.shapes.length, 0);
    const { still } = seen.about;
    assert.equal(still.positions.length, 3 * seen.mesh.vertices);
    const size = Math.hypot(...still.box.low.map((x, k) => still.box.high[k] - x));
    for (let r = 0; r < seen.mesh.vertices; ++r) {
      const v = seen.mesh.source?.[r] ?? r;
      const off = Math.hypot(...[0, 1, 2].map((k) => still.positions[3 * r + k] - frames[0].positions[3 * v + k]));
      assert.ok(off < 0.3 * size, `${file} vertex ${r}: ${off} of ${size}`);
      const length = Math.hypot(...still.normals.subarray(4 * r, 4 * r + 3)) / 32767;
      assert.ok(Math.abs(length - 1) < 1e-3, `${file} normal ${r}: ${length}`);
    }
    assert.ok(mesh.vertices > 0);
    clip.close();
  }
});

test('a late seek asks for the index and the part, not for what lies before', async () => {
  const bytes = vector('valid/pyramids.sac');
  const asked = [];
  const server = createServer((request, response) => {
    if (request.url === '/missing') return response.writeHead(404).end();
    const range = /bytes=(\d+)-(\d*)/.exec(request.headers.range ?? '');
    asked.push(request.headers.range ?? 'all');
    const from = range ? Number(range[1]) : 0, to = range?.[2] ? Number(range[2]) + 1 : bytes.length;
    response.writeHead(range ? 206 : 200, { 'accept-ranges': 'bytes', 'content-length': to - from });
    // The first request stalls after the first groups.
    if (!range) response.write(bytes.subarray(0, 1200));
    else response.end(bytes.subarray(from, to));
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  const url = `http://127.0.0.1:${server.address().port}`;
  try {
    const { frames } = decodeAll(new SacDecoder(module), bytes);
    const { clip, seen, play } = open({ kind: 'url', url: `${url}/clip.sac` }, { detour: 64 });
    await play({}, 1);
    assert.deepEqual(asked, ['all']);
    const shapes = await play({ epoch: 2, start: 40 }, 5);
    assert.deepEqual(numbers(shapes), range(40, 45));
    assert.equal(seen.frames, 45);
    assert.deepEqual(shapes[0].positions, frames[40].positions);
    assert.ok(asked.length > 1 && asked.slice(1).every((r) => r !== 'all'), asked.join(' '));
    clip.close();
    const missing = open({ kind: 'url', url: `${url}/missing` });
    await assert.rejects(missing.play({}, 1), { name: 'SacNetworkError', message: /404/ });
  } finally {
    server.closeAllConnections();
    server.close();
  }
});
