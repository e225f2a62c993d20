// SPDX-License-Identifier: Apache-2.0
import {
  BufferGeometry, Mesh, MeshDepthMaterial, MeshDistanceMaterial, MeshStandardMaterial, RGBADepthPacking, Vector3,
  type BufferAttribute, type Material,
} from 'three';
import type { Shape } from './clip.js';
import type { SacDecoderOptions } from './decoder.js';
import type { SacError } from './errors.js';
import type { RenderMesh } from './geometry.js';
import { makeGeometry, setBounds, upload } from './mesh_geometry.js';
import { blendMaterial, type BlendUniforms } from './material.js';
import type { ClipHandle, WorkerPool } from './pool.js';
import type { MeshAbout } from './segment.js';
import type { SacSource } from './source.js';
import { Timeline, type MediaClock } from './timeline.js';

/** What loader.open() and loader.load() may be told of a clip. */
export interface SacOptions extends SacDecoderOptions {
  /** Default: MeshStandardMaterial, with the clip's colours where it has any. */
  material?: Material;
  /** Begin again after the last frame; default true. */
  loop?: boolean;
  /** Play as soon as there is something to show; default false. */
  autoplay?: boolean;
  /** Frames per second where the stream does not say; default 30. */
  frameRate?: number;
  /** Shapes that are decoded ahead; default 8. */
  ahead?: number;
  /**
   * Between frames: `none` holds each; `linear` blends two on the GPU (default); `decoder` has the decoder make
   * `subdivision` shapes a frame, whose turns keep their size, and blends those.
   */
  interpolation?: 'none' | 'linear' | 'decoder';
  /** With interpolation `decoder`: shapes a frame; default 2. */
  subdivision?: number;
  /** A video or its sound that says what time it is. */
  media?: MediaClock;
}

/** Figures of a clip as it plays. */
export interface SacStats {
  /** Bytes that have come. */
  bytes: number;
  /** Bytes of the decoder's memory. */
  memory: number;
  /** Milliseconds that the last shape took to decode. */
  decodeMs: number;
  /** Shapes that were decoded, shown, and came too late to be shown. */
  decoded: number;
  shown: number;
  late: number;
  /** The most layers that a group of frames so far may have: 1 where there are none; 0 before the first shape. */
  layers: number;
  /** Milliseconds from open() to the mesh, which is shown as a still, and to the first shape; NaN until then. */
  meshMs: number;
  firstShapeMs: number;
}

export interface SacMeshEventMap {
  /** The triangles are there, at first with a still; again where a segment of the stream has others. */
  mesh: object;
  /** Another shape is shown. */
  frame: { frame: number; time: number };
  /** The length is known. */
  length: { frames: number };
  /** The last frame of a clip that does not loop is shown. */
  ended: object;
  /** Nothing more will come. */
  error: { error: SacError };
  progress: { bytes: number };
}

/**
 * A mesh of three.js that plays a stream. It keeps itself up to date whenever its scene is drawn; with `autoUpdate`
 * false update() has to be called. Raycasts and bounds are those of the shape that is shown.
 */
export class SacMesh extends Mesh<BufferGeometry, Material> {
  readonly isSacMesh = true;
  autoUpdate = true;
  /** What to add to all positions to have the author's coordinates. */
  readonly offset = new Vector3();
  readonly stats: SacStats = {
    bytes: 0, memory: 0, decodeMs: 0, decoded: 0, shown: 0, late: 0, layers: 0, meshMs: NaN, firstShapeMs: NaN,
  };
  /** The clock that the mesh follows; null: its own. */
  media: MediaClock | null;
  /** Resolves when the first shape is there. */
  readonly ready: Promise<SacMesh>;
  /** What ended the clip; null while there is none. */
  error: SacError | null = null;

  private readonly timeline: Timeline<Shape>;
  private readonly clip: ClipHandle;
  private readonly uniforms: BlendUniforms = { sacMix: { value: 0 } };
  private readonly options: SacOptions;
  private readonly opened = performance.now();
  private settle!: { resolve: (mesh: SacMesh) => void; reject: (error: SacError) => void };
  private last = NaN;      // time of the update before, ms
  private next: Shape | null = null;  // whose arrays are in the attributes of the next shape
  private coming = this.geometry;  // of the shapes that come next
  private readonly geometries = new WeakMap<Shape, BufferGeometry>();
  private disposed = false;
  private told = false;    // that the clip has ended
  private knownRate = false;

  /** Meshes come from SacLoader. */
  constructor(pool: WorkerPool, source: SacSource, options: SacOptions = {}) {
    super(new BufferGeometry(), options.material ?? new MeshStandardMaterial({ roughness: 0.6 }));
    this.options = options;
    this.media = options.media ?? null;
    this.ready = new Promise((resolve, reject) => (this.settle = { resolve, reject }));
    this.ready.catch(() => undefined);  // also told by an event
    this.timeline = new Timeline<Shape>(
      (run) => this.clip?.play(run),
      (shapes) => this.release(shapes));
    this.timeline.loop = options.loop ?? true;
    this.timeline.playing = options.autoplay ?? false;
    if (options.interpolation === 'decoder') this.timeline.subdivision = Math.max(Math.round(options.subdivision ?? 2), 1);
    this.clip = pool.open(source, {
      ...(options.limits ? { limits: options.limits } : {}),
      skipDamage: options.skipDamage ?? false,
      ...(options.layers === undefined ? {} : { layers: options.layers }),
      ahead: Math.max(options.ahead ?? 8, 3),
    }, {
      mesh: ({ mesh, about }) => this.takeMesh(mesh, about),
      shape: (shape, memory, loaded) => this.takeShape(shape, memory, loaded),
      length: (frames, bytes) => this.takeLength(frames, bytes),
      end: (epoch, travel) => this.timeline.end(epoch, travel),
      error: (error) => this.fail(error),
    });
    this.timeline.restart(0);
  }

  /** Bytes of a source that the page reads itself; null: the end. */
  feed(bytes: Uint8Array | null, error?: string): void {
    this.clip.chunk(bytes, error);
  }

  play(): void {
    if (this.timeline.ended && !this.timeline.loop) this.timeline.restart(this.playbackRate < 0 ? Infinity : 0);
    this.timeline.playing = true;
    this.told = false;
    this.last = NaN;
  }

  pause(): void {
    this.timeline.playing = false;
  }

  get paused(): boolean {
    return !this.timeline.playing;
  }

  /** Goes to a time in seconds; what is shown stays until the shape of that time is there. */
  seek(seconds: number): void {
    this.told = false;
    this.timeline.seek(seconds);
  }

  get currentTime(): number {
    return this.timeline.currentTime;
  }

  set currentTime(seconds: number) {
    this.seek(seconds);
  }

  /** Seconds; undefined until it is known. */
  get duration(): number | undefined {
    return this.timeline.duration;
  }

  /** How many frames the clip has; undefined until it is known. */
  get frames(): number | undefined {
    return this.timeline.frames;
  }

  get frameRate(): number {
    return this.timeline.frameRate;
  }

  /** The frame that is shown, and between frames a part of the next; NaN before the first. */
  get frame(): number {
    return this.timeline.shown?.frame ?? NaN;
  }

  /** Times the clip's speed; negative: backwards. */
  get playbackRate(): number {
    return this.timeline.playbackRate;
  }

  set playbackRate(rate: number) {
    this.timeline.playbackRate = rate;
  }

  get loop(): boolean {
    return this.timeline.loop;
  }

  set loop(loop: boolean) {
    if (loop === this.timeline.loop) return;
    this.timeline.loop = loop;
    this.timeline.restart(this.timeline.frame);
  }

  /** Whether the last frame is shown and none follows. */
  get ended(): boolean {
    return !this.timeline.loop && this.timeline.ended;
  }

  override updateMatrixWorld(force?: boolean): void {
    if (this.autoUpdate) this.update();
    super.updateMatrixWorld(force);
  }

  /**
   * Shows the shape of the time: that of the media clock, or `delta` seconds later than before; without it as much
   * later as has passed. Returns whether another shape is shown.
   */
  update(delta?: number): boolean {
    if (this.disposed) return false;
    const now = performance.now();
    const passed = delta ?? (Number.isNaN(this.last) ? 0 : (now - this.last) / 1000);
    this.last = now;
    if (this.media) this.timeline.follow(this.media);
    else this.timeline.advance(Math.min(passed, 1));  // a page that slept goes on where it was
    const changed = this.timeline.update();
    if (changed) {
      this.show(this.timeline.shown!);
      this.stats.shown += 1;
      this.emit('frame', { frame: this.frame, time: this.currentTime });
    }
    this.blend();
    if (this.ended && !this.told) {
      this.told = true;
      this.emit('ended', {});
    }
    return changed;
  }

  /** Frees what the mesh holds here, on the GPU and in its worker, but not a material that it was given. */
  dispose(): void {
    if (this.disposed) return;
    this.disposed = true;
    this.timeline.playing = false;
    this.clip.close();
    this.timeline.queue.length = 0;
    this.timeline.shown = this.next = null;
    this.removeFromParent();
    this.geometry.dispose();
    this.coming.dispose();
    this.coming = this.geometry = new BufferGeometry();
    this.customDepthMaterial?.dispose();
    this.customDistanceMaterial?.dispose();
    if (this.material !== this.options.material) this.material.dispose();
  }

  private get interpolates(): boolean {
    return this.options.interpolation !== 'none';
  }

  private emit<K extends keyof SacMeshEventMap>(type: K, event: SacMeshEventMap[K]): void {
    (this as unknown as { dispatchEvent(e: object): void }).dispatchEvent({ type, ...event });
  }

  private fail(error: SacError): void {
    if (this.disposed) return;
    this.error = error;
    this.timeline.playing = false;
    this.settle.reject(error);
    this.emit('error', { error });
  }

  private release(shapes: Shape[]): void {
    if (shapes.length > 0 && !this.disposed) this.clip.credit(shapes, this.timeline.run.epoch, this.timeline.wanted);
  }

  private takeMesh(mesh: RenderMesh, { vertices, frameRate, offset, still }: MeshAbout): void {
    if (this.disposed) return;
    this.knownRate = frameRate !== undefined;
    this.timeline.frameRate = frameRate ?? this.options.frameRate ?? this.timeline.frameRate;
    this.coming = makeGeometry(mesh, this.interpolates);
    this.coming.userData = { vertices, source: mesh.source, offset };
    if (!Number.isNaN(this.stats.meshMs)) return;
    this.stats.meshMs = performance.now() - this.opened;
    this.useGeometry(this.coming);
    if (mesh.colors && !this.options.material) (this.material as MeshStandardMaterial).vertexColors = true;
    if (this.interpolates) {
      this.customDepthMaterial = blendMaterial(new MeshDepthMaterial({ depthPacking: RGBADepthPacking }), this.uniforms);
      this.customDistanceMaterial = blendMaterial(new MeshDistanceMaterial(), this.uniforms);
      this.material = blendMaterial(this.material, this.uniforms);
    }
    if (still) {
      upload(this.geometry.attributes.position as BufferAttribute, still.positions);
      upload(this.geometry.attributes.normal as BufferAttribute, still.normals);
      setBounds(this.geometry, still.box);
    }
    this.emit('mesh', {});
  }

  /** Shows the mesh of another segment; what the GPU holds of the one before is freed. */
  private useGeometry(geometry: BufferGeometry): void {
    const { vertices, source, offset } = geometry.userData as { vertices: number; source: Uint32Array | null; offset: number[] };
    this.geometry.dispose();
    this.geometry = geometry;
    this.next = null;
    this.offset.fromArray(offset);
    this.userData.sourceVertices = vertices;
    /** Per vertex of the geometry the one of the stream, where they differ. */
    this.userData.sourceOf = source;
  }

  private takeShape(shape: Shape, memory: number, loaded: number): void {
    if (this.disposed) return;
    const { stats } = this;
    stats.memory = memory;
    if (loaded !== stats.bytes) {
      stats.bytes = loaded;
      this.emit('progress', { bytes: loaded });
    }
    stats.decodeMs = shape.decodeMs;
    stats.layers = shape.layers;
    stats.decoded += 1;
    if (shape.epoch === this.timeline.run.epoch && shape.travel < this.timeline.wanted - this.timeline.run.step) stats.late += 1;
    this.geometries.set(shape, this.coming);
    this.timeline.push(shape);
    if (Number.isNaN(stats.firstShapeMs)) {
      stats.firstShapeMs = performance.now() - this.opened;
      this.update(0);
      this.settle.resolve(this);
    }
  }

  private takeLength(frames: number, bytes: number): void {
    if (this.disposed) return;
    this.timeline.frames = frames;
    this.stats.bytes = Math.max(this.stats.bytes, bytes);
    this.emit('length', { frames });
    // A stream without a rate goes with its sound, when that says how long it is.
    const seconds = (this.media as { duration?: number } | null)?.duration;
    if (!this.knownRate && !this.options.frameRate && seconds && Number.isFinite(seconds)) {
      this.timeline.frameRate = frames / seconds;
    }
  }

  /** Puts a shape's arrays into the attributes; they keep their sizes, so no buffer is made anew. */
  private show(shape: Shape): void {
    const geometry = this.geometries.get(shape)!;
    const changes = geometry !== this.geometry;
    if (changes) this.useGeometry(geometry);
    const { attributes } = geometry;
    if (this.next === shape) {
      // It is on the GPU already, as the next one.
      const { position, normal, sacNextPosition, sacNextNormal } = attributes as Record<string, BufferAttribute>;
      Object.assign(attributes, {
        position: sacNextPosition, normal: sacNextNormal, sacNextPosition: position, sacNextNormal: normal,
      });
    } else {
      upload(attributes.position as BufferAttribute, shape.buffers.positions);
      upload(attributes.normal as BufferAttribute, shape.buffers.normals);
    }
    this.next = null;
    setBounds(geometry, shape.box);
    if (changes) this.emit('mesh', {});
  }

  /** Sets how far the time is to the next shape, and has that on the GPU. */
  private blend(): void {
    const { timeline, uniforms, geometry } = this;
    const shown = timeline.shown, next = timeline.queue[0];
    const blends = this.interpolates && shown !== null && next !== undefined && shown.epoch === next.epoch && shown !== next
      && this.geometries.get(next) === geometry  // nothing lies between shapes of two meshes
      && next.frame !== undefined && Math.abs(next.frame - shown.frame) <= Math.abs(timeline.run.step) + 1e-6;
    uniforms.sacMix.value = blends ? timeline.fraction : 0;
    if (this.interpolates && shown) this.material = blendMaterial(this.material, uniforms);
    if (!blends || this.next === next) return;
    upload(geometry.attributes.sacNextPosition as BufferAttribute, next.buffers.positions);
    upload(geometry.attributes.sacNextNormal as BufferAttribute, next.buffers.normals);
    this.next = next;
    setBounds(geometry, shown.box, next.box);
  }
}
