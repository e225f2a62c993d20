// SPDX-License-Identifier: Apache-2.0
// SacLoader and SacMesh in Chromium. Time passes as the tests say, so that a slow machine changes nothing.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { compileSac, SacDecoder } from '../dist/core.js';
import { start } from './browser.mjs';
import { decodeAll } from './conformance.mjs';
import { root, wasm } from './files.mjs';

let tab, page;
before(async () => {
  tab = await start();
  page = await tab.open('/');
  await page.waitForFunction(() => window.ready);
});
after(() => tab.stop());

test('all vectors in the browser', async () => {
  const complaints = await page.evaluate(async () => {
    const module = await sac.compileSac('/dist/sac.wasm');
    const manifest = await (await fetch('/conformance/manifest.json')).json();
    const get = async (file) => new Uint8Array(await (await fetch(`/conformance/${file}`)).arrayBuffer());
    const complaints = [];
    const decoder = new sac.SacDecoder(module);
    for (const expected of manifest.valid) {
      complaints.push(...compare(expected, decodeAll(decoder, await get(expected.file))).map((c) => `${expected.file}: ${c}`));
      decoder.reset();
    }
    for (const { file, class: name } of manifest.invalid) {
      let code = 'none';
      try { decodeAll(decoder, await get(file)); } catch (error) { code = error instanceof sac.SacError ? error.code : String(error); }
      if (code !== name) complaints.push(`${file}: ${code}, not ${name}`);
      decoder.reset();
    }
    return complaints;
  });
  assert.deepEqual(complaints, []);
});

test('frames that are sought are those of the decoder, to the bit', async () => {
  const bytes = new Uint8Array(readFileSync(join(root, 'build/web/sphere.sac')));
  const { frames } = decodeAll(new SacDecoder(await compileSac(wasm)), bytes);
  const shown = await page.evaluate(async () => {
    const mesh = await open('/clips/sphere.sac', { interpolation: 'none' });
    const all = {};
    for (const frame of [0, 17, 39, 38, 5, 16]) {
      await goTo(mesh, frame);
      all[frame] = [...mesh.geometry.attributes.position.array];
    }
    mesh.dispose();
    return all;
  });
  for (const [frame, positions] of Object.entries(shown)) {
    assert.deepEqual(Float32Array.from(positions), frames[frame].positions, `frame ${frame}`);
  }
});

test('plays over the loop, backwards, fast, and ends', async () => {
  const log = await page.evaluate(async () => {
    const mesh = await open('/clips/sphere.sac');
    await until(() => mesh.frames, 'the length');
    const log = { duration: mesh.duration, rate: mesh.frameRate };
    mesh.play();
    log.forward = await pass(mesh, 3);
    mesh.playbackRate = -1;
    log.backward = await pass(mesh, 1.2);
    mesh.playbackRate = 1;
    mesh.loop = false;
    let ended = 0;
    mesh.addEventListener('ended', () => ++ended);
    mesh.seek(mesh.duration - 0.2);
    log.last = await pass(mesh, 1);
    log.ended = [ended, mesh.paused, mesh.ended];
    mesh.play();
    log.again = (await pass(mesh, 0.2)).slice(0, 2);
    mesh.dispose();
    return log;
  });
  const next = (list, by) => list.every((f, i) => i === 0 || f === (list[i - 1] + by + 40) % 40);
  assert.ok(Math.abs(log.duration - 40 / log.rate) < 1e-9);
  assert.ok(log.forward.length > 60 && next(log.forward, 1), log.forward.join(' '));
  assert.ok(log.backward.length > 20 && next(log.backward, -1), log.backward.join(' '));
  assert.equal(log.last.at(-1), 39);
  assert.deepEqual(log.ended, [1, true, true]);
  assert.deepEqual(log.again, [0, 1]);
});

test('what is drawn is where the positions say, between frames too', async () => {
  const results = await page.evaluate(async () => {
    const results = [];
    for (const clip of ['sphere', 'flag', 'walker']) {
      const mesh = await open(`/clips/${clip}.sac`);
      scene.add(mesh);
      mesh.material.side = THREE.DoubleSide;
      for (const frame of [0, 11]) {
        await goTo(mesh, frame);
        look(mesh);
        results.push({ clip, frame, lit: draw(), box: project(mesh) });
      }
      // Half way to the next frame, on the GPU and from the decoder.
      await until(() => mesh.timeline.queue.length > 0, 'the next shape');
      const a = mesh.geometry.attributes.position.array.slice();
      mesh.seek(11.5 / mesh.frameRate);
      await until(() => (mesh.update(0), mesh.uniforms.sacMix.value > 0.4), 'a blend');
      const b = mesh.geometry.attributes.sacNextPosition.array;
      const blended = draw();
      const between = mesh.geometry.attributes.position;
      const shown = between.array;
      between.array = a.map((x, i) => (x + b[i]) / 2);
      results.push({ clip, frame: 11.5, lit: blended, box: project(mesh), moved: a.some((x, i) => x !== b[i]) });
      between.array = shown;
      mesh.dispose();
    }
    return results;
  });
  for (const { clip, frame, lit, box, moved } of results) {
    const what = `${clip} ${frame}: ${JSON.stringify({ lit, box })}`;
    assert.ok(lit.count > 300, what);
    for (const side of ['left', 'low']) assert.ok(Math.abs(lit[side] - box[side]) < 2, what);
    for (const side of ['right', 'high']) assert.ok(Math.abs(lit[side] + 1 - box[side]) < 2, what);
    if (moved !== undefined) assert.ok(moved, what);
  }
});

test('rays, shadows and bounds are those of the shape', async () => {
  const found = await page.evaluate(async () => {
    const mesh = await open('/clips/sphere.sac', { interpolation: 'none' });
    await goTo(mesh, 20);
    const { center, radius } = mesh.geometry.boundingSphere;
    const ray = new THREE.Raycaster(center.clone().add(new THREE.Vector3(0, 0, 5 * radius)), new THREE.Vector3(0, 0, -1));
    const hits = ray.intersectObject(mesh);
    const inside = [...Array(mesh.geometry.attributes.position.count).keys()].every((v) =>
      mesh.geometry.boundingBox.clone().expandByScalar(1e-5).containsPoint(new THREE.Vector3().fromBufferAttribute(mesh.geometry.attributes.position, v)));
    // Another mesh in its shadow becomes darker.
    const sun = new THREE.DirectionalLight(0xffffff, 3);
    sun.position.copy(center).add(new THREE.Vector3(0, 4 * radius, 0));
    sun.target.position.copy(center);
    sun.castShadow = true;
    sun.shadow.camera.top = sun.shadow.camera.right = 2 * radius;
    sun.shadow.camera.bottom = sun.shadow.camera.left = -2 * radius;
    const floor = new THREE.Mesh(new THREE.PlaneGeometry(6 * radius, 6 * radius), new THREE.MeshLambertMaterial());
    floor.rotation.x = -Math.PI / 2;
    floor.position.copy(center).y -= 2 * radius;
    floor.receiveShadow = true;
    const stage = new THREE.Scene();
    stage.add(sun, sun.target, floor, mesh);
    const eye = new THREE.PerspectiveCamera(40, 1.5, 0.01, 100);
    eye.position.copy(center).add(new THREE.Vector3(0, -1.2 * radius, 0.01));
    eye.lookAt(floor.position);
    const bright = () => {
      renderer.render(stage, eye);
      const pixel = new Uint8Array(4), gl = renderer.getContext();
      gl.readPixels(150, 100, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
      return pixel[0];
    };
    mesh.castShadow = false;
    const light = bright();
    mesh.castShadow = true;
    const shade = bright();
    mesh.dispose();
    sun.dispose();
    return { hits: hits.length, distance: hits[0]?.distance / radius, inside, light, shade };
  });
  assert.ok(found.hits >= 1 && found.distance > 3.5 && found.distance < 5, JSON.stringify(found));
  assert.ok(found.inside);
  assert.ok(found.light > found.shade + 50, JSON.stringify(found));
});

test('errors are told by their class, and the next clip plays', async () => {
  const told = await page.evaluate(async () => {
    const told = [];
    const good = new Uint8Array(await (await fetch('/clips/sphere.sac')).arrayBuffer());
    const broken = good.slice();
    broken[good.length >> 1] ^= 0xff;
    for (const input of ['/missing.sac', new Blob(['not a stream']), good.slice(0, 700), new Uint8Array(0)]) {
      try { await loader.open(input).ready; told.push('nothing'); } catch (e) { told.push([e.name, e.code, e.message]); }
    }
    const damaged = loader.open(broken, { autoplay: true });
    damaged.autoUpdate = false;
    let event = null;
    damaged.addEventListener('error', (e) => (event = e.error));
    await until(() => (damaged.update(1 / 30), event), 'the damage');
    told.push([event.name, event.code, event.message]);
    const limited = loader.open(good, { limits: { vertices: 10 } });
    told.push(await limited.ready.catch((e) => [e.name, e.code, e.message]));
    try { await loader.loadAsync('/missing.sac'); } catch (e) { told.push([e.name, e.code, e.message]); }
    const mesh = await open(new Blob([good]));
    told.push(mesh.frame);
    for (const m of [damaged, limited, mesh]) m.dispose();
    return told;
  });
  assert.deepEqual(told.map((t) => t[1] ?? t),
    ['network', 'corrupt', 'corrupt', 'corrupt', 'corrupt', 'limit', 'network', 0], JSON.stringify(told));
  assert.match(told[0][2], /missing\.sac: HTTP status 404/);
  assert.ok(told.slice(0, 7).every((t) => t[2].length > 0));
  tab.errors.length = 0;  // the browser's own words about what is missing
});

test('bytes, streams of bytes and several clips at once', async () => {
  const frames = await page.evaluate(async () => {
    const bytes = new Uint8Array(await (await fetch('/clips/flag.sac')).arrayBuffer());
    const inputs = [bytes, bytes.buffer.slice(0), new Blob([bytes]).stream(), '/clips/flag.sac', new URL('/clips/sphere.sac', location.href)];
    const before = loader.counts.clips;
    const meshes = await Promise.all(inputs.map((input) => open(input)));
    const { workers } = loader.counts, clips = loader.counts.clips - before;
    const shown = [];
    for (const mesh of meshes) mesh.play();
    for (const mesh of meshes) shown.push((await pass(mesh, 0.5)).length);
    const same = meshes.slice(1, 4).every((m) => m.geometry.attributes.position.array.every((x, i) => x === meshes[0].geometry.attributes.position.array[i]));
    for (const mesh of meshes) mesh.dispose();
    return { shown, same, workers, clips };
  });
  assert.ok(frames.shown.every((n) => n >= 10), JSON.stringify(frames));
  assert.ok(frames.same);
  assert.equal(frames.clips, 5);
  assert.ok(frames.workers >= 1 && frames.workers <= 4);
});

test('another mesh from segment to segment, and memory of the GPU stays', async () => {
  const seen = await page.evaluate(async () => {
    const mesh = await open('/conformance/valid/segments.sac', { frameRate: 30, interpolation: 'linear' });
    await until(() => mesh.frames, 'the length');
    scene.add(mesh);
    mesh.material.side = THREE.DoubleSide;
    mesh.play();
    const shown = [];
    let meshes = 0, mixed = 0, after = null;
    mesh.addEventListener('mesh', () => ++meshes);
    for (let round = 0; round < 90; ++round) {
      await until(() => mesh.timeline.queue.length > 0 || mesh.error, 'a shape');
      if (mesh.error) throw mesh.error;
      mesh.update(1 / 60);
      renderer.render(scene, camera);
      const { position, normal, sacNextPosition } = mesh.geometry.attributes;
      shown.push([mesh.frame, position.count, normal.count, position.array.length / 3, Math.max(...mesh.geometry.index.array)]);
      // What is blended has the same vertices.
      if (mesh.uniforms.sacMix.value > 0) mixed += sacNextPosition.array.length === position.array.length ? 1 : NaN;
      if (round === 30) after = { ...renderer.info.memory };
    }
    const sought = [];
    for (const frame of [5, 0, 3, 4, 1]) {
      await goTo(mesh, frame);
      look(mesh);
      sought.push([frame, mesh.geometry.attributes.position.count, draw().count]);
    }
    const geometries = renderer.info.memory.geometries - after.geometries;
    mesh.dispose();
    return { shown, meshes, mixed, sought, geometries };
  });
  const vertices = [4, 4, 4, 5, 5, 4];
  for (const [frame, ...counts] of seen.shown) {
    assert.deepEqual(counts.slice(0, 3), Array(3).fill(vertices[frame]), JSON.stringify(seen.shown));
    assert.ok(counts[3] < vertices[frame]);
  }
  assert.deepEqual([...new Set(seen.shown.map(([frame]) => frame))].sort(), [0, 1, 2, 3, 4, 5]);
  assert.ok(seen.meshes >= 6 && seen.mixed > 0, JSON.stringify(seen));
  assert.equal(seen.geometries, 0);
  for (const [frame, count, lit] of seen.sought) assert.ok(count === vertices[frame] && lit > 50, JSON.stringify(seen.sought));
});

test('a still is shown before the first group has come', async () => {
  const seen = await page.evaluate(async () => {
    const bytes = new Uint8Array(await (await fetch('/conformance/valid/pyramids.sac')).arrayBuffer());
    let control;
    const mesh = loader.open(new ReadableStream({ start: (c) => (control = c) }));
    mesh.autoUpdate = false;
    const told = new Promise((resolve) => mesh.addEventListener('mesh', resolve));
    let sent = 0;
    const enough = told.then(() => true);
    while (!(await Promise.race([enough, new Promise((r) => setTimeout(r, 2, false))]))) {
      control.enqueue(bytes.slice(sent, sent + 32));
      sent += 32;
      if (sent > bytes.length) throw new Error('no still');
    }
    mesh.update(0);
    scene.add(mesh);
    look(mesh);
    const early = { frame: mesh.frame, shown: mesh.stats.shown, lit: draw().count, sent };
    control.enqueue(bytes.slice(sent));
    control.close();
    await mesh.ready;
    const late = { frame: mesh.frame, lit: draw().count };
    mesh.dispose();
    return { early, late, length: bytes.length };
  });
  const what = JSON.stringify(seen);
  assert.ok(seen.early.sent < seen.length && seen.early.shown === 0 && !(seen.early.frame >= 0), what);
  assert.ok(seen.early.lit > 100 && seen.late.frame === 0 && seen.late.lit > 100, what);
});

test('two hundred loads leave nothing behind', async () => {
  const counts = await page.evaluate(async () => {
    const bytes = new Uint8Array(await (await fetch('/conformance/valid/seam.sac')).arrayBuffer());
    const round = async () => {
      const mesh = await open(bytes);
      scene.add(mesh);
      mesh.play();
      mesh.update(0.04);
      renderer.render(scene, camera);
      mesh.dispose();
    };
    const measure = async () => {
      await new Promise((resolve) => setTimeout(resolve, 50));
      for (let i = 0; i < 3; ++i) gc();
      return { ...renderer.info.memory, programs: renderer.info.programs.length, heap: performance.memory.usedJSHeapSize, ...loader.counts };
    };
    for (let i = 0; i < 20; ++i) await round();
    const before = await measure();
    for (let i = 0; i < 200; ++i) await round();
    return { before, after: await measure() };
  });
  const { before, after } = counts;
  for (const key of ['geometries', 'textures', 'programs', 'clips', 'workers']) assert.equal(after[key], before[key], JSON.stringify(counts));
  assert.ok(after.heap - before.heap < 1e6, JSON.stringify(counts));
});

test('the page has no complaints', () => assert.deepEqual(tab.errors, []));
