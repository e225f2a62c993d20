// SPDX-License-Identifier: Apache-2.0

/** The bytes of a stream as they come, in any order, kept for loops and seeking: a clip is tens of kB. */
export class ByteStore {
  private buffer = new Uint8Array(1 << 16);
  private ranges: { begin: number; end: number }[] = [];  // that are there, ascending, none touching
  private waiting: (() => void)[] = [];
  private failure: Error | null = null;
  /** Of the whole stream; undefined until it is known. */
  length: number | undefined;

  /** How many bytes are there. */
  get loaded(): number {
    return this.ranges.reduce((sum, r) => sum + r.end - r.begin, 0);
  }

  get complete(): boolean {
    return this.length !== undefined && this.loaded >= this.length;
  }

  /** The bytes from `offset` on that are there without a gap; empty when there are none. Valid until the next put(). */
  from(offset: number): Uint8Array {
    return this.buffer.subarray(offset, Math.max(this.endOf(offset), offset));
  }

  /** Whether the stream is known to have no byte at `offset`. */
  endsAt(offset: number): boolean {
    return this.length !== undefined && offset >= this.length;
  }

  /** Where the bytes that are there from `offset` on end; `offset` itself when it is missing. */
  endOf(offset: number): number {
    return this.ranges.find((r) => r.begin <= offset && offset < r.end)?.end ?? offset;
  }

  put(offset: number, bytes: Uint8Array): void {
    const end = offset + bytes.length;
    if (bytes.length > 0) {
      this.reserve(end);
      this.buffer.set(bytes, offset);
      const touching = this.ranges.filter((r) => r.end >= offset && r.begin <= end);
      const merged = {
        begin: Math.min(offset, ...touching.map((r) => r.begin)),
        end: Math.max(end, ...touching.map((r) => r.end)),
      };
      this.ranges = [...this.ranges.filter((r) => !touching.includes(r)), merged].sort((a, b) => a.begin - b.begin);
    }
    this.wake();
  }

  /** Declares where the stream ends. */
  end(length: number): void {
    this.length = length;
    this.wake();
  }

  /** Who waits for bytes gets this error. */
  fail(error: Error): void {
    this.failure = error;
    this.wake();
  }

  /** Resolves when anything has changed; rejects when nothing will come. */
  async change(): Promise<void> {
    if (this.failure) throw this.failure;
    await new Promise<void>((resolve) => this.waiting.push(resolve));
    if (this.failure) throw this.failure;
  }

  private wake(): void {
    for (const resolve of this.waiting.splice(0)) resolve();
  }

  private reserve(size: number): void {
    if (size <= this.buffer.length) return;
    const grown = new Uint8Array(Math.max(size, 2 * this.buffer.length));
    grown.set(this.buffer);
    this.buffer = grown;
  }
}
