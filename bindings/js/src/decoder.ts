// SPDX-License-Identifier: Apache-2.0
import { makeError, SacArgumentError, type SacErrorCode } from './errors.js';
import { SacInstance } from './instance.js';
import {
  BUFFER, BUFFERS_SIZE, FORMAT, INFO, INFO_SIZE, MESH, NORMALS, SETTINGS, SETTINGS_SIZE, STATUS,
} from './layout.js';

/** What a stream may ask for (spec.md 9). A stream that asks for more is refused before anything is allocated. */
export interface SacLimits {
  vertices: number;
  triangles: number;
  /** Bytes of all that a decoder holds at a time, approximately. */
  memory: number;
  /** Multiplications for what is derived from the first frame, approximately. */
  work: number;
  /** Multiplications for a frame. */
  frameWork: number;
  harmonics: number;
  framesPerGroup: number;
  packetBytes: number;
}

export interface SacDecoderOptions {
  limits?: Partial<SacLimits>;
  /** Go on after damage at the next sound group; else an error is final. */
  skipDamage?: boolean;
  /** Receive only frames whose number is a multiple of this. */
  frameStep?: number;
  /** Layers of each group that are decoded, of streams that have some: fewer are coarser and take fewer bytes. */
  layers?: number;
}

/** What does not move. Arrays that the stream does not have are null. The arrays are the caller's own. */
export interface SacMeshData {
  vertices: number;
  triangles: number;
  /** Frames per second; undefined when the stream does not say. */
  frameRate: number | undefined;
  /** 3 a triangle. */
  triangleVertices: Uint32Array;
  /** 2 a texture coordinate, with (0, 0) at the lower left. */
  uvs: Float32Array | null;
  /** 3 a triangle: indices of texture coordinates. */
  triangleUvs: Uint32Array | null;
  /** 3 a vertex, of the first frame. */
  normals: Float32Array | null;
  /** 3 a normal, of the first frame, where corners have normals of their own; `triangleNormals` says whose. */
  cornerNormals: Float32Array | null;
  triangleNormals: Uint32Array | null;
  /** Red, green, blue, alpha of a vertex. */
  colors: Uint8Array | null;
  /** Per vertex its index in the encoder's input. */
  order: Uint32Array | null;
  /** What to add to all positions to have the author's coordinates. */
  offset: [number, number, number];
}

export interface SacBox {
  low: [number, number, number];
  high: [number, number, number];
}

export interface SacFrameInfo {
  /** In the clip, from 0. */
  index: number;
  /** The number of the segment whose mesh the frame has, from 0. */
  segment: number;
  /** Whether the frame needed no other. */
  intra: boolean;
  /** Seconds from the begin; 0 when the stream has no frame rate. */
  time: number;
  box: SacBox;
}

/** The caller's arrays. A length of 3 or 4 a vertex says how far apart vertices are. */
export interface SacFrameBuffers {
  /** Model units; as Uint16Array: low + (high - low) * x / 65535 of the frame's box. */
  positions?: Float32Array | Uint16Array | null;
  /** Of length 1; as Int16Array: x / 32767. */
  normals?: Float32Array | Int16Array | null;
}

const DEFAULT_MEMORY = 1.5 * 2 ** 30;  // of the 2 GiB that an instance may have
const CHUNK = 1 << 16;

const errorCodes: Record<number, SacErrorCode> = {
  [STATUS.invalidArgument]: 'invalid-argument',
  [STATUS.unsupported]: 'unsupported',
  [STATUS.corrupt]: 'corrupt',
  [STATUS.limit]: 'limit',
  [STATUS.cancelled]: 'cancelled',
};

/**
 * The decoder of a stream, as sac.h describes it: send bytes, receive frames. It needs no browser and is used by one
 * thread at a time. Every error is a SacError; after a SacLimitError for want of memory reset() gives a new instance.
 *
 *     const decoder = new SacDecoder(await compileSac(url));
 *     for (let rest = bytes; rest.length > 0;) {
 *       rest = rest.subarray(decoder.send(rest));
 *       while ((info = decoder.receive({ positions }))) show(info, positions);
 *     }
 *     decoder.finish();
 */
export class SacDecoder {
  private readonly module: WebAssembly.Module;
  private readonly options: SacDecoderOptions;
  private instance!: SacInstance;
  private decoder = 0;
  private scratch = 0;  // settings, or an info, buffers and a few numbers
  private chunk = 0;
  private frames_ = { positions: 0, positionBytes: 0, normals: 0, normalBytes: 0 };
  private mesh_: SacMeshData | null = null;
  private segment_ = -1;  // of mesh_

  constructor(module: WebAssembly.Module, options: SacDecoderOptions = {}, instance?: SacInstance) {
    this.module = module;
    this.options = options;
    this.open(instance && !instance.lost ? instance : new SacInstance(module));
  }

  /** The version of the library and that of the streams that it decodes. */
  static versions(module: WebAssembly.Module): { library: string; stream: string } {
    const instance = new SacInstance(module);
    return {
      library: instance.text(instance.call('sac_version')),
      stream: instance.text(instance.call('sac_stream_version')),
    };
  }

  /** Bytes of the instance's memory. */
  get memoryBytes(): number {
    return this.instance.memoryBytes;
  }

  /** Forgets everything but the options: another stream may begin. A lost instance is replaced. */
  reset(): void {
    this.mesh_ = null;
    if (this.instance.lost || this.decoder === 0) {
      this.open(new SacInstance(this.module));
    } else {
      this.releaseFrames();
      this.call('sac_decoder_reset');
    }
  }

  /** Frees what the decoder holds, and returns its instance for another decoder; null when it is lost. */
  close(): SacInstance | null {
    if (this.instance.lost || this.decoder === 0) return null;
    this.releaseFrames();
    this.instance.call('sac_decoder_close', this.decoder);
    this.instance.release(this.chunk);
    this.instance.release(this.scratch);
    this.decoder = 0;
    return this.instance;
  }

  /** Takes bytes from the front, at most until a packet is complete, and returns how many. Takes none while frames wait. */
  send(bytes: Uint8Array): number {
    const size = Math.min(bytes.length, CHUNK);
    const { instance, scratch } = this;
    instance.bytes(this.chunk, size).set(size === bytes.length ? bytes : bytes.subarray(0, size));
    const view = instance.view();
    view.setUint32(scratch, this.chunk, true);
    view.setUint32(scratch + 4, size, true);
    this.check(this.call('sac_decoder_send', scratch, scratch + 4));
    return size - instance.view().getUint32(scratch + 4, true);
  }

  /** The next frame; null when none is ready. */
  receive(buffers: SacFrameBuffers = {}): SacFrameInfo | null {
    const place = this.place(buffers);
    if (!this.check(this.call('sac_decoder_receive', place, this.scratch))) return null;
    return this.take(buffers);
  }

  /** The shape at a time between frames, in frames from the begin; null when bytes are missing. */
  interpolate(frameTime: number, buffers: SacFrameBuffers = {}): SacFrameInfo | null {
    const place = this.place(buffers);
    if (!this.check(this.call('sac_decoder_interpolate', frameTime, place, this.scratch))) return null;
    return this.take(buffers);
  }

  /** Declares the end of the bytes: a SacCorruptError when the stream is not complete. */
  finish(): void {
    this.check(this.call('sac_decoder_finish'));
  }

  /**
   * The triangles and attributes; null before they have been sent. In a stream of several segments these are of the
   * frames that receive() gives next.
   */
  mesh(): SacMeshData | null {
    const segment = this.segment ?? -1;
    if (segment !== this.segment_) this.mesh_ = null;
    this.segment_ = segment;
    return (this.mesh_ ??= this.readMesh());
  }

  /** The number of the segment whose mesh this is, from 0; undefined before it is known. */
  get segment(): number | undefined {
    return this.check(this.call('sac_decoder_segment', this.scratch))
      ? this.instance.view().getUint32(this.scratch, true) : undefined;
  }

  /** The shape that frames are measured from, near the first one, 3 a vertex: a still before there are frames. */
  still(): Float32Array | null {
    const mesh = this.mesh();
    if (!mesh || !this.check(this.call('sac_decoder_still', this.scratch))) return null;
    return this.instance.floats(this.instance.view().getUint32(this.scratch, true), 3 * mesh.vertices).slice();
  }

  /** Computes what frames need beside the mesh, which may take a second; the next call that needs it does so otherwise. */
  prepare(): void {
    this.check(this.call('sac_decoder_prepare'));
  }

  /** How many frames the clip has; undefined before the end or an index has told. */
  get frames(): number | undefined {
    return this.check(this.call('sac_decoder_frames', this.scratch))
      ? this.instance.view().getUint32(this.scratch, true) : undefined;
  }

  /** The most layers that a group so far may have: 1 where groups have no layers, 0 before the first group. */
  get layers(): number {
    return this.call('sac_decoder_layers');
  }

  /** Goes to a frame: the next bytes sent must be those from the returned number on. Null before the mesh is known. */
  seek(frame: number): number | null {
    if (!Number.isInteger(frame) || frame < 0) throw new SacArgumentError(`frame ${frame} cannot be sought`);
    if (!this.check(this.call('sac_decoder_seek', frame, this.scratch))) return null;
    return Number(this.instance.view().getBigUint64(this.scratch, true));
  }

  /** Goes to the frame that is shown at so many seconds, as seek(). */
  seekTime(seconds: number): number | null {
    if (!this.check(this.call('sac_decoder_seek_time', seconds, this.scratch))) return null;
    return Number(this.instance.view().getBigUint64(this.scratch, true));
  }

  /**
   * Tells where groups begin, from the last bytes of the stream. Returns 0 when the index is taken, else how many of
   * the last bytes are needed. A SacArgumentError: the stream has no index.
   */
  addIndex(tail: Uint8Array): number {
    const { instance, scratch } = this;
    const copy = instance.allocate(tail.length);
    try {
      instance.bytes(copy, tail.length).set(tail);
      const done = this.check(this.call('sac_decoder_add_index', copy, tail.length, scratch));
      return done ? 0 : instance.view().getUint32(scratch, true);
    } finally {
      instance.release(copy);
    }
  }

  /** With skipDamage: the runs of frames that are lost so far. */
  get lostFrames(): { first: number; count: number }[] {
    const runs = [];
    const count = this.call('sac_decoder_lost_count');
    for (let i = 0; i < count; ++i) {
      this.check(this.call('sac_decoder_lost', i, this.scratch, this.scratch + 4));
      const view = this.instance.view();
      runs.push({ first: view.getUint32(this.scratch, true), count: view.getUint32(this.scratch + 4, true) });
    }
    return runs;
  }

  private open(instance: SacInstance): void {
    this.instance = instance;
    this.frames_ = { positions: 0, positionBytes: 0, normals: 0, normalBytes: 0 };
    this.scratch = instance.allocate(SETTINGS_SIZE);
    this.chunk = instance.allocate(CHUNK);
    instance.call('sac_settings_init', this.scratch);
    this.writeSettings(instance.view());
    const out = instance.allocate(4);
    const status = instance.call('sac_decoder_open', out, this.scratch);
    this.decoder = instance.view().getUint32(out, true);
    instance.release(out);
    if (status !== STATUS.ok) {
      throw makeError(errorCodes[status] ?? 'invalid-argument', 'these options of a decoder cannot be used');
    }
  }

  private writeSettings(view: DataView): void {
    const at = (offset: number) => this.scratch + offset;
    const limits = this.options.limits ?? {};
    const u32 = (offset: number, value: number | undefined) => {
      if (value === undefined) return;
      if (!(value >= 0)) throw new SacArgumentError(`${value} is no limit`);
      view.setUint32(at(offset), Math.min(Math.floor(value), 0xffffffff), true);
    };
    const f64 = (offset: number, value: number | undefined) => {
      if (value !== undefined) view.setFloat64(at(offset), value, true);
    };
    u32(SETTINGS.maxVertices, limits.vertices);
    u32(SETTINGS.maxTriangles, limits.triangles);
    u32(SETTINGS.maxHarmonics, limits.harmonics);
    u32(SETTINGS.maxFramesPerGroup, limits.framesPerGroup);
    u32(SETTINGS.maxPacketBytes, limits.packetBytes);
    f64(SETTINGS.maxWork, limits.work);
    f64(SETTINGS.maxFrameWork, limits.frameWork);
    const memory = Math.floor(limits.memory ?? DEFAULT_MEMORY);
    if (!(memory >= 0)) throw new SacArgumentError(`${limits.memory} is no limit of memory`);
    view.setBigUint64(at(SETTINGS.maxMemory), BigInt(memory), true);
    u32(SETTINGS.skipDamage, this.options.skipDamage ? 1 : 0);
    u32(SETTINGS.frameStep, this.options.frameStep);
    if (this.options.layers === 0) throw new SacArgumentError('0 layers cannot be decoded');
    u32(SETTINGS.layers, this.options.layers);
  }

  private call(name: string, ...args: number[]): number {
    if (this.decoder === 0) throw new SacArgumentError('the decoder is closed');
    return this.instance.call(name, this.decoder, ...args);
  }

  /** False when more data is needed; throws any error. */
  private check(status: number): boolean {
    if (status === STATUS.ok) return true;
    if (status === STATUS.needMoreData) return false;
    const message = this.instance.text(this.call('sac_decoder_message'));
    throw makeError(errorCodes[status] ?? 'corrupt', message || 'out of memory');
  }

  private releaseFrames(): void {
    this.instance.release(this.frames_.positions);
    this.instance.release(this.frames_.normals);
    this.frames_ = { positions: 0, positionBytes: 0, normals: 0, normalBytes: 0 };
  }

  /** Writes where the decoder shall put a frame for `buffers`, and returns the struct's address. */
  private place(buffers: SacFrameBuffers): number {
    const { instance, frames_: frames } = this;
    const { positions, normals } = buffers;
    if (positions && frames.positionBytes !== positions.byteLength) {
      instance.release(frames.positions);
      frames.positionBytes = 0;
      frames.positions = instance.allocate(positions.byteLength);
      frames.positionBytes = positions.byteLength;
    }
    if (normals && frames.normalBytes !== normals.byteLength) {
      instance.release(frames.normals);
      frames.normalBytes = 0;
      frames.normals = instance.allocate(normals.byteLength);
      frames.normalBytes = normals.byteLength;
    }
    const place = this.scratch + INFO_SIZE;
    const view = instance.view();
    new Uint8Array(view.buffer, place, BUFFERS_SIZE).fill(0);
    this.describe(view, place, positions, frames.positions);
    this.describe(view, place + NORMALS, normals, frames.normals);
    return place;
  }

  private describe(view: DataView, place: number, array: ArrayBufferView & { length: number } | null | undefined,
    data: number): void {
    if (!array) return;
    const vertices = Math.max(this.mesh()?.vertices ?? 0, 1);
    const components = array.length >= 4 * vertices ? 4 : 3;
    const bytes = array.byteLength / array.length;
    view = this.instance.view();  // mesh() may have made memory grow
    view.setUint32(place + BUFFER.data, data, true);
    view.setUint32(place + BUFFER.size, array.byteLength, true);
    view.setUint32(place + BUFFER.stride, components * bytes, true);
    view.setUint32(place + BUFFER.format, array instanceof Float32Array ? FORMAT.float32 : FORMAT.int16, true);
  }

  /** Copies a frame into the caller's arrays and reads its description. */
  private take(buffers: SacFrameBuffers): SacFrameInfo {
    const { instance, scratch, frames_: frames } = this;
    const copy = (array: Float32Array | Int16Array | Uint16Array | null | undefined, from: number) => {
      if (array) new Uint8Array(array.buffer, array.byteOffset, array.byteLength).set(instance.bytes(from, array.byteLength));
    };
    copy(buffers.positions, frames.positions);
    copy(buffers.normals, frames.normals);
    const view = instance.view();
    const triple = (at: number): [number, number, number] =>
      [view.getFloat64(scratch + at, true), view.getFloat64(scratch + at + 8, true), view.getFloat64(scratch + at + 16, true)];
    const info = {
      index: view.getUint32(scratch + INFO.index, true),
      intra: view.getUint32(scratch + INFO.intra, true) === 1,
      time: view.getFloat64(scratch + INFO.time, true),
      box: { low: triple(INFO.boxLow), high: triple(INFO.boxHigh) },
    };
    return { ...info, segment: this.segment ?? 0 };
  }

  private readMesh(): SacMeshData | null {
    const { instance, scratch } = this;
    if (!this.check(this.call('sac_decoder_mesh', scratch))) return null;
    const view = instance.view();
    const word = (at: number) => view.getUint32(scratch + at, true);
    const vertices = word(MESH.vertices), triangles = word(MESH.triangles), uvs = word(MESH.uvs);
    const words = (at: number, length: number) => word(at) ? instance.words(word(at), length).slice() : null;
    const floats = (at: number, length: number) => word(at) ? instance.floats(word(at), length).slice() : null;
    const numerator = word(MESH.frameRateNumerator);
    const mesh = {
      vertices, triangles,
      frameRate: numerator > 0 ? numerator / word(MESH.frameRateDenominator) : undefined,
      triangleVertices: words(MESH.triangleVertices, 3 * triangles) ?? new Uint32Array(0),
      uvs: floats(MESH.uvValues, 2 * uvs),
      triangleUvs: words(MESH.triangleUvs, 3 * triangles),
      normals: floats(MESH.normals, 3 * vertices),
      colors: word(MESH.colors) ? instance.bytes(word(MESH.colors), 4 * vertices).slice() : null,
      order: words(MESH.order, vertices),
    };
    return { ...mesh, ...this.readCornerNormals(triangles), offset: this.readOffset() };
  }

  private readCornerNormals(triangles: number): Pick<SacMeshData, 'cornerNormals' | 'triangleNormals'> {
    const { instance, scratch } = this;
    this.check(this.call('sac_decoder_corner_normals', scratch, scratch + 4, scratch + 8));
    const view = instance.view();
    const [normals, count, of] = [0, 4, 8].map((at) => view.getUint32(scratch + at, true)) as [number, number, number];
    return {
      cornerNormals: normals ? instance.floats(normals, 3 * count).slice() : null,
      triangleNormals: of ? instance.words(of, 3 * triangles).slice() : null,
    };
  }

  private readOffset(): [number, number, number] {
    this.check(this.call('sac_decoder_offset', this.scratch));
    const view = this.instance.view();
    return [0, 8, 16].map((at) => view.getFloat64(this.scratch + at, true)) as [number, number, number];
  }
}
