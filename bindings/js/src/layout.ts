// SPDX-License-Identifier: Apache-2.0
// Offsets in bytes of the structs of sac.h at 32 bits. wasm/layout.cpp holds the compiler to them.

export const STATUS = {
  ok: 0,
  needMoreData: 1,
  invalidArgument: 2,
  unsupported: 3,
  corrupt: 4,
  limit: 5,
  cancelled: 6,
} as const;

export const SETTINGS_SIZE = 256;
export const SETTINGS = {
  maxVertices: 4,
  maxMemory: 8,
  maxWork: 16,
  skipDamage: 24,
  frameStep: 28,
  maxTriangles: 44,
  maxHarmonics: 48,
  maxFramesPerGroup: 52,
  maxPacketBytes: 56,
  maxGroupValues: 64,
  maxBasisValues: 72,
  maxFactorValues: 80,
  maxFreeWork: 88,
  maxWorkPerByte: 96,
  maxFrameWork: 104,
  layers: 112,
} as const;

export const FORMAT = { float32: 0, int16: 1 } as const;
export const BUFFERS_SIZE = 32;
export const BUFFER = { data: 0, size: 4, stride: 8, format: 12 } as const;
export const NORMALS = 16;

export const INFO_SIZE = 64;
export const INFO = { index: 0, intra: 4, time: 8, boxLow: 16, boxHigh: 40 } as const;

export const MESH = {
  vertices: 0,
  triangles: 4,
  uvs: 8,
  frameRateNumerator: 12,
  frameRateDenominator: 16,
  triangleVertices: 20,
  uvValues: 24,
  triangleUvs: 28,
  normals: 32,
  colors: 36,
  order: 40,
} as const;
