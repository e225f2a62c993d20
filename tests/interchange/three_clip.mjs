// SPDX-License-Identifier: Apache-2.0
// Evaluates glTF files by three.js, without a browser.
import fs from 'node:fs';
import path from 'node:path';
import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { MeshoptDecoder } from 'three/addons/libs/meshopt_decoder.module.js';

// What three.js takes for granted of a browser.
globalThis.self ??= globalThis;
globalThis.ProgressEvent ??= class extends Event {};

// The JSON and the buffers, as data URIs, of a .gltf or .glb; without materials, whose images only browsers read.
export function readAsset(file) {
  const bytes = fs.readFileSync(file);
  let json, binary;
  if (bytes.toString('latin1', 0, 4) === 'glTF') {
    const size = bytes.readUInt32LE(12);
    json = JSON.parse(bytes.toString('utf8', 20, 20 + size));
    if (bytes.length > 28 + size) binary = bytes.subarray(28 + size, 28 + size + bytes.readUInt32LE(20 + size));
  } else {
    json = JSON.parse(bytes.toString('utf8'));
  }
  for (const buffer of json.buffers ?? []) {
    if (buffer.uri?.startsWith('data:')) continue;
    if (!buffer.uri && !binary) continue; // the fallback of a compressed buffer
    const data = buffer.uri ? fs.readFileSync(path.join(path.dirname(file), decodeURIComponent(buffer.uri))) : binary;
    buffer.uri = 'data:application/octet-stream;base64,' + data.toString('base64');
  }
  return json;
}

function withoutMaterials(json) {
  for (const mesh of json.meshes ?? []) for (const primitive of mesh.primitives) delete primitive.material;
  for (const key of ['materials', 'textures', 'images', 'samplers']) delete json[key];
  return json;
}

export async function loadClip(file) {
  await MeshoptDecoder.ready;
  const loader = new GLTFLoader();
  loader.setMeshoptDecoder(MeshoptDecoder);
  return loader.parseAsync(JSON.stringify(withoutMaterials(readAsset(file))), '');
}

// Triangles are drawn; each set of vertices counts once.
function meshesOf(scene) {
  const meshes = [];
  scene.traverse((object) => {
    if (!object.isMesh) return;
    const same = (other) => other.parent === object.parent &&
      other.geometry.attributes.position === object.geometry.attributes.position;
    if (!meshes.some(same)) meshes.push(object);
  });
  return meshes;
}

// The positions of all vertices, x, y, z each, at each of `times`, in seconds.
export function* evaluate(gltf, times, animation = 0, scene = undefined) {
  const root = scene === undefined ? gltf.scene : gltf.scenes[scene];
  const clip = gltf.animations[animation];
  const mixer = new THREE.AnimationMixer(root);
  const action = clip && mixer.clipAction(clip);
  const vertex = new THREE.Vector3();
  for (const time of times) {
    if (action) {
      action.reset();
      action.setLoop(THREE.LoopOnce);
      action.clampWhenFinished = true;
      action.play();
      mixer.setTime(time);
    }
    // Rotations of 16 bits have not quite the length 1, and three.js takes them as they are.
    root.traverse((object) => object.quaternion.normalize());
    root.updateMatrixWorld(true);
    const positions = [];
    for (const mesh of meshesOf(root)) {
      if (mesh.isSkinnedMesh) mesh.skeleton.update();
      for (let i = 0; i < mesh.geometry.attributes.position.count; ++i) {
        mesh.getVertexPosition(i, vertex).applyMatrix4(mesh.matrixWorld);
        positions.push(vertex.x, vertex.y, vertex.z);
      }
    }
    yield positions;
  }
}

// A PC2 file: { points, frames: [Float32Array] }.
export function readPc2(file) {
  const bytes = fs.readFileSync(file);
  if (bytes.toString('latin1', 0, 11) !== 'POINTCACHE2') throw new Error(`${file}: no PC2`);
  const points = bytes.readInt32LE(16), count = bytes.readInt32LE(28);
  const frames = [];
  for (let f = 0; f < count; ++f) {
    const frame = new Float32Array(3 * points);
    for (let i = 0; i < frame.length; ++i) frame[i] = bytes.readFloatLE(32 + 4 * (f * frame.length + i));
    frames.push(frame);
  }
  return { points, frames };
}
