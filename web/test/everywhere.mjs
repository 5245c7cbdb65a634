// Recorded runs judged in a Worker of a browser and under Node: verdict, time, score, report and trajectory are the same, bit for
// bit. `judge.mjs` has Node and this computer.
//
// usage: node everywhere.mjs PACKAGE PLACE...
//
// PACKAGE is what web/build.sh has built; each PLACE a folder of recorded runs.
import assert from 'node:assert/strict';
import { createHash } from 'node:crypto';
import { readFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { inWorker } from './chromium.mjs';
import { recorded } from './recorded.mjs';

const [folder, ...places] = process.argv.slice(2);
const studio = await import(join(resolve(folder), 'node.js'));
const LONGEST_MS = 240_000;

/** What of an outcome has to be the same, as a text. The browser is given this text of it. */
function outcome({ verdict, failure, ms, totalScore, report, trajectory, printed }) {
  return JSON.stringify({ verdict, failure, ms, totalScore, report, trajectory, printed });
}
const digest = (text) => createHash('sha256').update(text).digest('hex');

const runs = places.flatMap((place) => recorded(place));
assert.ok(runs.length > 40, `only ${runs.length} runs`);

/** As the package is asked, on either side. */
const options = ({ modelSeconds, field }) => ({
  modelSeconds,
  trajectory: true,
  ...(field ? { field: readFileSync(field, 'utf8') } : {}),
});

const here = runs.map((run) => {
  const opened = studio.open(run.project, new Uint8Array(readFileSync(run.project)));
  if (!opened.ok) return 'not opened';
  const judged = opened.value.judge(options(run));
  opened.value.free();
  return judged.ok ? digest(outcome(judged.value)) : 'not judged';
});

const worker = `import init, { open } from '/package/studio.js';
${outcome}
const digest = async (text) => {
  const bytes = await crypto.subtle.digest('SHA-256', new TextEncoder().encode(text));
  return Array.from(new Uint8Array(bytes), (byte) => byte.toString(16).padStart(2, '0')).join('');
};
try {
  await init();
  const told = [];
  for (let at = 0; at < ${runs.length}; at++) {
    const bytes = new Uint8Array(await (await fetch('/project/' + at)).arrayBuffer());
    const options = await (await fetch('/options/' + at)).json();
    const opened = open(options.name, bytes);
    if (!opened.ok) { told.push('not opened'); continue; }
    const judged = opened.value.judge(options.options);
    opened.value.free();
    told.push(judged.ok ? await digest(outcome(judged.value)) : 'not judged');
  }
  postMessage({ told });
} catch (error) {
  postMessage({ message: String(error.stack ?? error) });
}`;

function file(path) {
  const [, kind, at] = path.split('/');
  const run = runs[Number(at)];
  if (!run) return '';
  return kind === 'project'
    ? readFileSync(run.project)
    : JSON.stringify({ name: run.project, options: options(run) });
}

const { message, told } = await inWorker({ folder, worker, file, longest_ms: LONGEST_MS });
assert.equal(message, undefined);
runs.forEach(({ name }, at) => assert.equal(told[at], here[at], `${name}: another outcome in the browser`));
const judged = here.filter((one) => !one.startsWith('not ')).length;
assert.ok(judged > 40, `only ${judged} judged`);
console.log(`${runs.length} runs, ${judged} judged alike under Node and in a browser, bit for bit`);
