// SPDX-License-Identifier: Apache-2.0
// What tests in a browser work with: a stage, and what to look at on it.
import * as THREE from 'three';
import * as player from 'sac-player';
import * as core from '/dist/core.js';
import { compare, decodeAll } from '/test/conformance.mjs';

// The two have the same classes of errors, since they share their modules.
const sac = { ...core, ...player };
const renderer = new THREE.WebGLRenderer({ preserveDrawingBuffer: true });
renderer.setSize(300, 200);
renderer.shadowMap.enabled = true;
document.body.append(renderer.domElement);
const scene = new THREE.Scene();
scene.add(new THREE.AmbientLight(0xffffff, 3));
const camera = new THREE.PerspectiveCamera(40, 1.5, 0.01, 100);
const loader = new sac.SacLoader();

const until = async (condition, what = 'a condition') => {
  for (const end = performance.now() + 60000; !condition();) {
    if (performance.now() > end) throw new Error(`waited in vain for ${what}`);
    await new Promise((resolve) => setTimeout(resolve, 5));
  }
};
const look = (mesh) => {
  const { center, radius } = mesh.geometry.boundingSphere;
  camera.position.copy(center).add(new THREE.Vector3(0.3, 0.4, 1).normalize().multiplyScalar(3.4 * radius));
  camera.near = radius / 10;
  camera.far = 20 * radius;
  camera.lookAt(center);
  camera.updateProjectionMatrix();
};
/** The box of lit pixels and how many there are, of what is drawn now. */
const draw = () => {
  renderer.render(scene, camera);
  const gl = renderer.getContext(), w = gl.drawingBufferWidth, h = gl.drawingBufferHeight;
  const pixels = new Uint8Array(4 * w * h);
  gl.readPixels(0, 0, w, h, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  let count = 0, left = w, right = -1, low = h, high = -1;
  for (let y = 0; y < h; ++y) {
    for (let x = 0; x < w; ++x) {
      if (pixels[4 * (y * w + x)] + pixels[4 * (y * w + x) + 1] + pixels[4 * (y * w + x) + 2] === 0) continue;
      ++count;
      left = Math.min(left, x);
      right = Math.max(right, x);
      low = Math.min(low, y);
      high = Math.max(high, y);
    }
  }
  return { count, left, right, low, high };
};
/** The box in pixels into which the mesh's positions project. */
const project = (mesh) => {
  const box = { left: Infinity, right: -Infinity, low: Infinity, high: -Infinity };
  const p = new THREE.Vector3(), { position } = mesh.geometry.attributes;
  for (let v = 0; v < position.count; ++v) {
    p.fromBufferAttribute(position, v).project(camera);
    const x = (p.x + 1) * 150, y = (p.y + 1) * 100;
    box.left = Math.min(box.left, x);
    box.right = Math.max(box.right, x);
    box.low = Math.min(box.low, y);
    box.high = Math.max(box.high, y);
  }
  return box;
};
/** Seeks and waits until that shape is shown. */
const goTo = async (mesh, frame) => {
  mesh.pause();
  mesh.seek((frame + 1e-4) / mesh.frameRate);
  await until(() => (mesh.update(0), mesh.frame === frame), `frame ${frame}`);
};
/** Lets so many seconds pass in steps of a screen's, waiting for the worker; the frames that were shown. */
const pass = async (mesh, seconds, step = 1 / 60) => {
  const shown = [];
  for (let t = 0; t < seconds; t += step) {
    const { timeline } = mesh;
    await until(() => timeline.queue.length > 0 || timeline.ended || mesh.error, 'a shape');
    if (mesh.update(step)) shown.push(mesh.frame);
  }
  return shown;
};
const open = async (input, options = {}) => {
  const mesh = loader.open(input, options);
  mesh.autoUpdate = false;
  await mesh.ready;
  return mesh;
};
Object.assign(window, {
  THREE, sac, renderer, scene, camera, loader, until, look, draw, project, goTo, pass, open, compare, decodeAll, ready: true,
});
