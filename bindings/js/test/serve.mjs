// SPDX-License-Identifier: Apache-2.0
// A static server for tests: serve({ '/': folder, '/clips/': folder }).
import { createReadStream, existsSync, statSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join, normalize } from 'node:path';

const types = {
  '.html': 'text/html', '.js': 'text/javascript', '.mjs': 'text/javascript', '.css': 'text/css', '.json': 'application/json',
  '.wasm': 'application/wasm', '.sac': 'application/octet-stream', '.webm': 'video/webm',
};

/** Serves folders by the longest prefix, with ranges. Returns the address and close(). */
export async function serve(folders) {
  const prefixes = Object.keys(folders).sort((a, b) => b.length - a.length);
  const server = createServer((request, response) => {
    const path = decodeURIComponent(new URL(request.url, 'http://x').pathname);
    const prefix = prefixes.find((p) => path.startsWith(p));
    let file = prefix === undefined ? '' : join(folders[prefix], normalize(`/${path.slice(prefix.length)}`));
    if (file && existsSync(file) && statSync(file).isDirectory()) file = join(file, 'index.html');
    if (!file || !existsSync(file)) return response.writeHead(404).end();
    const { size } = statSync(file);
    const range = /bytes=(\d*)-(\d*)/.exec(request.headers.range ?? '');
    const from = range?.[1] ? Number(range[1]) : 0, to = range?.[2] ? Math.min(Number(range[2]) + 1, size) : size;
    response.writeHead(range ? 206 : 200, {
      'content-type': types[extname(file)] ?? 'application/octet-stream', 'accept-ranges': 'bytes', 'content-length': to - from,
      ...(range ? { 'content-range': `bytes ${from}-${to - 1}/${size}` } : {}),
    });
    if (to > from) createReadStream(file, { start: from, end: to - 1 }).pipe(response);
    else response.end();
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  return {
    url: `http://127.0.0.1:${server.address().port}`,
    close: () => {
      server.closeAllConnections();
      server.close();
    },
  };
}
