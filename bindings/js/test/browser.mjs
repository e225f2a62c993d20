// SPDX-License-Identifier: Apache-2.0
// Chromium for tests, with WebGL in software.
import { existsSync } from 'node:fs';
import { join } from 'node:path';
import { chromium } from 'playwright-core';
import { packageFolder, root } from './files.mjs';
import { serve } from './serve.mjs';

/** A browser and a server of the package, three.js, the vectors and the clips that the build made. */
export async function start(folders = {}) {
  const server = await serve({
    '/': join(packageFolder, 'test/pages'),
    '/test/': join(packageFolder, 'test'),
    '/dist/': join(packageFolder, 'dist'),
    '/three/': join(packageFolder, 'node_modules/three'),
    '/conformance/': join(root, 'conformance'),
    '/clips/': join(root, 'build/web'),
    ...folders,
  });
  const browser = await chromium.launch({
    executablePath: ['/usr/bin/chromium', '/usr/bin/chromium-browser'].find(existsSync),
    args: ['--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--no-sandbox', '--disable-dev-shm-usage',
      '--autoplay-policy=no-user-gesture-required', '--js-flags=--expose-gc', '--enable-precise-memory-info'],
  });
  const errors = [];
  return {
    server, browser, errors,
    /** A page whose complaints are collected in `errors`. */
    async open(path) {
      const page = await browser.newPage({ viewport: { width: 480, height: 320 } });
      page.setDefaultTimeout(110000);
      page.on('pageerror', (error) => errors.push(String(error)));
      page.on('console', (message) => message.type() === 'error' && errors.push(message.text()));
      await page.goto(server.url + path);
      return page;
    },
    async stop() {
      await browser.close();
      server.close();
    },
  };
}
