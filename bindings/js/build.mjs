// SPDX-License-Identifier: Apache-2.0
// Bundles src/ into dist/: node build.mjs SAC_WASM. Types are tsc's.
import { build } from 'esbuild';
import { copyFileSync, cpSync, existsSync, mkdirSync, readFileSync, rmSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
const root = join(here, '../..');
const [wasm] = process.argv.slice(2);
if (!wasm) throw new Error('usage: node build.mjs SAC_WASM');
const dist = join(here, 'dist');
rmSync(dist, { recursive: true, force: true });
mkdirSync(dist);

const banner = { js: '// SPDX-License-Identifier: Apache-2.0' };
// What browsers of 2022 know. three.js is the page's own, so that there is one of it.
const common = { absWorkingDir: here, bundle: true, format: 'esm', target: 'es2022', minify: true, banner, logLevel: 'warning' };
const warm = readFileSync(join(root, 'conformance/valid/chain.sac')).toString('base64');
const worker = { ...common, define: { SAC_WARM_STREAM: JSON.stringify(warm) } };
const entries = ['core', 'index', 'element'].filter((name) => existsSync(join(here, `src/${name}.ts`)));

await Promise.all([
  build({
    ...common, entryPoints: entries.map((name) => `src/${name}.ts`), outdir: 'dist', splitting: true,
    chunkNames: 'chunk-[hash]', external: ['three', 'three/*'],
  }),
  build({ ...worker, entryPoints: ['src/worker.ts'], outfile: 'dist/worker.js' }),
  // The clip decoder alone, for tests in Node.js.
  build({ ...common, minify: false, platform: 'node', entryPoints: ['src/testing.ts'], outfile: 'dist/testing.js' }),
  // All in one, three.js included, for pages without a build of their own.
  ...(entries.includes('element')
    ? [build({ ...common, entryPoints: ['src/element.ts'], outfile: 'dist/player.js' })] : []),
]);
copyFileSync(wasm, join(dist, 'sac.wasm'));
// The page works from any static host: all that it needs lies beside it.
const page = join(root, 'build/web/demo');
rmSync(page, { recursive: true, force: true });
cpSync(join(here, 'demo'), page, { recursive: true });
for (const file of ['player.js', 'worker.js', 'sac.wasm']) copyFileSync(join(dist, file), join(page, file));
copyFileSync(join(root, 'build/web/walker.sac'), join(page, 'walker.sac'));
copyFileSync(join(root, 'LICENSE'), join(here, 'LICENSE'));
