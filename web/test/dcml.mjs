// Models under Node as `trik dcml` has them: what is wrong with them, other languages, solutions; and rubbish.
//
// usage: node dcml.mjs PACKAGE TRIK
import assert from 'node:assert/strict';
import { execFileSync, spawnSync } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';

const [folder, trik] = process.argv.slice(2);
const dcml = await import(join(resolve(folder), 'node-dcml.js'));
const LANGUAGES = ['rust', 'c', 'java', 'java-hipparchus', 'python', 'lua', 'javascript', 'latex'];
const home = mkdtempSync(join(tmpdir(), 'trik-dcml-'));

/** What is wrong with a file by the program of this computer. */
function native(file) {
  const { stdout } = spawnSync(trik, ['dcml', 'lint', '--json', file], { encoding: 'utf8' });
  const lines = stdout.split('\n').filter(Boolean);
  return lines.map((line) => JSON.parse(line)).map(({ code, severity, line, column, message }) => ({ code, severity, line, column, message }));
}

let texts = 0;
let written = 0;
for (const { name, text } of dcml.shipped()) {
  const file = join(home, `${name}.dcml`);
  writeFileSync(file, text);
  const models = dcml.read(text).value;
  // Every language says the same, or refuses with the same words.
  for (const language of LANGUAGES) {
    const { status, stdout } = spawnSync(trik, ['dcml', 'gen', '--lang', language, '--jacobian', file], { encoding: 'utf8' });
    const there = models.generate(language, undefined, true);
    assert.equal(there.ok, status === 0, `${name} ${language}`);
    if (there.ok) assert.equal(there.value, stdout, `${name} ${language}`);
    written += 1;
  }
  // A letter less somewhere: mostly a mistake, and always the same one.
  for (let at = 7; at < text.length; at += Math.ceil(text.length / 12)) {
    const damaged = text.slice(0, at) + text.slice(at + 1);
    writeFileSync(file, damaged);
    const read = dcml.read(damaged).value;
    const found = read.lint().map(({ code, severity, line, column, message }) => ({ code, severity, line, column, message }));
    assert.deepEqual(found, native(file), `${name} at ${at}`);
    for (const place of [0, at, damaged.length, 1e12, -1, NaN]) {
      read.complete(place);
      read.hover(place);
      read.references(place);
      read.fixes(0, place);
    }
    read.free();
    texts += 1;
  }
  models.free();
}

// A solution has the numbers of `trik dcml sim`.
const drive = dcml.shipped().find(({ name }) => name === 'differential-drive');
const models = dcml.read(drive.text).value;
const [{ names }] = models.models();
const of = (kind) => names.filter((one) => one.kind === kind).map((one) => one.name);
const params = Object.fromEntries(of('parameter').map((name, at) => [name, 0.1 + at / 10]));
const actions = Object.fromEntries(of('action').map((name, at) => [name, 1 + at]));
const file = join(home, 'drive.dcml');
writeFileSync(file, drive.text);
const list = (all) => Object.entries(all).map(([name, value]) => `${name}=${value}`).join(',');
writeFileSync(join(home, 'actions.csv'), `t,${Object.keys(actions).join(',')}\n0,${Object.values(actions).join(',')}\n`);
const told = execFileSync(trik, ['dcml', 'sim', file, '--params', list(params), '--actions', join(home, 'actions.csv'), '--t', '2', '--every', '0.5'], { encoding: 'utf8' });
const [head, ...rows] = told.trim().split('\n').map((line) => line.split(','));
const solved = models.solve({ params, actions: [{ at: 0, ...actions }], seconds: 2, every: 0.5 });
assert.ok(solved.ok, solved.error?.message);
assert.deepEqual(solved.value.columns.map(({ name }) => name), head);
assert.deepEqual(solved.value.rows, rows.map((row) => row.map(Number)));

// Rubbish is an answer.
for (const rubbish of [undefined, null, 5, {}, [], new Uint8Array(3)]) {
  assert.equal(dcml.read(rubbish).ok, false);
  assert.equal(models.generate(rubbish).ok, false);
  assert.equal(models.solve(rubbish).ok, false);
  assert.equal(models.rename(3, rubbish).ok, false);
}
const circle = {};
circle.circle = circle;
assert.throws(() => JSON.stringify(circle));
assert.equal(models.solve(circle).ok, false);
assert.equal(dcml.read('x'.repeat(40 << 20)).ok, false);
assert.equal(dcml.read('BEGIN '.repeat(200_000)).ok, true);
assert.ok(dcml.read(`BEGIN m\nCONFIG x;\nd(x) = ${'('.repeat(100_000)}1;\nEND`).value.lint().length > 0);
rmSync(home, { recursive: true });
console.log(`${written} texts of models, ${texts} damaged ones, and a solution are those of trik dcml`);
