// SPDX-License-Identifier: Apache-2.0
import { SacLimitError, SacNetworkError } from './errors.js';

type Pointer = number;
type Call = (...args: (number | bigint)[]) => number;

/** The functions of sac.wasm, by their names in C, and its memory. */
export interface SacExports {
  memory: WebAssembly.Memory;
  malloc: Call;
  free: Call;
  _initialize: () => void;
  [name: string]: Call | WebAssembly.Memory | (() => void);
}

// A stream's errors come as a status: printf, which the C library brings, prints nothing that anybody would read.
const imports = {
  wasi_snapshot_preview1: { fd_close: () => 0, fd_seek: () => 0, fd_write: () => 0 },
};

/** Compiles the decoder from a URL, from bytes, or takes a module that is compiled already. */
export async function compileSac(source: string | URL | BufferSource | WebAssembly.Module): Promise<WebAssembly.Module> {
  if (source instanceof WebAssembly.Module) return source;
  if (source instanceof ArrayBuffer || ArrayBuffer.isView(source)) return WebAssembly.compile(source as BufferSource);
  const url = String(source);
  let response: Response;
  try {
    response = await fetch(url);
  } catch (error) {
    throw new SacNetworkError(`${url}: ${error instanceof Error ? error.message : String(error)}`);
  }
  if (!response.ok) throw new SacNetworkError(`${url}: HTTP status ${response.status}`);
  // Only a response of this type may be compiled while it arrives.
  if (/^application\/wasm/.test(response.headers.get('content-type') ?? '')) {
    return WebAssembly.compileStreaming(response);
  }
  return WebAssembly.compile(await response.arrayBuffer());
}

/** One instance of sac.wasm. What traps in it loses it for good; `call` tells so by a SacLimitError. */
export class SacInstance {
  readonly module: WebAssembly.Module;
  lost = false;
  private readonly exports: SacExports;

  constructor(module: WebAssembly.Module) {
    this.module = module;
    this.exports = new WebAssembly.Instance(module, imports).exports as unknown as SacExports;
    this.exports._initialize();
  }

  /** Bytes of memory that the instance has taken; it never gives any back. */
  get memoryBytes(): number {
    return this.exports.memory.buffer.byteLength;
  }

  /** Whether the module has this function of C. */
  has(name: string): boolean {
    return name in this.exports;
  }

  call(name: string, ...args: (number | bigint)[]): number {
    if (this.lost) throw new SacLimitError('the decoder has run out of memory and was ended');
    try {
      return (this.exports[name] as Call)(...args) >>> 0;
    } catch (error) {
      this.lost = true;
      // There are no exceptions in the module: what would throw one, which is want of memory, traps.
      const what = error instanceof Error ? error.message : String(error);
      throw new SacLimitError(`the decoder has run out of memory and was ended (${what})`);
    }
  }

  allocate(bytes: number): Pointer {
    const pointer = this.call('malloc', Math.max(bytes, 1));
    if (pointer === 0) throw new SacLimitError(`no memory for ${bytes} bytes`);
    return pointer;
  }

  release(pointer: Pointer): void {
    if (pointer !== 0 && !this.lost) this.call('free', pointer);
  }

  // Views end when memory grows, which any call may cause: take them anew after each.
  view(): DataView {
    return new DataView(this.exports.memory.buffer);
  }

  bytes(pointer: Pointer, length: number): Uint8Array {
    return new Uint8Array(this.exports.memory.buffer, pointer, length);
  }

  floats(pointer: Pointer, length: number): Float32Array {
    return new Float32Array(this.exports.memory.buffer, pointer, length);
  }

  shorts(pointer: Pointer, length: number): Int16Array {
    return new Int16Array(this.exports.memory.buffer, pointer, length);
  }

  words(pointer: Pointer, length: number): Uint32Array {
    return new Uint32Array(this.exports.memory.buffer, pointer, length);
  }

  /** The text of a C string. */
  text(pointer: Pointer): string {
    const all = new Uint8Array(this.exports.memory.buffer, pointer);
    return new TextDecoder().decode(all.slice(0, all.indexOf(0)));
  }
}
