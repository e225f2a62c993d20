// SPDX-License-Identifier: Apache-2.0

/** The classes of errors of spec.md 11, and those of the interface of C. */
export type SacErrorCode = 'invalid-argument' | 'unsupported' | 'corrupt' | 'limit' | 'cancelled' | 'network';

/** What went wrong, with the decoder's own message. Every error that this package throws is one. */
export class SacError extends Error {
  readonly code: SacErrorCode;

  constructor(code: SacErrorCode, message: string) {
    super(message);
    this.name = 'SacError';
    this.code = code;
  }
}

/** What the caller gave cannot be used. */
export class SacArgumentError extends SacError {
  constructor(message: string) {
    super('invalid-argument', message);
    this.name = 'SacArgumentError';
  }
}

/** A stream of another version, or what a stream cannot give. */
export class SacUnsupportedError extends SacError {
  constructor(message: string) {
    super('unsupported', message);
    this.name = 'SacUnsupportedError';
  }
}

/** The bytes break a rule of the bitstream. */
export class SacCorruptError extends SacError {
  constructor(message: string) {
    super('corrupt', message);
    this.name = 'SacCorruptError';
  }
}

/** The stream asks for more than the limits of the settings, or than there is memory. */
export class SacLimitError extends SacError {
  constructor(message: string) {
    super('limit', message);
    this.name = 'SacLimitError';
  }
}

/** The bytes could not be fetched. */
export class SacNetworkError extends SacError {
  constructor(message: string) {
    super('network', message);
    this.name = 'SacNetworkError';
  }
}

/** The error of a code, as a worker told it by `code` and `message`. */
export function makeError(code: SacErrorCode, message: string): SacError {
  switch (code) {
    case 'invalid-argument':
      return new SacArgumentError(message);
    case 'unsupported':
      return new SacUnsupportedError(message);
    case 'corrupt':
      return new SacCorruptError(message);
    case 'limit':
      return new SacLimitError(message);
    case 'network':
      return new SacNetworkError(message);
    default:
      return new SacError(code, message);
  }
}

/** Any thrown value as a SacError. */
export function toSacError(error: unknown): SacError {
  if (error instanceof SacError) return error;
  return new SacError('invalid-argument', error instanceof Error ? error.message : String(error));
}
