// SPDX-License-Identifier: Apache-2.0
// Compares what a SacDecoder makes of a vector with the manifest. It runs in Node.js and in a browser.

const table = Uint32Array.from({ length: 256 }, (_, n) => {
  for (let k = 0; k < 8; ++k) n = n & 1 ? (n >>> 1) ^ 0xedb88320 : n >>> 1;
  return n >>> 0;
});

/** CRC-32 (spec.md 2.4) of numbers of 4 bytes, as the manifest writes it. */
export function crc32(words) {
  let crc = 0xffffffff;
  for (const byte of new Uint8Array(Uint32Array.from(words).buffer)) crc = (crc >>> 8) ^ table[(crc ^ byte) & 255];
  return ((crc ^ 0xffffffff) >>> 0).toString(16).padStart(8, '0');
}

/** Decodes a whole stream, `chunk` bytes at a time: the mesh and the positions of all frames. */
export function decodeAll(decoder, bytes, chunk = bytes.length) {
  const frames = [];
  for (let at = 0; at < bytes.length; at += chunk) {
    for (let rest = bytes.subarray(at, at + chunk); rest.length > 0;) {
      rest = rest.subarray(decoder.send(rest));
      const mesh = decoder.mesh();
      if (!mesh) continue;
      for (;;) {
        const positions = new Float32Array(3 * mesh.vertices), normals = new Float32Array(3 * mesh.vertices);
        const info = decoder.receive({ positions, normals });
        if (!info) break;
        frames.push({ info, positions, normals, segment: decoder.segment });
      }
    }
  }
  decoder.finish();
  return { mesh: decoder.mesh(), frames };
}

/** The half of the tolerance of spec.md 8: the decoder and the manifest each have one. */
function tolerance(positions) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  positions.forEach((x, i) => {
    low[i % 3] = Math.min(low[i % 3], x);
    high[i % 3] = Math.max(high[i % 3], x);
  });
  const diagonal = Math.hypot(...[0, 1, 2].map((k) => high[k] - low[k]));
  const greatest = positions.reduce((m, x) => Math.max(m, Math.abs(x)), 0);
  return 2e-6 * diagonal + 2e-7 * greatest + 1e-36;  // both round to binary32 at last
}

/** What differs from the manifest's entry `expected`; empty when nothing does. */
export function compare(expected, { mesh, frames }) {
  const complaints = [];
  const same = (what, is, shall) => {
    if (is !== shall) complaints.push(`${what} is ${is}, not ${shall}`);
  };
  same('frames', frames.length, expected.frames);
  same('vertices', mesh.vertices, expected.vertices);
  same('triangles', mesh.triangles, expected.triangles);
  same('triangles_crc32', crc32(mesh.triangleVertices), expected.triangles_crc32);
  same('uvs', mesh.uvs ? mesh.uvs.length / 2 : undefined, expected.uvs);
  same('uv_triangles_crc32', mesh.triangleUvs ? crc32(mesh.triangleUvs) : undefined, expected.uv_triangles_crc32);
  const normals = mesh.cornerNormals ?? mesh.normals;
  same('normals', normals ? normals.length / 3 : undefined, expected.normals);
  same('normal_triangles_crc32', mesh.triangleNormals ? crc32(mesh.triangleNormals) : undefined, expected.normal_triangles_crc32);
  same('colors_crc32', mesh.colors ? crc32(mesh.colors) : undefined, expected.colors_crc32);
  same('order_crc32', mesh.order ? crc32(mesh.order) : undefined, expected.order_crc32);
  same('offset', String(mesh.offset), String(expected.offset ?? [0, 0, 0]));
  const segments = [];
  for (const { info, positions, segment } of frames) if (segment === segments.length) segments.push([info.index, positions.length / 3]);
  same('segments', JSON.stringify(segments.length > 1 ? segments : undefined), JSON.stringify(expected.segments));
  const within = frames.length > 0 ? tolerance(frames[0].positions) : 0;
  let compared = 0;
  for (const [frame, v, ...point] of expected.positions) {
    for (let k = 0; k < 3; ++k) {
      const is = frames[frame]?.positions[3 * v + k];
      ++compared;
      if (!(Math.abs(is - point[k]) <= within)) complaints.push(`frame ${frame} vertex ${v}: ${is}, not ${point[k]}`);
    }
  }
  same('coordinates compared', compared, 3 * expected.positions.length);
  frames.forEach(({ info }, i) => same(`number of frame ${i}`, info.index, i));
  return complaints;
}
