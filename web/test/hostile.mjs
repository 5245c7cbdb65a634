// Files and arguments that nobody should give to the package: each is answered with an error, and the module lives on.
//
// usage: node hostile.mjs PACKAGE PROJECT...
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { crc32, deflateRawSync } from 'node:zlib';

const [folder, ...projects] = process.argv.slice(2);
const studio = await import(join(resolve(folder), 'node.js'));
const memory = studio.initSync().memory;
const text = (words) => new TextEncoder().encode(words);

/** Numbers that are the same in each run. */
function random(seed) {
  let state = seed;
  return (below) => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return Math.floor((state / 2 ** 32) * below);
  };
}

/** What a person may draw in a file, whatever is in it: each change is taken back without a trace. */
function drawn(name, bytes) {
  const begun = studio.edit(name, bytes);
  if (!begun.ok) return;
  const draft = begun.value;
  const [first] = draft.about().diagrams;
  const before = JSON.stringify(draft.sheet(first?.id ?? ''));
  const blocks = draft.sheet(first?.id ?? '')?.blocks.map(({ id }) => id) ?? [];
  const changes = [
    { do: 'add', diagram: first?.id, ...draft.copy(blocks.slice(0, 20)).value },
    { do: 'move', places: blocks.slice(0, 5).map((id, at) => ({ id, at: [at * 50, -at] })) },
    { do: 'connect', from: blocks[0], to: blocks.at(-1), guard: '<&>' },
    { do: 'remove', ids: blocks.slice(0, 3) },
    { do: 'removeDiagram', diagram: first?.id },
    { do: 'world', text: '<root>' },
    { do: 'set', id: blocks[0], property: 'from', value: 'qrm:/' },
  ];
  for (const change of changes) draft.apply(change);
  draft.lint();
  draft.names();
  const saved = draft.save();
  // A text of data flow has become a project with another name.
  assert.ok(!saved.ok || studio.edit(draft.about().name, saved.value).ok, name);
  while (draft.undo());
  assert.equal(JSON.stringify(draft.sheet(first?.id ?? '')), before, name);
  draft.free();
}

/** All that can be asked of a file, in bounded time. */
function everything(name, bytes, options = {}) {
  assert.equal(studio.lint(name, bytes).ok, true, name);
  drawn(name, bytes);
  const opened = studio.open(name, bytes);
  if (!opened.ok) {
    assert.ok(opened.error.problems.length > 0 && opened.error.problems[0].message, name);
    return false;
  }
  const project = opened.value;
  project.about();
  project.show();
  project.show({ picture: true, locale: 'ru' });
  for (const language of ['python', 'c', 'lua']) {
    project.generate(language);
  }
  const bounded = { modelSeconds: 1, wallSeconds: 5, ...options };
  assert.equal(project.judge(bounded).ok, true, name);
  const begun = project.run({ ...bounded, debug: true });
  if (begun.ok) {
    const run = begun.value;
    for (const order of ['attach', 'pause', 'look', 'evaluate 1 + 1', 'step in', 'back step', 'rubbish', 'continue']) {
      assert.equal(run.order(order).ok, true, order);
      run.tick(20);
      run.state();
    }
    run.reports();
    run.end();
    run.free();
  }
  project.free();
  return true;
}

// Damaged saves: bytes changed, parts left out, ends cut off.
const pick = random(1);
let opened = 0;
let tried = 0;
for (const path of projects) {
  const whole = new Uint8Array(readFileSync(path));
  assert.equal(everything(path, whole), true, path);
  for (let round = 0; round < 40; round += 1) {
    let bytes = whole.slice();
    for (let change = 0; change <= pick(4); change += 1) {
      bytes[pick(bytes.length)] = pick(256);
    }
    if (round % 4 === 1) {
      bytes = bytes.slice(0, pick(bytes.length));
    } else if (round % 4 === 2) {
      const from = pick(bytes.length);
      bytes.copyWithin(from, from + pick(200));
    }
    tried += 1;
    opened += everything(path, bytes) ? 1 : 0;
  }
}
console.log(`${tried} damaged saves, ${opened} of them could still be opened`);

/** A zip of entries that are packed already. */
function zip(entries) {
  const parts = [];
  const directory = [];
  let at = 0;
  for (const [name, packed, size, crc] of entries) {
    const fields = (bytes, ...all) => all.forEach(([offset, length, value]) => bytes.writeUIntLE(value, offset, length));
    const label = Buffer.from(name);
    const local = Buffer.alloc(30);
    fields(local, [0, 4, 0x04034b50], [4, 2, 20], [8, 2, 8], [14, 4, crc], [18, 4, packed.length], [22, 4, size], [26, 2, label.length]);
    const central = Buffer.alloc(46);
    fields(central, [0, 4, 0x02014b50], [4, 2, 20], [6, 2, 20], [10, 2, 8], [16, 4, crc], [20, 4, packed.length], [24, 4, size], [28, 2, label.length], [42, 4, at]);
    parts.push(local, label, packed);
    directory.push(central, label);
    at += 30 + label.length + packed.length;
  }
  const length = directory.reduce((sum, one) => sum + one.length, 0);
  const end = Buffer.alloc(22);
  end.writeUInt32LE(0x06054b50, 0);
  end.writeUInt16LE(entries.length, 8);
  end.writeUInt16LE(entries.length, 10);
  end.writeUInt32LE(length, 12);
  end.writeUInt32LE(at, 16);
  return new Uint8Array(Buffer.concat([...parts, ...directory, end]));
}

// Little that unpacks to much.
const zeros = Buffer.alloc(200 << 20);
const bomb = deflateRawSync(zeros);
const sum = crc32 ? crc32(zeros) : 0;
for (const name of ['metaInfo.xml', 'tree/logical/a', 'worldModel.xml']) {
  everything('bomb.qrs', zip([[name, bomb, zeros.length, sum]]));
  everything('lies.qrs', zip([[name, bomb, 10, sum]]));
}

// Worlds and texts that nest deeply, are long, or have numbers that are none.
const deep = '<a>'.repeat(100_000);
const worlds = [
  deep,
  `<root><world><walls>${'<wall begin="0:0" end="1:1"/>'.repeat(50_000)}</walls></world></root>`,
  '<root><world><walls><wall id="w" begin="NaN:1e999" end="inf:-1e308"/></walls></world></root>',
  `<root><constraints><event>${'<condition glue="and">'.repeat(5_000)}`,
  `<root><constraints><event settedUpInitially="true"><condition>${'<not>'.repeat(3_000)}${'</not>'.repeat(3_000)}</condition></event></constraints></root>`,
  `<!DOCTYPE a [<!ENTITY b "bbbb"><!ENTITY c "${'&b;'.repeat(1000)}">]><root>${'&c;'.repeat(1000)}</root>`,
  `<root a="${'x'.repeat(4 << 20)}"/>`,
  '\u0000<root/>',
];
const [first] = projects;
for (const world of worlds) {
  everything('world.xml', text(world));
  everything(first, new Uint8Array(readFileSync(first)), { field: world });
}
const nested = (count) => `${'('.repeat(count)}1${')'.repeat(count)}`;
const flows = [
  'diagram "a"\n',
  `diagram "a"\n  A: "Text programming"(IO0 = \`${nested(100_000)}\`)\n`,
  `diagram "a"\n${'  A: Sensor(VarName = sensorD1)\n'.repeat(20_000)}`,
  `diagram "${'a'.repeat(1 << 20)}"\n`,
  '\u0000\uffff',
];
for (const flow of flows) {
  everything('program.flow', text(flow));
}
everything('program.flow', new Uint8Array([0xff, 0xfe, 0x00]));
everything('empty.qrs', new Uint8Array());
everything('zeros.qrs', new Uint8Array(1 << 20));

// Arguments of other kinds than they should be.
const circle = {};
circle.self = circle;
const throwing = { get locale() { throw new Error('no'); } };
const strange = [null, 1, 'x', [], circle, throwing, Symbol('a'), () => 1, 10n, { locale: 5 }, { unknown: 1 }, { field: {} },
  { seed: -1 }, { seed: NaN }, { modelSeconds: 1e9 }, { inputs: 'a' }, { inputs: new Array(20_000).fill('') }, { gamepad: 'x' },
  { toJSON: () => undefined }, { field: 'x'.repeat(60 << 20) }];
const good = new Uint8Array(readFileSync(first));
const project = studio.open(first, good).value;
const draft = studio.edit(first, good).value;
let refused = 0;
for (const one of strange) {
  for (const answer of [
    studio.lint(one, one, one), studio.lint('a.qrs', one), studio.open('a.qrs', one), studio.open(one, good),
    studio.open(first, good, one), studio.lint(first, good, one), project.show(one), project.generate(one),
    project.generate('python', one), project.run({ modelSeconds: 1, ...(typeof one === 'object' && one !== throwing ? one : {}) }),
    project.judge(one === null ? { modelSeconds: 1, x: 1 } : one),
    studio.edit(one, good), studio.edit(first, one), studio.blank(one), studio.blank('a', { kit: one ?? 1 }), draft.apply(one),
    draft.apply({ do: one }), draft.apply({ do: 'add', diagram: one, blocks: one, links: one }),
    studio.script(one, one, one), studio.script('p.js', '', one), studio.script('p.py', one), studio.runnable(one, one),
    draft.apply({ do: 'move', places: [{ id: one, at: one }] }), draft.copy(one), draft.project(one), studio.palette(one),
  ]) {
    assert.equal(typeof answer.ok, 'boolean');
    if (!answer.ok) {
      refused += 1;
      assert.ok(answer.error.kind && answer.error.problems.length > 0);
    }
  }
}
const long = 'x'.repeat(100 << 20);
for (const answer of [studio.open(long, good), project.generate(long), studio.open('a.qrs', new Uint8Array(64 << 20))]) {
  assert.equal(answer.error.kind, 'request');
}
const run = project.run({ debug: true }).value;
for (const one of [...strange, long, '', '\u0000', 'break', 'evaluate '.repeat(1000)]) {
  assert.equal(typeof run.order(one).ok, 'boolean');
}
for (const count of [-1, NaN, Infinity, 1e12, 0.5]) {
  run.tick(count);
  run.trail(count);
}
run.free();
// Questions that are none, in any order, answer something; the run goes on to its limit of model time.
const asking = studio.script('p.js', '', { modelSeconds: 5 }).value;
const words = ['read', 'write', 'has', 'names', 'event', 'wait', 'listen', 'drain', 'draw', 'mailbox', 'random', 'append', 'file', '',
  'remove', 'input', 'at', 'gone', 'take', 'system', 'stream', 'print', 'nonsense'];
const said = [...strange.filter((one) => typeof one !== 'symbol'), '', 'gamepad/text/device', 'motors/M1/value\n1e999', '../../etc',
  '-1e308 1e308', 'x'.repeat(1 << 19), '\u0000\n\ud800', long];
let asked = 0;
for (let round = 0; asking.outcome() === undefined; round += 1) {
  for (const word of [...words, ...strange, long]) {
    const text = said[(asked + round) % said.length];
    const told = asking.ask(word, text, asked % 3 === 0 ? -1 : 100);
    assert.match(told, /^(ok|no):\d+:|^(later|over)$/);
    if (told === 'later') asking.goOn(3);
    asked += 1;
  }
}
asking.state();
assert.equal(asking.goOn(NaN), 'over');
asking.free();
project.free();
assert.equal(draft.sheet(long), null);
draft.free();
assert.ok(refused > 100, `only ${refused}`);

// It still does what it should.
assert.equal(everything(first, good), true);
const mib = memory.buffer.byteLength / 2 ** 20;
assert.ok(mib < 800, `${mib} MiB`);
console.log(`${refused} strange arguments refused; ${mib.toFixed(1)} MiB of memory at the end`);
