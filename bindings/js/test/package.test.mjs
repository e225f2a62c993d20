// SPDX-License-Identifier: Apache-2.0
// The package as others get it: sizes, and npm pack into an empty project that a bundler or none builds.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { cpSync, mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { brotliCompressSync, constants } from 'node:zlib';
import { start } from './browser.mjs';
import { packageFolder, root } from './files.mjs';

const brotli = (file) => brotliCompressSync(readFileSync(join(packageFolder, 'dist', file)),
  { params: { [constants.BROTLI_PARAM_QUALITY]: 11, [constants.BROTLI_PARAM_LGWIN]: 24 } }).length;
const modules = join(packageFolder, 'node_modules');
// esbuild's is a script or, where npm ran what its package installs with, a program.
const tool = (name, args, cwd) => execFileSync(join(modules, '.bin', name), args, { cwd, stdio: 'pipe' });

const main = `
import * as THREE from 'three';
import { SacLoader } from 'sac-player';
const renderer = new THREE.WebGLRenderer();
document.body.append(renderer.domElement);
const scene = new THREE.Scene(), camera = new THREE.PerspectiveCamera();
const loader = new SacLoader();
if (window.decoderPath) loader.setDecoderPath(window.decoderPath);
const mesh = await loader.loadAsync('/clips/sphere.sac');
scene.add(mesh);
mesh.play();
window.mesh = mesh;
renderer.setAnimationLoop(() => renderer.render(scene, camera));
`;
const html = (head, script) => `<!doctype html><meta charset="utf-8"><title>Package</title>${head}
<body><script type="module" ${script}></script></body>`;

let folder, installed, tab;
before(async () => {
  folder = mkdtempSync(join(tmpdir(), 'sac-package-'));
  const npm = (args, cwd) => execFileSync('npm', [...args, '--silent', '--offline', '--no-audit', '--no-fund'], { cwd, encoding: 'utf8' });
  const [archive] = JSON.parse(npm(['pack', '--json', '--pack-destination', folder], packageFolder));
  const project = join(folder, 'project');
  mkdirSync(project);
  writeFileSync(join(project, 'package.json'), '{ "name": "empty", "private": true, "type": "module" }\n');
  npm(['install', '--legacy-peer-deps', join(folder, archive.filename)], project);
  installed = join(project, 'node_modules/sac-player');
  // What a project has besides: three.js, here the one that is there already.
  symlinkSync(join(modules, 'three'), join(project, 'node_modules/three'));
  writeFileSync(join(project, 'main.js'), main);
  writeFileSync(join(project, 'index.html'), html('', 'src="/main.js"'));
  tab = await start({ '/project/': project, '/vite/': join(project, 'dist'), '/esbuild/': join(project, 'out') });
});
after(async () => {
  await tab?.stop();
  rmSync(folder, { recursive: true, force: true });
});

/** Opens a page and waits until its clip has shown several frames. */
async function plays(path) {
  const page = await tab.open(path);
  await page.waitForFunction(() => (window.mesh ?? document.querySelector('sac-player')?.mesh)?.stats.shown >= 5);
  await page.close();
  assert.deepEqual(tab.errors.filter((e) => !/favicon/.test(e) && !/404/.test(e)), []);
}

test('sizes are within their budgets', () => {
  const wasm = brotli('sac.wasm');
  // What a page with three.js of its own loads beside the decoder.
  const files = new Set(['index.js']);
  for (const file of files) {
    for (const [, chunk] of readFileSync(join(packageFolder, 'dist', file), 'utf8').matchAll(/["']\.\/(chunk-[^"']+)["']/g)) files.add(chunk);
  }
  assert.ok(files.size >= 2);
  const player = ['worker.js', ...files].reduce((sum, file) => sum + brotli(file), 0);
  console.log(`sac.wasm ${wasm}, player ${player} bytes of brotli`);
  assert.ok(wasm <= 200_000, `sac.wasm takes ${wasm} bytes of brotli, the budget is 200,000`);
  assert.ok(player <= 15_000, `the player takes ${player} bytes of brotli, the budget is 15,000`);
});

test('the package holds what it needs and nothing else', () => {
  assert.deepEqual(readdirSync(installed).sort(), ['LICENSE', 'README.md', 'dist', 'package.json']);
  const { exports } = JSON.parse(readFileSync(join(installed, 'package.json'), 'utf8'));
  for (const entry of Object.values(exports)) {
    for (const file of typeof entry === 'string' ? [entry] : Object.values(entry)) readFileSync(join(installed, file));
  }
  // Node.js finds the core by its name.
  const script = "import { SacDecoder, compileSac } from 'sac-player/core'; import { readFileSync } from 'node:fs';" +
    "const module = await compileSac(readFileSync(new URL(import.meta.resolve('sac-player/sac.wasm'))));" +
    'console.log(SacDecoder.versions(module).library)';
  const printed = execFileSync(process.execPath, ['--input-type=module', '-e', script], { cwd: join(folder, 'project'), encoding: 'utf8' });
  assert.match(printed, /^\d+\.\d+\.\d+\n$/);
});

test('types are right for a project that uses them', () => {
  const project = join(folder, 'types');
  mkdirSync(project);
  symlinkSync(join(folder, 'project/node_modules'), join(project, 'node_modules'));
  writeFileSync(join(project, 'use.ts'), `
import { SacDecoder, compileSac, type SacMeshData } from 'sac-player/core';
export async function count(bytes: Uint8Array): Promise<number> {
  const decoder = new SacDecoder(await compileSac('sac.wasm'), { limits: { vertices: 1000 } });
  decoder.send(bytes);
  const mesh: SacMeshData | null = decoder.mesh();
  // @ts-expect-error: no such member
  decoder.sent;
  return mesh?.vertices ?? 0;
}
`);
  writeFileSync(join(project, 'tsconfig.json'), JSON.stringify({
    compilerOptions: { strict: true, noEmit: true, target: 'es2022', module: 'es2022', moduleResolution: 'bundler', types: [] },
  }));
  tool('tsc', ['-p', '.'], project);
});

test('a page without a build', async () => {
  const map = '<script type="importmap">{"imports":{"three":"/three/build/three.module.js","three/addons/":"/three/examples/jsm/",' +
    '"sac-player":"/project/node_modules/sac-player/dist/index.js"}}</script>';
  writeFileSync(join(folder, 'project/plain.html'), html(map, 'src="/project/main.js"'));
  await plays('/project/plain.html');
});

test('<sac-player> on a page without three.js', async () => {
  writeFileSync(join(folder, 'project/element.html'),
    html('', 'src="/project/node_modules/sac-player/dist/player.js"') + '<sac-player src="/clips/sphere.sac" autoplay></sac-player>');
  await plays('/project/element.html');
});

test('esbuild', async () => {
  const project = join(folder, 'project');
  tool('esbuild', ['main.js', '--bundle', '--format=esm', '--target=es2022', '--outfile=out/main.js'], project);
  // It leaves addresses of files as they are: they lie beside the bundle.
  for (const file of ['worker.js', 'sac.wasm']) cpSync(join(installed, 'dist', file), join(project, 'out', file));
  writeFileSync(join(project, 'out/index.html'), html('', 'src="main.js"'));
  await plays('/esbuild/');
});

test('Vite', async () => {
  const project = join(folder, 'project');
  tool('vite', ['build', '--base=/vite/', '--logLevel=error'], project);
  assert.ok(readdirSync(join(project, 'dist/assets')).some((f) => f.endsWith('.wasm')));
  await plays('/vite/');
});

test('the page of the demonstration works from a folder of its own', async () => {
  const page = join(root, 'build/web/demo');
  const { serve } = await import('./serve.mjs');
  const alone = await serve({ '/some/where/': page });
  const browser = await tab.browser.newPage();
  const asked = [];
  browser.on('request', (r) => asked.push(r.url()));
  browser.on('pageerror', (e) => tab.errors.push(String(e)));
  await browser.goto(`${alone.url}/some/where/`);
  await browser.waitForFunction(() => document.querySelector('sac-player')?.mesh?.stats.shown >= 5, null, { timeout: 110000 });
  assert.ok(asked.every((url) => url.startsWith(alone.url) || /^(blob|data):/.test(url)), asked.join(' '));
  await browser.waitForFunction(() => document.getElementById('frames').textContent.includes('200'));
  // Fewer layers are another clip: its shapes differ, and so it stays when it comes round again.
  const at = () => browser.evaluate(async () => {
    const { mesh } = document.querySelector('sac-player');
    mesh.pause();
    mesh.seek(0.5);
    await new Promise((resolve) => mesh.addEventListener('frame', function shown() {
      if (Math.abs(mesh.currentTime - 0.5) > 0.02) return;
      mesh.removeEventListener('frame', shown);
      resolve();
    }));
    return [...mesh.geometry.attributes.position.array.slice(0, 30)];
  });
  const fine = await at();
  await browser.waitForFunction(() => !document.getElementById('layer-row').hidden);
  await browser.evaluate(() => {
    const slider = document.getElementById('layers');
    slider.value = 1;
    slider.dispatchEvent(new Event('change'));
  });
  await browser.waitForFunction(() => document.querySelector('sac-player').mesh?.stats.shown >= 1 &&
    document.getElementById('layer-count').textContent.startsWith('1 of '));
  assert.notDeepEqual(await at(), fine);
  // A file of the user's own.
  await browser.setInputFiles('#file', join(root, 'build/web/flag.sac'));
  await browser.waitForFunction(() => document.getElementById('name').textContent === 'flag.sac' &&
    document.querySelector('sac-player').mesh.stats.shown >= 3);
  // And one that is none.
  await browser.setInputFiles('#file', { name: 'bad.sac', mimeType: '', buffer: Buffer.from('nothing of the kind') });
  await browser.waitForFunction(() => document.querySelector('sac-player').shadowRoot.querySelector('.note.error')?.textContent.length > 5);
  assert.deepEqual(tab.errors.filter((e) => !/404/.test(e)), []);
  await browser.close();
  alone.close();
});
