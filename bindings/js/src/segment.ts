// SPDX-License-Identifier: Apache-2.0
import type { SacBox, SacFrameBuffers, SacMeshData } from './decoder.js';
import { CornerNormals, gather, makeRenderMesh, type RenderMesh } from './geometry.js';

/** A shape's arrays, 3 floats and 4 integers of 16 bits a render vertex. They circulate between page and worker. */
export interface ShapeBuffers {
  positions: Float32Array<ArrayBuffer>;
  normals: Int16Array<ArrayBuffer>;
}

/** A shape to be shown until the first frame is there. */
export interface Still extends ShapeBuffers {
  box: SacBox;
}

/** What a page is told of a mesh beside its triangles. */
export interface MeshAbout {
  /** In the stream; render vertices may be more. */
  vertices: number;
  frameRate: number | undefined;
  offset: [number, number, number];
  /** With the first mesh of a clip. */
  still: Still | null;
}

/** The mesh of a segment of the stream, and what it takes to make shapes of it. */
export class SegmentMesh {
  /** The segment's number; undefined where the stream does not count. */
  readonly number: number | undefined;
  readonly mesh: RenderMesh;
  readonly about: MeshAbout;
  private readonly cornerNormals: CornerNormals | null;
  // Of the stream's vertices, where render vertices are others.
  private readonly vertexPositions: Float32Array | null = null;
  private readonly vertexNormals: Int16Array | null = null;

  constructor(data: SacMeshData, number: number | undefined, still: Float32Array | null) {
    this.number = number;
    const mesh = (this.mesh = makeRenderMesh(data));
    if (mesh.source) {
      this.vertexPositions = new Float32Array(3 * data.vertices);
      this.vertexNormals = new Int16Array(4 * data.vertices);
    }
    this.cornerNormals = mesh.normalSource ? new CornerNormals(mesh) : null;
    const { vertices, frameRate, offset } = data;
    this.about = { vertices, frameRate, offset, still: still && this.makeStill(still, data) };
  }

  /** Gives `buffers` the size that a shape has, and returns the arrays that the decoder is to fill. */
  target(buffers: ShapeBuffers): SacFrameBuffers {
    const { vertices, source } = this.mesh;
    if (buffers.positions.length !== 3 * vertices) {
      buffers.positions = new Float32Array(3 * vertices);
      buffers.normals = new Int16Array(4 * vertices);
    }
    if (!source) return buffers;
    return { positions: this.vertexPositions, normals: this.cornerNormals ? null : this.vertexNormals };
  }

  /** Makes render vertices of what the decoder has filled. */
  complete(buffers: ShapeBuffers): void {
    const { source } = this.mesh;
    if (!source) return;
    gather(this.vertexPositions!, source, 3, buffers.positions);
    if (this.cornerNormals) this.cornerNormals.compute(buffers.positions, buffers.normals);
    else gather(this.vertexNormals!, source, 4, buffers.normals);
  }

  private makeStill(still: Float32Array, data: SacMeshData): Still {
    const { mesh } = this, n = mesh.vertices;
    const positions = mesh.source ? gather(still, mesh.source, 3, new Float32Array(3 * n)) : new Float32Array(still);
    const normals = new Int16Array(4 * n);
    const smooth = () => new CornerNormals({
      ...mesh, normalSource: mesh.source ?? Uint32Array.from({ length: n }, (_, v) => v), normals: data.vertices,
    });
    (this.cornerNormals ?? smooth()).compute(positions, normals);
    const box: SacBox = { low: [Infinity, Infinity, Infinity], high: [-Infinity, -Infinity, -Infinity] };
    for (let i = 0; i < positions.length; ++i) {
      box.low[i % 3] = Math.min(box.low[i % 3]!, positions[i]!);
      box.high[i % 3] = Math.max(box.high[i % 3]!, positions[i]!);
    }
    return { positions, normals, box };
  }
}
