// SPDX-License-Identifier: Apache-2.0
// Writes glTF files that use much of the format, the same shapes in several forms.
// usage: node make_gltf.mjs DIRECTORY
//   plain.gltf   everything as it is, buffers beside it; skin, morph targets, sparse accessors, two scenes and animations
//   plain.glb    the same in one file
//   draco.glb    its meshes without targets by Draco
import fs from 'node:fs';
import path from 'node:path';
import draco3d from 'draco3d';

const directory = process.argv[2];
const SHORT = 5122, UNSIGNED_BYTE = 5121, UNSIGNED_SHORT = 5123, UNSIGNED_INT = 5125, FLOAT = 5126;
const ARRAYS = { [SHORT]: Int16Array, [UNSIGNED_BYTE]: Uint8Array, [UNSIGNED_SHORT]: Uint16Array,
  [UNSIGNED_INT]: Uint32Array, [FLOAT]: Float32Array };
const COMPONENTS = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4, MAT4: 16 };

const json = { asset: { version: '2.0', generator: 'make_gltf.mjs' }, scene: 0, accessors: [], bufferViews: [],
  extensionsUsed: ['KHR_mesh_quantization'], extensionsRequired: ['KHR_mesh_quantization'] };
const chunks = [];
let bytes = 0;

function view(array, options = {}) {
  const data = Buffer.from(array.buffer, array.byteOffset, array.byteLength);
  json.bufferViews.push({ buffer: 0, byteOffset: bytes, byteLength: data.length, ...options });
  const padded = Buffer.alloc(Math.ceil(data.length / 4) * 4);
  data.copy(padded);
  chunks.push(padded);
  bytes += padded.length;
  return json.bufferViews.length - 1;
}

function accessor(type, componentType, values, options = {}) {
  const array = ARRAYS[componentType].from(values);
  const n = COMPONENTS[type];
  const bounds = (f) => Array.from({ length: n }, (_, k) => array.filter((_, i) => i % n === k).reduce((a, b) => f(a, b)));
  json.accessors.push({ bufferView: view(array), componentType, count: array.length / n, type, min: bounds(Math.min),
    max: bounds(Math.max), ...options });
  return json.accessors.length - 1;
}

// `base` is an accessor, or the number of values, which are zeros then.
function sparse(type, base, indices, values) {
  const of = typeof base === 'object' ? { bufferView: json.accessors[base.accessor].bufferView,
    count: json.accessors[base.accessor].count } : { count: base };
  const dense = json.accessors.length;
  json.accessors.push({ ...of, componentType: FLOAT, type, sparse: { count: indices.length,
    indices: { bufferView: view(Uint16Array.from(indices)), componentType: UNSIGNED_SHORT },
    values: { bufferView: view(Float32Array.from(values)) } } });
  return dense;
}

// A tube along y of `rings` rings of 12 vertices, as a strip or as triangles.
function tube(rings, height) {
  const positions = [], normals = [], uvs = [], joints = [], weights = [], indices = [];
  for (let r = 0; r < rings; ++r) {
    for (let s = 0; s < 12; ++s) {
      const angle = 2 * Math.PI * s / 12, y = height * r / (rings - 1), bone = Math.min(2 * r / (rings - 1), 1.999);
      positions.push(Math.cos(angle), y, Math.sin(angle));
      normals.push(Math.cos(angle), 0, Math.sin(angle));
      uvs.push(s / 12, r / rings);
      joints.push(Math.floor(bone), Math.floor(bone) + 1, 0, 0);
      weights.push(1 - bone % 1, bone % 1, 0, 0);
      if (r > 0) {
        const a = (r - 1) * 12 + s, b = (r - 1) * 12 + (s + 1) % 12;
        indices.push(a, a + 12, b, b, a + 12, b + 12);
      }
    }
  }
  return { positions, normals, uvs, joints, weights, indices };
}

const t = tube(9, 4);
const tubeMesh = { name: 'tube', primitives: [{ attributes: {
  POSITION: accessor('VEC3', FLOAT, t.positions), NORMAL: accessor('VEC3', FLOAT, t.normals),
  TEXCOORD_0: accessor('VEC2', FLOAT, t.uvs), JOINTS_0: accessor('VEC4', UNSIGNED_BYTE, t.joints),
  WEIGHTS_0: accessor('VEC4', FLOAT, t.weights) }, indices: accessor('SCALAR', UNSIGNED_SHORT, t.indices) }] };

// A fan of six triangles with two targets, one of them sparse, and positions that are sparse over others.
const fan = [0, 0, 1];
for (let i = 0; i <= 6; ++i) fan.push(Math.cos(i * Math.PI / 3), Math.sin(i * Math.PI / 3), 0);
const fanBase = accessor('VEC3', FLOAT, fan);
const fanPositions = sparse('VEC3', { accessor: fanBase }, [0, 3], [0, 0, 1.5, -0.5, 0.9, 0.1]);
const fanMesh = { name: 'fan', weights: [0.25, 0], primitives: [{ mode: 6, attributes: { POSITION: fanPositions },
  targets: [{ POSITION: accessor('VEC3', FLOAT, fan.map((x, i) => Math.sin(i) * 0.3)) },
    { POSITION: sparse('VEC3', 8, [1, 7], [0.5, 0.5, 0, -0.25, 0, 1]) }] }] };

// A strip on a grid of 16-bit and of normalized coordinates, and two primitives that share their vertices.
const strip = [];
for (let i = 0; i < 10; ++i) strip.push(100 * Math.floor(i / 2), 300 * (i % 2), (i * i) % 7, 0);
const stripView = view(Int16Array.from(strip), { byteStride: 8, target: 34962 });
json.accessors.push({ bufferView: stripView, componentType: SHORT, count: 10, type: 'VEC3', min: [0, 0, 0],
  max: [400, 300, 4] });
const stripMesh = { name: 'strip', primitives: [{ mode: 5, attributes: { POSITION: json.accessors.length - 1 } }] };
const square = { POSITION: -1 };
json.accessors.push({ bufferView: view(Uint16Array.from([0, 0, 0, 0, 65535, 0, 0, 0, 65535, 65535, 32768, 0, 0, 65535, 0, 0]),
  { byteStride: 8, target: 34962 }), componentType: UNSIGNED_SHORT, normalized: true, count: 4, type: 'VEC3',
min: [0, 0, 0], max: [65535, 65535, 32768] });
square.POSITION = json.accessors.length - 1;
const squareMesh = { name: 'square', primitives: [{ attributes: square, indices: accessor('SCALAR', UNSIGNED_BYTE, [0, 1, 2]) },
  { attributes: square, indices: accessor('SCALAR', UNSIGNED_BYTE, [0, 2, 3]) }] };

json.meshes = [tubeMesh, fanMesh, stripMesh, squareMesh];
const quarter = Math.SQRT1_2;
json.nodes = [
  { name: 'tube', mesh: 0, skin: 0, translation: [50, 60, 70] }, // which a skin ignores
  { name: 'hip', children: [2], translation: [0, 0.1, 0] },
  { name: 'knee', children: [3], translation: [0, 2, 0] },
  { name: 'foot', translation: [0, 2, 0] },
  { name: 'fan', mesh: 1, translation: [4, 0, 0], children: [5] },
  { name: 'strip', mesh: 2, scale: [-0.005, 0.005, 0.005], rotation: [0, quarter, 0, quarter] }, // mirrored
  { name: 'square', mesh: 3, matrix: [0, 2, 0, 0, -2, 0, 0, 0, 0, 0, 2, 0, -3, 1, 0, 1] },
  { name: 'other', mesh: 1 },
];
json.scenes = [{ name: 'main', nodes: [0, 1, 4, 6] }, { name: 'alone', nodes: [7] }];
const binds = [0, 1, 2].map((j) => [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -2 * j, 0, 1]).flat();
json.skins = [{ joints: [1, 2, 3], inverseBindMatrices: accessor('MAT4', FLOAT, binds) }];

const times = accessor('SCALAR', FLOAT, [0, 0.5, 1.25]), few = accessor('SCALAR', FLOAT, [0.25, 1]);
const turn = (x, y, z, angle) => [...[x, y, z].map((v) => v * Math.sin(angle / 2)), Math.cos(angle / 2)];
const channels = [], samplers = [];
function animate(node, path, type, componentType, input, values, interpolation, options = {}) {
  channels.push({ sampler: samplers.length, target: { node, path } });
  samplers.push({ input, output: accessor(type, componentType, values, options), ...(interpolation && { interpolation }) });
}
animate(2, 'rotation', 'VEC4', FLOAT, times, [turn(0, 0, 1, 0), turn(0, 0, 1, 1.2), turn(1, 0, 0, -0.7)].flat());
// The opposite of a quaternion is the same rotation: the shorter way must be taken.
animate(3, 'rotation', 'VEC4', SHORT, few, [turn(0, 1, 0, 0.5), turn(0, 1, 0, 1.5).map((x) => -x)].flat()
  .map((x) => Math.round(32767 * x)), 'LINEAR', { normalized: true });
animate(1, 'translation', 'VEC3', FLOAT, times, [0, 0, 0, 0, 0.1, 0, 1, 0, 0, 0, 2, 0, 1, 0.5, 0, -1, 0, 0,
  0, 1, 0, 0, 0, 0, 0, 0, 0], 'CUBICSPLINE');
animate(1, 'rotation', 'VEC4', FLOAT, few, [0, 0, 0, 0, ...turn(0, 1, 0, 0.3), 0, 0.4, 0, 0, 0.2, 0, 0, 0,
  ...turn(0, 1, 0, -0.9), 0, 0, 0, 0], 'CUBICSPLINE');
animate(4, 'scale', 'VEC3', FLOAT, times, [1, 1, 1, 2, 1, 1, 1, 3, 1], 'STEP');
animate(4, 'weights', 'SCALAR', FLOAT, times, [0, 0, 1, 0.5, 0.5, -1]);
const first = { name: 'move', channels: [...channels], samplers: [...samplers] };
channels.length = samplers.length = 0;
animate(7, 'weights', 'SCALAR', UNSIGNED_BYTE, few, [0, 255, 255, 51], 'LINEAR', { normalized: true });
json.animations = [first, { name: 'alone', channels, samplers }];

function glb(document, binary) {
  const text = Buffer.from(JSON.stringify(document)), padded = Buffer.alloc(Math.ceil(text.length / 4) * 4, ' ');
  text.copy(padded);
  const head = Buffer.alloc(20), second = Buffer.alloc(8);
  head.write('glTF', 'latin1');
  [2, 28 + padded.length + binary.length, padded.length, 0x4E4F534A].forEach((x, i) => head.writeUInt32LE(x, 4 + 4 * i));
  [binary.length, 0x004E4942].forEach((x, i) => second.writeUInt32LE(x, 4 * i));
  return Buffer.concat([head, padded, second, binary]);
}

fs.mkdirSync(directory, { recursive: true });
const write = (name, data) => fs.writeFileSync(path.join(directory, name), data);
const binary = Buffer.concat(chunks);
write('plain data.bin', binary);
write('plain.gltf', JSON.stringify({ ...json, buffers: [{ uri: 'plain%20data.bin', byteLength: binary.length }] }));
write('plain.glb', glb({ ...json, buffers: [{ byteLength: binary.length }] }, binary));

// Draco keeps the order of vertices when it encodes sequentially.
const draco = await draco3d.createEncoderModule();
const encoder = new draco.Encoder(), builder = new draco.MeshBuilder(), mesh = new draco.Mesh();
builder.AddFacesToMesh(mesh, t.indices.length / 3, Uint32Array.from(t.indices));
const count = t.positions.length / 3;
const attributes = {
  POSITION: builder.AddFloatAttributeToMesh(mesh, draco.POSITION, count, 3, Float32Array.from(t.positions)),
  NORMAL: builder.AddFloatAttributeToMesh(mesh, draco.NORMAL, count, 3, Float32Array.from(t.normals)),
  TEXCOORD_0: builder.AddFloatAttributeToMesh(mesh, draco.TEX_COORD, count, 2, Float32Array.from(t.uvs)),
  JOINTS_0: builder.AddUInt8Attribute(mesh, draco.GENERIC, count, 4, Uint8Array.from(t.joints)),
  WEIGHTS_0: builder.AddFloatAttributeToMesh(mesh, draco.GENERIC, count, 4, Float32Array.from(t.weights)),
};
encoder.SetEncodingMethod(draco.MESH_SEQUENTIAL_ENCODING);
encoder.SetAttributeQuantization(draco.POSITION, 20);
encoder.SetAttributeQuantization(draco.GENERIC, 20);
const encoded = new draco.DracoInt8Array();
const size = encoder.EncodeMeshToDracoBuffer(mesh, encoded);
const code = Int8Array.from({ length: size }, (_, i) => encoded.GetValue(i));
json.extensionsUsed.push('KHR_draco_mesh_compression');
json.extensionsRequired.push('KHR_draco_mesh_compression');
const bufferView = view(code);
tubeMesh.primitives[0].extensions = { KHR_draco_mesh_compression: { bufferView, attributes } };
for (const a of [...Object.values(tubeMesh.primitives[0].attributes), tubeMesh.primitives[0].indices]) {
  delete json.accessors[a].bufferView;
}
const all = Buffer.concat(chunks);
write('draco.glb', glb({ ...json, buffers: [{ byteLength: all.length }] }, all));
