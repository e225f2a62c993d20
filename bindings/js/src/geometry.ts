// SPDX-License-Identifier: Apache-2.0
import type { SacMeshData } from './decoder.js';

/**
 * A mesh as graphics hardware takes it: one index a corner. A vertex on a seam of the texture, or on a hard edge, is
 * there several times.
 */
export interface RenderMesh {
  /** How many there are. */
  vertices: number;
  /** 3 a triangle: indices of render vertices. */
  index: Uint32Array;
  /** Per render vertex the vertex of the stream; null when they are the same. */
  source: Uint32Array | null;
  /** Per render vertex the number of its normal, where corners have normals of their own; and how many those are. */
  normalSource: Uint32Array | null;
  normals: number;
  uvs: Float32Array | null;
  colors: Uint8Array | null;
}

/** Splits vertices where corners differ in texture coordinate or normal. */
export function makeRenderMesh(mesh: SacMeshData): RenderMesh {
  const { triangleVertices: corners, triangleUvs, triangleNormals } = mesh;
  if (!triangleUvs && !triangleNormals) {
    return { vertices: mesh.vertices, index: corners, source: null, normalSource: null, normals: 0,
      uvs: null, colors: mesh.colors };
  }
  // Render vertex v is the first corner of vertex v; those of further corners come after all of them. `next` chains the
  // render vertices of one vertex.
  const n = mesh.vertices;
  const next: number[] = new Array(n).fill(-1), source: number[] = Array.from({ length: n }, (_, v) => v);
  const uvOf: number[] = new Array(n).fill(-1), normalOf: number[] = new Array(n).fill(-1);
  // A stream may use one normal at many vertices. They part ways when the shape moves: each vertex has its own.
  const group: number[] = source.slice();
  let groups = n;
  const index = new Uint32Array(corners.length);
  for (let c = 0; c < corners.length; ++c) {
    const vertex = corners[c]!, uv = triangleUvs ? triangleUvs[c]! : 0, normal = triangleNormals ? triangleNormals[c]! : 0;
    let r = vertex;
    if (uvOf[r]! < 0) {
      uvOf[r] = uv;
      normalOf[r] = normal;
    }
    let same = -1;
    for (; r >= 0 && (uvOf[r] !== uv || normalOf[r] !== normal); r = next[r]!) if (normalOf[r] === normal) same = group[r]!;
    if (r < 0) {
      r = source.length;
      source.push(vertex);
      uvOf.push(uv);
      normalOf.push(normal);
      group.push(same >= 0 ? same : groups++);
      next.push(next[vertex]!);
      next[vertex] = r;
    }
    index[c] = r;
  }
  const map = Uint32Array.from(source), uvMap = Uint32Array.from(uvOf, (uv) => Math.max(uv, 0));
  return {
    vertices: map.length,
    index,
    source: map.length > n || triangleNormals ? map : null,
    normalSource: triangleNormals ? Uint32Array.from(group) : null,
    normals: groups,
    uvs: triangleUvs && mesh.uvs ? gather(mesh.uvs, uvMap, 2, new Float32Array(2 * map.length)) : null,
    colors: mesh.colors && gather(mesh.colors, map, 4, new Uint8Array(4 * map.length)),
  };
}

type Numbers = Float32Array | Int16Array | Uint8Array;

/** Sets the element i of `out` to the element map[i] of `from`, each of `width` numbers. */
export function gather<T extends Numbers>(from: Numbers, map: Uint32Array, width: number, out: T): T {
  for (let i = 0, to = 0; i < map.length; ++i) {
    for (let k = 0, at = map[i]! * width; k < width; ++k) out[to++] = from[at++]!;
  }
  return out;
}

/**
 * Normals of render vertices where corners have their own: triangles at a vertex that share a normal in the stream share
 * one here, the sum of theirs weighted by area, and edges between others stay hard. `positions` has 3 a render vertex,
 * `out` 4 of 16 bits.
 */
export class CornerNormals {
  private readonly sums: Float32Array;
  private readonly mesh: RenderMesh;

  constructor(mesh: RenderMesh) {
    this.mesh = mesh;
    this.sums = new Float32Array(3 * mesh.normals);
  }

  compute(positions: Float32Array, out: Int16Array): void {
    const { sums, mesh } = this;
    const { index } = mesh, of = mesh.normalSource!;
    sums.fill(0);
    for (let t = 0; t < index.length; t += 3) {
      const a = 3 * index[t]!, b = 3 * index[t + 1]!, c = 3 * index[t + 2]!;
      const ux = positions[b]! - positions[a]!, uy = positions[b + 1]! - positions[a + 1]!, uz = positions[b + 2]! - positions[a + 2]!;
      const vx = positions[c]! - positions[a]!, vy = positions[c + 1]! - positions[a + 1]!, vz = positions[c + 2]! - positions[a + 2]!;
      const x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
      for (let k = 0; k < 3; ++k) {
        const n = 3 * of[index[t + k]!]!;
        sums[n] = sums[n]! + x;
        sums[n + 1] = sums[n + 1]! + y;
        sums[n + 2] = sums[n + 2]! + z;
      }
    }
    for (let v = 0; v < mesh.vertices; ++v) {
      const n = 3 * of[v]!;
      const length = Math.hypot(sums[n]!, sums[n + 1]!, sums[n + 2]!);
      const scale = length > 0 ? 32767 / length : 0;
      out[4 * v] = Math.round(sums[n]! * scale);
      out[4 * v + 1] = Math.round(sums[n + 1]! * scale);
      out[4 * v + 2] = length > 0 ? Math.round(sums[n + 2]! * scale) : 32767;
    }
  }
}
