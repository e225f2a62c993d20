// SPDX-License-Identifier: Apache-2.0
import { SacNetworkError } from './errors.js';
import { ByteStore } from './store.js';

/** Where bytes come from. What a worker cannot be sent is read by the page and comes in chunks. */
export type SacSource =
  | { kind: 'url'; url: string; headers?: Record<string, string>; credentials?: RequestCredentials }
  | { kind: 'blob'; blob: Blob }
  | { kind: 'chunks' };

// A request of its own pays when at least so many bytes would have to come before those that are wanted.
const DETOUR = 1 << 18;

/** Fills a ByteStore from a source, in order until something later is needed. */
export class SourceReader {
  readonly store = new ByteStore();
  private readonly source: SacSource;
  private readonly detour: number;
  private abort: AbortController | null = null;
  private cursor = 0;
  private ranged = false;  // whether the server sends parts

  constructor(source: SacSource, detour = DETOUR) {
    this.source = source;
    this.detour = detour;
  }

  /** Whether bytes can be had out of order. */
  get random(): boolean {
    return this.ranged && !this.store.complete;
  }

  start(): void {
    if (this.source.kind === 'blob') void this.readBlob(this.source.blob);
    if (this.source.kind === 'url') void this.fetchFrom(0);
  }

  /** Has the bytes from `offset` on come before others, where that is possible and pays. */
  need(offset: number): void {
    if (!this.ranged || this.store.endOf(offset) > offset || this.store.endsAt(offset)) return;
    const next = this.store.endOf(this.cursor);
    if (offset >= next && offset < next + this.detour && this.abort) return;
    void this.fetchFrom(offset);
  }

  /** The last `size` bytes of a stream of known length. */
  async tail(size: number): Promise<Uint8Array> {
    const begin = Math.max((this.store.length ?? 0) - size, 0);
    const end = this.store.length ?? 0;
    if (this.store.endOf(begin) < end) {
      const response = await this.request(begin, end);
      if (response.status !== 206) throw new SacNetworkError(`${response.url}: no part of it can be had`);
      this.store.put(begin, new Uint8Array(await response.arrayBuffer()));
    }
    return this.store.from(begin).slice();
  }

  close(): void {
    this.abort?.abort();
    this.abort = null;
    this.store.fail(new SacNetworkError('the source is closed'));
  }

  private async readBlob(blob: Blob): Promise<void> {
    try {
      this.store.put(0, new Uint8Array(await blob.arrayBuffer()));
      this.store.end(blob.size);
    } catch (error) {
      this.store.fail(new SacNetworkError(`the file cannot be read: ${String(error)}`));
    }
  }

  private request(begin: number, end?: number, signal?: AbortSignal): Promise<Response> {
    if (this.source.kind !== 'url') throw new SacNetworkError('not a source of parts');
    const headers: Record<string, string> = { ...this.source.headers };
    if (begin > 0 || end !== undefined) headers.Range = `bytes=${begin}-${end === undefined ? '' : end - 1}`;
    const init: RequestInit = { headers };
    if (signal) init.signal = signal;
    if (this.source.credentials) init.credentials = this.source.credentials;
    return fetch(this.source.url, init);
  }

  /** Reads from `begin` on, and what is missing elsewhere afterwards. */
  private async fetchFrom(begin: number): Promise<void> {
    this.abort?.abort();
    const abort = (this.abort = new AbortController());
    const url = this.source.kind === 'url' ? this.source.url : '';
    try {
      for (let at: number | null = begin; at !== null && !abort.signal.aborted; at = this.gap()) {
        await this.fetchRun(at, abort, url);
      }
    } catch (error) {
      if (abort.signal.aborted) return;
      const message = error instanceof SacNetworkError ? error.message : `${url}: ${(error as Error).message}`;
      this.store.fail(new SacNetworkError(message));
    } finally {
      if (this.abort === abort) this.abort = null;
    }
  }

  private async fetchRun(begin: number, abort: AbortController, url: string): Promise<void> {
    const response = await this.request(begin, undefined, abort.signal);
    if (!response.ok) throw new SacNetworkError(`${url}: HTTP status ${response.status}`);
    const first = response.status === 206 ? begin : 0;
    const length = Number(response.headers.get('content-length') ?? NaN);
    // The length of what is compressed on the way says nothing, nor can parts of it be asked for.
    if (!response.headers.get('content-encoding') && Number.isFinite(length)) {
      this.store.length = first + length;
      this.ranged = /bytes/.test(response.headers.get('accept-ranges') ?? '') || response.status === 206;
    }
    this.cursor = first;
    const reader = response.body!.getReader();
    for (;;) {
      const { done, value } = await reader.read();
      if (abort.signal.aborted) return;
      if (done) break;
      this.store.put(this.cursor, value);
      this.cursor += value.length;
      if (this.store.endOf(this.cursor) > this.cursor && this.ranged) {
        void reader.cancel();  // what follows is there
        return;
      }
    }
    if (this.store.length !== undefined && this.cursor < this.store.length) {
      throw new SacNetworkError(`${url}: the connection ended after ${this.cursor} of ${this.store.length} bytes`);
    }
    this.store.end(this.cursor);
  }

  /** Where bytes are missing; null when none are. */
  private gap(): number | null {
    if (this.store.length === undefined) return null;
    const after = this.store.endOf(this.cursor);
    if (after < this.store.length) return after;
    const begin = this.store.endOf(0);
    return begin < this.store.length ? begin : null;
  }
}
