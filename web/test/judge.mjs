// Recorded runs judged by the package and by `trik`: verdict, report and trajectory are the same, byte for byte; and so are
// findings, sentences and generated programs.
//
// usage: node judge.mjs PACKAGE TRIK OURS [DATA]
//
// PACKAGE is what web/build.sh has built; OURS the folder of our own recorded runs, unpacked; DATA that of real projects.
import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { cpus, tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { check, lint, printed } from './native.mjs';
import { recorded } from './recorded.mjs';

const [folder, trik, ...places] = process.argv.slice(2);
const studio = await import(join(resolve(folder), 'node.js'));

const LANGUAGES = ['python', 'javascript', 'lua', 'c', 'pascal', 'fsharp'];

const bytes = (path) => new Uint8Array(readFileSync(path));

/** What of an outcome has to be the same. */
function outcome({ verdict, failure, ms, totalScore, report, trajectory }) {
  return { verdict, failure, ms, totalScore, report, trajectory };
}

let msHere = 0;

/** Judges one by both; the project, if it could be opened. */
async function compare({ name, project, field, modelSeconds }) {
  const native = await check(trik, project, { field, modelSeconds });
  const opened = studio.open(project, bytes(project));
  if (!opened.ok) {
    assert.equal(native.row.verdict, 'broken', `${name}: only the package cannot open it`);
    return undefined;
  }
  const options = { modelSeconds, trajectory: true };
  if (field) {
    options.field = readFileSync(field, 'utf8');
  }
  const began = performance.now();
  const answer = opened.value.judge(options);
  msHere += performance.now() - began;
  assert.ok(answer.ok, `${name}: ${JSON.stringify(answer)}`);
  const { row, report, trajectory } = native;
  const { verdict, failure, ms, total_score: totalScore } = row;
  const theirs = { verdict, failure, ms, totalScore, report, trajectory };
  assert.deepEqual(outcome(answer.value), theirs, name);
  assert.deepEqual(answer.value.printed, row.printed, name);
  return { project: opened.value, options, judged: answer.value };
}

/** The same run tick by tick, without a debugger and with one. */
function byTicks(name, { project, options, judged }) {
  for (const debug of [false, true]) {
    const begun = project.run({ ...options, debug });
    if (!begun.ok) {
      assert.equal(judged.verdict, 'broken', name);
      continue;
    }
    const run = begun.value;
    let ticks = 0;
    while (run.tick(7) === 'runs') {
      ticks += 1;
      if (ticks % 20 === 0) {
        const state = run.state();
        assert.equal(state.progress, 'runs', name);
        assert.ok(state.world.robots.length > 0, name);
      }
    }
    assert.equal(run.progress(), 'over', name);
    assert.deepEqual(outcome(run.outcome()), outcome(judged), `${name}: tick by tick, debug ${debug}`);
    const end = run.trail(0).length / 4;
    assert.ok(judged.ms === 0 || end >= judged.ms / 10, `${name}: ${end} places in ${judged.ms} ms`);
    run.free();
  }
}

/** A few at once: `trik` is a process for each. */
async function each(all, work) {
  const rest = all.slice();
  const one = async () => {
    for (let next = rest.pop(); next !== undefined; next = rest.pop()) {
      await work(next);
    }
  };
  await Promise.all(cpus().map(one));
}

/** Worlds of the examples with realistic physics, sensors and motors, in which sines and noise count. */
async function judgeRealistic() {
  const examples = fileURLToPath(new URL('../../examples', import.meta.url));
  const project = join(examples, 'diagrams/line.qrs');
  const worlds = readdirSync(join(examples, 'dataflow')).filter((name) => name.endsWith('.xml'));
  assert.ok(worlds.length > 3);
  const made = mkdtempSync(join(tmpdir(), 'trik-web-'));
  try {
    const runs = worlds.map((world) => {
      const text = readFileSync(join(examples, 'dataflow', world), 'utf8');
      const realistic = text.replace(/(realistic\w+)="false"/g, '$1="true"');
      assert.notEqual(realistic, text, `${world} has no settings`);
      const field = join(made, world);
      writeFileSync(field, realistic);
      return { name: `${world}, realistic`, project, field, modelSeconds: 30 };
    });
    let places = 0;
    await each(runs, async (run) => {
      const found = await compare(run);
      assert.ok(found, run.name);
      places += found.judged.trajectory.length;
      found.project.free();
    });
    assert.ok(places > 10_000, `only ${places} characters of trajectories`);
    console.log(`${runs.length} realistic runs judged alike`);
  } finally {
    rmSync(made, { recursive: true });
  }
}

async function judgeAll(place) {
  const runs = recorded(place);
  assert.ok(runs.length > 40, `only ${runs.length} runs in ${place}`);
  let compared = 0;
  let stepped = 0;
  await each(runs, async (run) => {
    const found = await compare(run);
    if (found) {
      compared += 1;
      // What is slow is tried on a part.
      if (compared % 4 === 0) {
        byTicks(run.name, found);
        stepped += 1;
      }
      found.project.free();
    }
  });
  console.log(`${place}: ${runs.length} runs, ${compared} judged alike, ${stepped} of them tick by tick too`);
  return [...new Set(runs.map((run) => run.project))].sort();
}

async function lintAll(files) {
  const theirs = new Map(files.map((file) => [file, []]));
  for (const finding of await lint(trik, files)) {
    theirs.get(finding.file).push(finding);
  }
  let count = 0;
  for (const file of files) {
    const answer = studio.lint(file, bytes(file));
    assert.ok(answer.ok, file);
    assert.deepEqual(answer.value, theirs.get(file), file);
    count += answer.value.length;
  }
  console.log(`${files.length} files, ${count} findings alike`);
}

async function writeAll(files) {
  let count = 0;
  await each(files, async (file) => {
    const opened = studio.open(file, bytes(file));
    if (!opened.ok) {
      return;
    }
    const same = async (answer, words) => {
      const theirs = await printed(trik, words);
      assert.equal(answer.ok ? (answer.value.text ?? answer.value) : null, theirs, words.join(' '));
      count += 1;
    };
    await same(opened.value.show({ locale: 'ru' }), ['show', file, '--language', 'ru']);
    for (const language of LANGUAGES) {
      await same(opened.value.generate(language), ['gen', file, '--lang', language]);
    }
    opened.value.free();
  });
  console.log(`${files.length} projects, ${count} texts alike`);
}

for (const [index, place] of places.entries()) {
  const projects = await judgeAll(place);
  await lintAll(projects);
  // Each is a process of `trik`: our own are many, and some of them are enough.
  await writeAll(projects.filter((_, number) => number % (index === 0 ? 12 : 2) === 0));
}
await judgeRealistic();
const memory = studio.initSync().memory.buffer.byteLength;
console.log(`judged in ${Math.round(msHere)} ms here; ${(memory / 2 ** 20).toFixed(1)} MiB of memory`);
