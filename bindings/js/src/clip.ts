// SPDX-License-Identifier: Apache-2.0
import { SacDecoder, type SacBox, type SacDecoderOptions, type SacFrameBuffers, type SacFrameInfo } from './decoder.js';
import { SacArgumentError, SacUnsupportedError, toSacError, type SacError } from './errors.js';
import type { RenderMesh } from './geometry.js';
import type { SacInstance } from './instance.js';
import { SegmentMesh, type MeshAbout, type ShapeBuffers } from './segment.js';
import type { SourceReader } from './source.js';

/** A run of shapes in playing order: `direction` * `step` frames apart, from the frame `start` on. */
export interface Run {
  epoch: number;
  start: number;
  direction: 1 | -1;
  step: number;
  loop: boolean;
}

export interface Shape {
  epoch: number;
  /** Frames from the run's start in its direction, counted on over loops. */
  travel: number;
  /** In the clip; whole unless the run's step is not. */
  frame: number;
  box: SacBox;
  buffers: ShapeBuffers;
  /** Milliseconds that it took to decode. */
  decodeMs: number;
  /** The most layers that a group so far may have. */
  layers: number;
}

/** What happens to a clip, told to its owner. */
export interface ClipEvents {
  /** The mesh of the shapes that come next. It changes where a segment of the stream begins. */
  mesh(mesh: RenderMesh, about: MeshAbout): void;
  shape(shape: Shape): void;
  /** How many frames there are, once it is known. */
  length(frames: number): void;
  /** The run has no further shapes: `travel` is that of its last. */
  end(epoch: number, travel: number): void;
  error(error: SacError): void;
}

// A task of its own lets messages in between shapes; timers would wait for milliseconds.
const channel = new MessageChannel();
const turns: (() => void)[] = [];
channel.port1.onmessage = () => turns.shift()?.();
(channel.port1 as { unref?: () => void }).unref?.();
const nextTurn = () => new Promise<void>((resolve) => {
  turns.push(resolve);
  channel.port2.postMessage(0);
});

interface Decoded {
  shape: Shape;
  mesh: SegmentMesh;
}

/** Thrown where a wait ends because another run has begun or the clip is closed. */
class Superseded extends Error {}

/** Decodes a clip for a player: shapes in playing order into buffers that come back when they were shown. */
export class Clip {
  private readonly decoder: SacDecoder;
  private readonly reader: SourceReader;
  private readonly events: ClipEvents;
  private free: ShapeBuffers[] = [];
  private mesh: SegmentMesh | null = null;  // of the decoder's next frame
  private told: SegmentMesh | null = null;  // of the last shape that was given
  private frames: number | undefined;
  private indexed = false;
  private cursor = 0;      // the next byte to send
  private next = 0;        // the next frame that receive() would give
  private finished = false;  // the decoder knows the end
  private run: Run | null = null;
  private travel = 0;      // of the run's next shape
  private behind = 0;      // shapes before this travel are late: they are left out
  private ended = false;
  private fresh = false;   // the run has not decoded anything yet
  private closed = false;
  private wake: (() => void) | null = null;

  constructor(module: WebAssembly.Module, reader: SourceReader, options: SacDecoderOptions & { ahead: number },
    events: ClipEvents, instance?: SacInstance) {
    this.decoder = new SacDecoder(module, options, instance);
    this.reader = reader;
    this.events = events;
    void this.work(options.ahead);
  }

  get memoryBytes(): number {
    return this.decoder.memoryBytes;
  }

  /** Begins another run; shapes of the one before are not given any more. */
  play(run: Run): void {
    this.run = run;
    this.travel = this.behind = 0;
    this.ended = false;
    this.fresh = true;
    this.wake?.();
  }

  /** Gives buffers back. Shapes before `wanted` come too late by now. */
  credit(buffers: ShapeBuffers[], epoch: number, wanted: number): void {
    for (const b of buffers) if (b.positions.length > 0) this.free.push(b);
    if (this.run?.epoch === epoch) this.behind = wanted;
    this.wake?.();
  }

  /** Ends the clip and returns its instance for another. */
  close(): SacInstance | null {
    this.closed = true;
    this.wake?.();
    this.reader.close();
    this.free = [];
    return this.decoder.close();
  }

  private async work(ahead: number): Promise<void> {
    try {
      await this.readMesh();
      for (let i = 0; i < ahead; ++i) {
        const buffers = { positions: new Float32Array(0), normals: new Int16Array(0) };
        this.mesh!.target(buffers);
        this.free.push(buffers);
      }
      while (!this.closed) {
        this.learnLength();
        if (!this.run || this.ended || this.free.length === 0) {
          await new Promise<void>((resolve) => (this.wake = resolve));
          this.wake = null;
          continue;
        }
        try {
          await (this.run.direction > 0 ? this.forward(this.run) : this.backward(this.run));
        } catch (error) {
          if (!(error instanceof Superseded)) throw error;
        }
        await nextTurn();
      }
    } catch (error) {
      if (!this.closed) this.events.error(toSacError(error));
    }
  }

  private async readMesh(): Promise<void> {
    let data = this.decoder.mesh();
    while (!data && !this.closed) {
      if (!(await this.feed(null))) data = this.decoder.mesh();
      data ??= this.decoder.mesh();
      if (!data && this.finished) throw new SacArgumentError('the stream has no mesh');
    }
    if (!data) throw new Superseded();
    this.mesh = new SegmentMesh(data, this.decoder.segment, this.decoder.still());
    this.tell(this.mesh);
  }

  private tell(mesh: SegmentMesh): void {
    if (mesh === this.told) return;
    this.told = mesh;
    this.events.mesh(mesh.mesh, mesh.about);
  }

  /** Whether the decoder's frames have another mesh now, which is taken then. */
  private meshChanges(): boolean {
    const number = this.decoder.segment;
    const data = number === undefined || number === this.mesh!.number ? null : this.decoder.mesh();
    if (!data) return false;
    this.mesh = new SegmentMesh(data, number, null);
    return true;
  }

  /** Has the decoder fill `buffers`, which come to fit the mesh that the frame has; null: it has no frame, send more. */
  private fill(buffers: ShapeBuffers | null, decode: (target: SacFrameBuffers) => SacFrameInfo | null): SacFrameInfo | null {
    this.meshChanges();
    for (;;) {
      try {
        const info = decode(buffers ? this.mesh!.target(buffers) : {});
        if (!info || !buffers || !this.meshChanges()) return info;
        // The mesh came from bytes that were there to be read again after damage: buffers of the one before are no use.
        this.cursor = this.decoder.seek(info.index)!;
        return null;
      } catch (error) {
        if (!(error instanceof SacArgumentError) || !this.meshChanges()) throw error;
      }
    }
  }

  /** Tells how many frames there are as soon as that can be known. */
  private learnLength(): void {
    if (this.frames !== undefined) return;
    if (!this.finished && !this.indexed && this.reader.store.complete) this.useTail(this.reader.store.from(0));
    this.frames = this.decoder.frames;
    if (this.frames !== undefined) this.events.length(this.frames);
  }

  /** Takes an index from the last bytes; returns how many more are wanted, 0 when there is nothing to be had. */
  private useTail(bytes: Uint8Array): number {
    try {
      for (let size = 8; ;) {
        if (size > bytes.length) return size;
        const needed = this.decoder.addIndex(bytes.subarray(bytes.length - size));
        if (needed === 0) break;
        size = needed;
      }
    } catch (error) {
      if (!(error instanceof SacArgumentError)) throw error;  // streams of one group have none
    }
    this.indexed = true;
    return 0;
  }

  /** Gets the index by requests of its own while the stream still comes. */
  private async fetchIndex(): Promise<void> {
    if (this.indexed || this.finished || !this.reader.random) return;
    for (let size = 8; size > 0;) size = this.useTail(await this.reader.tail(size));
    this.learnLength();
  }

  private alive(run: Run | null): void {
    if (this.closed || (run && this.run !== run)) throw new Superseded();
  }

  /** Sends the next bytes, waiting for them; false at the end of the stream. `run`: gives up when another begins. */
  private async feed(run: Run | null): Promise<boolean> {
    const { store } = this.reader;
    for (;;) {
      this.alive(run);
      if (store.endOf(this.cursor) > this.cursor) {
        this.cursor += this.decoder.send(store.from(this.cursor));
        return true;
      }
      if (store.endsAt(this.cursor)) {
        if (!this.finished) this.decoder.finish();
        this.finished = true;
        this.learnLength();
        return false;
      }
      this.reader.need(this.cursor);
      await Promise.race([store.change(), new Promise<void>((resolve) => (this.wake = resolve))]);
    }
  }

  private async seek(frame: number): Promise<void> {
    if (frame > this.next) await this.fetchIndex();
    const byte = this.decoder.seek(frame);
    if (byte === null) throw new SacArgumentError('the stream cannot be sought before its mesh is there');
    this.cursor = byte;
    this.next = frame;
  }

  /** The next whole frame into `buffers`; null at the end. */
  private async receive(run: Run, buffers: ShapeBuffers | null): Promise<SacFrameInfo | null> {
    for (;;) {
      const info = this.fill(buffers, (target) => this.decoder.receive(target));
      if (info) {
        this.next = info.index + 1;
        return info;
      }
      if (!(await this.feed(run))) return null;
    }
  }

  /** The shape at `frame`, which may lie between frames, into `buffers`; null beyond the end. */
  private async sample(run: Run, frame: number, buffers: ShapeBuffers): Promise<SacFrameInfo | null> {
    const whole = Math.floor(frame);
    // Within a run a few frames are passed over; a jump goes to where its group begins, by the index if need be.
    if (whole < this.next || whole > this.next + (this.fresh ? 0 : 64)) await this.seek(whole);
    this.fresh = false;
    // receive() forgets the frame that it gives, which a shape after it needs.
    if (frame === this.next && Number.isInteger(run.step)) return this.receive(run, buffers);
    try {
      for (;;) {
        const info = this.fill(buffers, (target) => this.decoder.interpolate(frame, target));
        if (info) {
          this.next = Math.max(this.next, whole);
          return info;
        }
        if (!(await this.feed(run)) && this.frames !== undefined && frame >= this.frames) return null;
        if (this.finished && this.frames === undefined) return null;
      }
    } catch (error) {
      if (error instanceof SacArgumentError && this.frames !== undefined && frame >= this.frames) return null;
      if (error instanceof SacArgumentError) await this.seek(whole);  // a start between the two let go of the first: hold it
      else if (!(error instanceof SacUnsupportedError)) throw error;
    }
    // Frames that are measured against the frame before must all be decoded, and nothing lies between them.
    for (;;) {
      const info = await this.receive(run, this.next === whole ? buffers : null);
      if (!info || info.index >= whole) return info;
    }
  }

  private async decode(run: Run, frame: number, buffers: ShapeBuffers): Promise<Decoded | null> {
    const begin = performance.now();
    const info = await this.sample(run, frame, buffers);
    this.alive(run);
    if (!info) return null;
    const mesh = this.mesh!;
    mesh.complete(buffers);
    const decodeMs = performance.now() - begin;
    return { mesh, shape: { epoch: run.epoch, travel: 0, frame, box: info.box, buffers, decodeMs, layers: this.decoder.layers } };
  }

  private give({ shape, mesh }: Decoded, run: Run): void {
    this.tell(mesh);
    shape.travel = this.travel;
    this.travel += run.step;
    this.events.shape(shape);
  }

  private finish(run: Run): void {
    this.ended = true;
    this.events.end(run.epoch, Math.max(this.travel - run.step, 0));
  }

  /** Leaves out what is late, in whole steps. */
  private catchUp(run: Run): void {
    if (this.behind > this.travel + run.step) {
      this.travel = Math.floor(this.behind / run.step) * run.step;
    }
  }

  /** The clip's frame at `travel`; null where the run is over. */
  private frameAt(run: Run, travel: number): number | null {
    const frame = run.start + run.direction * travel;
    if (this.frames === undefined) return frame >= 0 ? frame : null;
    if (frame >= 0 && frame < this.frames) return frame;
    if (!run.loop || this.frames === 0) return null;
    const wrapped = frame % this.frames;
    return wrapped < 0 ? wrapped + this.frames : wrapped;
  }

  private async forward(run: Run): Promise<void> {
    this.catchUp(run);
    const frame = this.frameAt(run, this.travel);
    if (frame === null) return this.finish(run);
    const buffers = this.free.pop()!;
    let decoded: Decoded | null = null;
    try {
      decoded = await this.decode(run, frame, buffers);
    } finally {
      if (!decoded) this.free.push(buffers);
    }
    if (decoded) {
      this.give(decoded, run);
    } else if (this.frames === undefined || frame < this.frames) {
      this.finish(run);  // damaged or empty: there is nothing that a loop could repeat
    }
  }

  /** Decodes as many shapes as there are buffers forward, then gives them backwards: frames need earlier ones. */
  private async backward(run: Run): Promise<void> {
    if (this.frames === undefined) await this.readLength(run);
    this.catchUp(run);
    const frames: number[] = [];
    while (frames.length < this.free.length) {
      const frame = this.frameAt(run, this.travel + frames.length * run.step);
      if (frame === null || (frames.length > 0 && frame > frames[0]!)) break;
      frames.unshift(frame);
    }
    if (frames.length === 0) return this.finish(run);
    const shapes: Decoded[] = [];
    try {
      for (const frame of frames) {
        const buffers = this.free.pop()!;
        const decoded = await this.decode(run, frame, buffers).catch((error) => {
          this.free.push(buffers);
          throw error;
        });
        if (decoded) shapes.push(decoded);
        else this.free.push(buffers);
      }
    } catch (error) {
      this.free.push(...shapes.map((s) => s.shape.buffers));
      throw error;
    }
    for (const decoded of shapes.reverse()) {
      if (this.run === run) this.give(decoded, run);
      else this.free.push(decoded.shape.buffers);
    }
    if (shapes.length === 0) this.finish(run);
  }

  private async readLength(run: Run): Promise<void> {
    await this.fetchIndex();
    while (this.frames === undefined) {
      while (this.decoder.receive()) this.next += 1;
      if (!(await this.feed(run))) break;
      this.learnLength();
    }
  }
}
