// Programs with text by the package and by `trik`: recorded diagrams written in JavaScript and Python, and the world of each.
// Verdict, time, report and trajectory are the same, byte for byte.
//
// usage: node script.mjs PACKAGE TRIK PAGE PLACE...
//
// PAGE is page/app with its modules: the studio's own side of a program is used, and pyodide. Python is a process of seconds for
// each program, so it takes every tenth one only.
import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import vm from 'node:vm';
import { check } from './native.mjs';

const [folder, trik, page, ...places] = process.argv.slice(2);
const studio = await import(join(resolve(folder), 'node.js'));
const root = fileURLToPath(new URL('../..', import.meta.url));
const made = mkdtempSync(join(tmpdir(), 'trik-web-'));
process.on('exit', () => rmSync(made, { recursive: true, force: true }));

/** The studio's own modules, without their types. */
async function modules(...names) {
  const typescript = createRequire(join(resolve(page), 'package.json'))('typescript');
  for (const name of names) {
    const text = readFileSync(join(page, 'src/studio/script', `${name}.ts`), 'utf8');
    const options = { target: 'ES2023', module: 'ESNext', verbatimModuleSyntax: true };
    const { outputText } = typescript.transpileModule(text, { compilerOptions: options });
    writeFileSync(join(made, `${name}.mjs`), outputText.replaceAll(/from '(\.\/\w+)'/g, "from '$1.mjs'"));
  }
  return Promise.all(names.map((name) => import(join(made, `${name}.mjs`))));
}
const [{ Link, Over }, { robot }] = await modules('link', 'brick');
const scripts = ['base', 'codes', 'robot', 'talk'];
const texts = scripts.map((name) => readFileSync(join(root, 'trikd/js', `${name}.js`), 'utf8'));

/** A run of the package by a program that asks; why there is none. */
function run(name, world, options, drive) {
  const begun = studio.script(name, world, options);
  if (!begun.ok) return begun.error.kind;
  const script = begun.value;
  let pictures = 0;
  const link = new Link(script, () => (pictures += 1));
  drive(link);
  const outcome = script.outcome();
  assert.ok(outcome, `${name}: the program has ended, and the run has not`);
  assert.ok(Math.abs(pictures - outcome.ms / 20) <= 2, `${name}: ${pictures} pictures of ${outcome.ms} ms`);
  script.free();
  return outcome;
}

function byJavaScript(name, text) {
  return (link) => {
    const realm = vm.createContext();
    const parts = texts.map((part) => vm.runInContext(part, realm));
    const program = vm.runInContext(`(function(){${studio.runnable(name, text).value}\n})`, realm);
    let code = '0';
    try {
      const own = robot(link, text, parts);
      program.call(vm.runInContext('globalThis', realm));
      if (own.hasEvents) own.loop();
    } catch (error) {
      if (!(error instanceof Over)) {
        link.raw('error', `${error?.name}: ${error?.message}`);
        code = '1';
      }
    }
    link.raw('end', code);
  };
}

const pyodide = join(resolve(page), 'node_modules/pyodide');
const ways = ['page/app/src/studio/script/channel.py', 'trik/src/script/virtual.py'];
const virtual = ways.map((name) => readFileSync(join(root, name), 'utf8')).join('\n');
const trikModule = readFileSync(join(root, 'trikd/src/python/trik.py'), 'utf8');

async function byPython(name, text, seed) {
  const { loadPyodide } = await import(join(pyodide, 'pyodide.mjs'));
  const silent = () => undefined;
  const engine = await loadPyodide({ indexURL: `${pyodide}/`, stdout: silent, stderr: silent });
  return (link) => {
    const ask = (word, said) => link.raw(word, said);
    const program = studio.runnable(name, text).value;
    engine.registerJsModule('trik_link', { ask, module: trikModule, path: `/home/p/${name}`, program, seed });
    engine.runPython(virtual);
  };
}

const of = ({ verdict, failure, ms, totalScore, report, trajectory }) =>
  ({ verdict, failure, ms, totalScore, report, trajectory });

/** Judges a program by both. */
async function compare(what, name, text, world) {
  const [file, field] = [join(made, name), join(made, 'world.xml')];
  writeFileSync(file, text);
  writeFileSync(field, world);
  const { row, report, trajectory } = await check(trik, file, { field, modelSeconds: 60 });
  const options = { modelSeconds: 60, seed: 1, trajectory: true };
  const drive = name.endsWith('.py') ? await byPython(name, text, 1) : byJavaScript(name, text);
  const ours = run(name, world, options, drive);
  const { verdict, failure, ms, total_score: totalScore, printed } = row;
  if (typeof ours === 'string') {
    assert.deepEqual([ours, verdict], ['world', 'broken'], what);
    return verdict;
  }
  if (failure === 'program') {
    // Engines have their own words for mistakes.
    assert.deepEqual([ours.verdict, ours.failure, ours.ms], [verdict, failure, ms], `${what}: ${ours.report} ${report}`);
  } else {
    assert.deepEqual(of(ours), { verdict, failure, ms, totalScore, report, trajectory }, what);
  }
  assert.deepEqual(ours.printed, printed, what);
  return ours.verdict;
}

const counts = {};
let programs = 0;
for (const place of places) {
  const runs = readdirSync(join(place, 'oracle')).filter((name) => name.endsWith('.json'));
  for (const oracle of runs.sort()) {
    const { project, field } = JSON.parse(readFileSync(join(place, 'oracle', oracle), 'utf8'));
    const bytes = new Uint8Array(readFileSync(join(place, project)));
    const opened = studio.open(project, bytes);
    const draft = studio.edit(project, bytes);
    if (!opened.ok || !draft.ok) continue;
    const world = field ? readFileSync(join(place, field), 'utf8') : (draft.value.world() ?? '');
    draft.value.free();
    programs += 1;
    for (const [language, name] of [['javascript', 'p.js'], ['python', 'p.py']]) {
      if (language === 'python' && programs % 10 !== 0) continue;
      const written = opened.value.generate(language);
      // Threads run on a robot and under trik check alone.
      if (!written.ok || world === '' || /Threading|newMessage/.test(written.value.text)) continue;
      const verdict = await compare(`${oracle} in ${language}`, name, written.value.text, world);
      counts[`${language} ${verdict}`] = (counts[`${language} ${verdict}`] ?? 0) + 1;
    }
    opened.value.free();
  }
}
assert.ok((counts['javascript accomplished'] ?? 0) > 20, JSON.stringify(counts));
assert.ok((counts['python accomplished'] ?? 0) > 2, JSON.stringify(counts));
console.log(`programs with text as trik judges them: ${JSON.stringify(counts)}`);
