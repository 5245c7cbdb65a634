// A Worker of a real browser: it runs a text of ours with the package beside it, and tells what came out.
//
// Owns the server and the browser, for as long as one question takes. Knows no package.
import { execFile } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { join, normalize } from 'node:path';

/** How often a folder is tried to be removed, ten times in a second. */
const ATTEMPTS = 100;
const TYPES = { js: 'text/javascript', wasm: 'application/wasm', html: 'text/html' };

const PAGE = `<!doctype html><title>package</title><p>nothing</p><script type="module">
const worker = new Worker('/worker.js', { type: 'module' });
worker.onmessage = ({ data }) => fetch('/told', { method: 'POST', body: JSON.stringify(data) });
worker.onerror = ({ message }) => fetch('/told', { method: 'POST', body: JSON.stringify({ message }) });
</script>`;

/**
 * What a Worker posts first, as an object, or its `message` if it fails. `folder` is the package, which it finds below /package;
 * `file` gives the bytes of any other path that it fetches.
 */
export async function inWorker({ folder, worker, file, longest_ms, chromium = 'chromium' }) {
  let hear;
  const told = new Promise((resolve) => { hear = resolve; });
  const server = createServer((request, answer) => {
    const send = (type, body) => answer.writeHead(200, { 'content-type': type }).end(body);
    const path = normalize(request.url);
    if (path === '/told') {
      const parts = [];
      request.on('data', (part) => parts.push(part));
      request.on('end', () => { send('text/plain', ''); hear(JSON.parse(Buffer.concat(parts))); });
    } else if (path === '/') {
      send(TYPES.html, PAGE);
    } else if (path === '/worker.js') {
      send(TYPES.js, worker);
    } else if (path.startsWith('/package/')) {
      send(TYPES[path.split('.').pop()] ?? 'text/plain', readFileSync(join(folder, path.slice('/package/'.length))));
    } else {
      send('application/octet-stream', file(path));
    }
  });
  await new Promise((resolve) => { server.listen(0, '127.0.0.1', resolve); });
  const profile = mkdtempSync(join(tmpdir(), 'trik-web-'));
  const address = `http://127.0.0.1:${server.address().port}/`;
  // Without a port to be debugged by, a browser without a window ends as soon as the page is there.
  const words = ['--headless', '--no-sandbox', '--disable-gpu', '--disable-dev-shm-usage', '--remote-debugging-port=0'];
  const browser = execFile(chromium, [...words, `--user-data-dir=${profile}`, address]);
  const late = setTimeout(() => hear({ message: `nothing in ${longest_ms} ms` }), longest_ms);
  browser.on('error', (error) => hear({ message: String(error) }));
  try {
    return await told;
  } finally {
    clearTimeout(late);
    const gone = new Promise((resolve) => { browser.on('exit', resolve); });
    browser.kill();
    await gone;
    server.close();
    server.closeAllConnections();
    await removed(profile);
  }
}

/** Its helpers write for a while after it has gone. */
async function removed(profile) {
  for (let attempt = 0; ; attempt += 1) {
    try {
      rmSync(profile, { recursive: true, force: true });
      return;
    } catch (error) {
      if (attempt === ATTEMPTS) throw error;
      await new Promise((again) => { setTimeout(again, 100); });
    }
  }
}
