// The package in a Worker of a real browser: it loads, judges, runs, and lives through deep files, whose stack is another
// one than that of Node.
//
// usage: node browser.mjs PACKAGE PROJECT VERDICT [CHROMIUM]
import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { join, normalize } from 'node:path';

const [folder, project, verdict, chromium = 'chromium'] = process.argv.slice(2);
const TYPES = { js: 'text/javascript', wasm: 'application/wasm', html: 'text/html' };
const LONGEST_MS = 90_000;

const page = `<!doctype html><title>package</title><p id="told">nothing</p><script type="module">
const worker = new Worker('/worker.js', { type: 'module' });
worker.onmessage = ({ data }) => fetch('/told', { method: 'POST', body: JSON.stringify(data) });
worker.onerror = ({ message }) => fetch('/told', { method: 'POST', body: JSON.stringify({ message }) });
</script>`;
const worker = `import init, { lint, open } from '/package/studio.js';
const text = (words) => new TextEncoder().encode(words);
try {
  await init();
  const bytes = new Uint8Array(await (await fetch('/project')).arrayBuffer());
  const project = open('task.qrs', bytes).value;
  const judged = project.judge({ trajectory: true }).value;
  const run = project.run({ trajectory: true }).value;
  while (run.tick(10) === 'runs') run.state();
  const deep = [
    lint('a.xml', text('<a>'.repeat(100000))),
    lint('a.flow', text('diagram "a"\\n  A: "Text programming"(IO0 = \`' + '('.repeat(100000) + '\`)\\n')),
    project.judge({ field: '<root>' + '<not>'.repeat(50000) }),
  ].map(({ ok }) => ok);
  const times = [];
  for (let round = 0; round < 11; round++) {
    const began = performance.now();
    project.judge({});
    times.push(performance.now() - began);
  }
  const ms = times.sort((one, other) => one - other)[5];
  postMessage({ judged, ms, same: JSON.stringify(run.outcome()) === JSON.stringify(judged), deep });
} catch (error) {
  postMessage({ message: String(error.stack ?? error) });
}`;

let hear;
const told = new Promise((resolve) => { hear = resolve; });
const server = createServer((request, answer) => {
  const send = (type, body) => answer.writeHead(200, { 'content-type': type }).end(body);
  const path = normalize(request.url);
  if (path === '/told') {
    let body = '';
    request.on('data', (part) => { body += part; });
    request.on('end', () => { send('text/plain', ''); hear(JSON.parse(body)); });
  } else if (path === '/project') {
    send('application/octet-stream', readFileSync(project));
  } else if (path === '/worker.js') {
    send(TYPES.js, worker);
  } else if (path.startsWith('/package/')) {
    send(TYPES[path.split('.').pop()] ?? 'text/plain', readFileSync(join(folder, path.slice('/package/'.length))));
  } else {
    send(TYPES.html, page);
  }
});
await new Promise((resolve) => { server.listen(0, '127.0.0.1', resolve); });
const profile = mkdtempSync(join(tmpdir(), 'trik-web-'));
const address = `http://127.0.0.1:${server.address().port}/`;
// Without a port to be debugged by, a browser without a window ends as soon as the page is there.
const words = ['--headless', '--no-sandbox', '--disable-gpu', '--disable-dev-shm-usage', '--remote-debugging-port=0'];
const browser = execFile(chromium, [...words, `--user-data-dir=${profile}`, address]);
const late = setTimeout(() => hear({ message: `nothing in ${LONGEST_MS} ms` }), LONGEST_MS);
browser.on('error', (error) => hear({ message: String(error) }));
try {
  const { message, judged, ms, same, deep } = await told;
  assert.equal(message, undefined);
  assert.equal(judged.verdict, verdict);
  assert.equal(same, true);
  assert.deepEqual(deep, [true, true, true]);
  const taken = `judged in ${ms.toFixed(1)} ms once it is warm`;
  console.log(`in a Worker of a browser: ${judged.verdict} in ${judged.ms} ms of model time, ${taken}`);
} finally {
  clearTimeout(late);
  const gone = new Promise((resolve) => { browser.on('exit', resolve); });
  browser.kill();
  await gone;
  server.close();
  server.closeAllConnections();
  // Its helpers write for a while after it has gone.
  rmSync(profile, { recursive: true, force: true, maxRetries: 20 });
}
