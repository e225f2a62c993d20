// SPDX-License-Identifier: Apache-2.0
// What tests read from the repository.
import { readFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

export const packageFolder = join(dirname(fileURLToPath(import.meta.url)), '..');
export const root = join(packageFolder, '../..');
export const conformance = join(root, 'conformance');
export const manifest = JSON.parse(readFileSync(join(conformance, 'manifest.json'), 'utf8'));
export const vector = (file) => new Uint8Array(readFileSync(join(conformance, file)));
export const wasm = new Uint8Array(readFileSync(join(packageFolder, 'dist/sac.wasm')));
