// The package in a Worker of a real browser: it loads, judges, runs, and lives through deep files, whose stack is another
// one than that of Node.
//
// usage: node browser.mjs PACKAGE PROJECT VERDICT [CHROMIUM]
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { inWorker } from './chromium.mjs';

const [folder, project, verdict, chromium = 'chromium'] = process.argv.slice(2);
const LONGEST_MS = 90_000;

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

const file = () => readFileSync(project);
const told = await inWorker({ folder, worker, file, longest_ms: LONGEST_MS, chromium });
const { message, judged, ms, same, deep } = told;
assert.equal(message, undefined);
assert.equal(judged.verdict, verdict);
assert.equal(same, true);
assert.deepEqual(deep, [true, true, true]);
const taken = `judged in ${ms.toFixed(1)} ms once it is warm`;
console.log(`in a Worker of a browser: ${judged.verdict} in ${judged.ms} ms of model time, ${taken}`);
