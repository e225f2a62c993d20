// SPDX-License-Identifier: Apache-2.0
// The build puts a small stream here, a vector of conformance/.
declare const SAC_WARM_STREAM: string;

export function warmStream(): Uint8Array {
  return Uint8Array.from(atob(SAC_WARM_STREAM), (c) => c.charCodeAt(0));
}
