import { expect, test } from 'vitest';
import type { DrawnBlock, DrawnLink, DrawnSheet, Finding, NameFacts, PaletteBlock } from '../engine/facts';
import { beside } from './around';
import { type Drawn, type Fix, fixesOf } from './fixes';
import { distance, nameAt, nearNames, replaced } from './names';

const block = (
  id: string,
  kind: string,
  x: number,
  y = 0,
  properties: Record<string, string> = {},
): DrawnBlock => ({
  id,
  kind,
  name: id,
  title: id,
  details: '',
  at: [x, y],
  size: [50, 50],
  properties,
  calls: null,
  arguments: [],
});
const link = (from: string | null, to: string | null, guard = ''): DrawnLink => ({
  id: `${from}-${to}`,
  from,
  to,
  guard,
  path: [],
});
const sheetOf = (blocks: DrawnBlock[], links: DrawnLink[]): DrawnSheet => ({ id: 'd', blocks, links });

const property = (
  name: string,
  byDefault: string,
  choices: string[] | null = null,
): PaletteBlock['properties'][number] => ({
  name,
  title: `${name}, for people`,
  found: `${name} in findings`,
  default: byDefault,
  takes: 'expression',
  choices,
  choiceTitles: choices,
});
const PROPERTIES: Record<string, PaletteBlock['properties']> = {
  Function: [{ ...property('Body', ''), takes: 'statements' }],
  Timer: [property('Delay', '1000')],
  TrikV6EnginesStop: [property('Mode', 'float', ['brake', 'float']), property('Ports', 'M1')],
};
const facts = (kind: string): PaletteBlock => ({
  kind,
  title: kind,
  category: 'algorithms',
  kits: [],
  isOld: false,
  text: '',
  icon: '',
  properties: PROPERTIES[kind] ?? [],
});
const NAMES: NameFacts[] = [
  { name: 'speed', is: 'variable' },
  { name: 'sensorA1', is: 'sensor' },
  { name: 'pi', is: 'constant' },
];

const finding = (object: string, more: Partial<Finding> = {}): Finding => ({
  file: 'a.qrs',
  level: 'error',
  message: 'what people read',
  part: null,
  diagram: null,
  object,
  block: null,
  property: null,
  line: null,
  column: null,
  ...more,
});
const drawn = (sheet: DrawnSheet): Drawn => ({
  sheet,
  names: NAMES,
  parameters: ['far'],
  subprograms: [],
  facts,
});
const titles = (fixes: Fix[]): string[] => fixes.map(({ title }) => title);
/** What a fix changes, if each of its changes makes something that is called `new`. */
const changes = (fix: Fix | undefined) =>
  fix?.steps.map((step) => (typeof step === 'function' ? step(['new']) : step));

test('a block that leads nowhere is connected, best to one to which nothing leads, or to an end', () => {
  const sheet = sheetOf(
    [
      block('begin', 'InitialNode', 0),
      block('wait', 'Timer', 100),
      block('near', 'Timer', 200),
      block('end', 'FinalNode', 900),
    ],
    [link('begin', 'wait'), link('near', 'near')],
  );
  const fixes = fixesOf(finding('wait'), drawn(sheet));
  expect(titles(fixes)).toEqual(['Connect to end', 'Add an end']);
  expect(changes(fixes[0])).toEqual([{ do: 'connect', from: 'wait', to: 'end', guard: '' }]);
  expect(changes(fixes[1])).toEqual([
    {
      do: 'add',
      diagram: 'd',
      blocks: [{ kind: 'FinalNode', at: [100, 120], name: 'FinalNode' }],
      links: [],
    },
    { do: 'connect', from: 'wait', to: 'new', guard: '' },
  ]);
});

test('a condition with one link gets the other one, with its guard', () => {
  const sheet = sheetOf(
    [block('if', 'IfBlock', 0), block('a', 'Timer', 100), block('end', 'FinalNode', 200)],
    [link('if', 'a', 'true'), link('a', 'end')],
  );
  expect(changes(fixesOf(finding('if'), drawn(sheet))[0])).toEqual([
    { do: 'connect', from: 'if', to: 'end', guard: 'false' },
  ]);
});

test('a block to which nothing leads is connected from one that leads nowhere, or goes', () => {
  const sheet = sheetOf(
    [block('begin', 'InitialNode', 0), block('a', 'Timer', 100), block('end', 'FinalNode', 110)],
    [link('begin', 'a')],
  );
  const fixes = fixesOf(finding('end', { level: 'note' }), drawn(sheet));
  expect(titles(fixes)).toEqual(['Connect from a', 'Remove end']);
  expect(changes(fixes[1])).toEqual([{ do: 'remove', ids: ['end'] }]);
});

test('links of a condition without guards are marked either way, and a good condition has no mend', () => {
  const blocks = [block('if', 'IfBlock', 0), block('a', 'Timer', 100), block('b', 'Timer', 100, 100)];
  const found = (one: string, other: string) =>
    fixesOf(
      finding('if'),
      drawn(sheetOf(blocks, [link('b', 'if'), link('if', 'a', one), link('if', 'b', other)])),
    );
  expect(titles(found('', ''))).toEqual(['The link to a is true', 'The link to b is true']);
  expect(changes(found('', '')[1])).toEqual([
    { do: 'set', id: 'if-a', property: 'Guard', value: 'false' },
    { do: 'set', id: 'if-b', property: 'Guard', value: 'true' },
  ]);
  expect(changes(found('true', 'true')[0])).toEqual([
    { do: 'set', id: 'if-b', property: 'Guard', value: 'false' },
  ]);
  expect(found('true', '')).toEqual([]);
  expect(found('True', 'false')).toEqual([]);
});

test('the body of a loop is one of its links', () => {
  const blocks = [block('loop', 'Loop', 0), block('a', 'Timer', 100), block('end', 'FinalNode', 200)];
  const sheet = sheetOf(blocks, [
    link('a', 'loop'),
    link('loop', 'a', 'iteration'),
    link('loop', 'end', 'iteration'),
  ]);
  const fixes = fixesOf(finding('loop'), drawn(sheet));
  expect(titles(fixes)).toEqual(['The link to a is iteration', 'The link to end is iteration']);
  expect(changes(fixes[0])).toEqual([{ do: 'set', id: 'loop-end', property: 'Guard', value: '' }]);
});

test('a name that nobody knows is replaced where it stands, or has a value first', () => {
  const text = 'x = 1;\ny = spede + spede';
  const sheet = sheetOf(
    [
      block('begin', 'InitialNode', 0),
      block('wait', 'Timer', 300, 0, { Delay: text }),
      block('end', 'FinalNode', 900),
    ],
    [link('begin', 'wait'), link('wait', 'end')],
  );
  const at = { property: 'Delay in findings', line: 2, column: 5 };
  const fixes = fixesOf(finding('wait', at), drawn(sheet));
  expect(titles(fixes)).toEqual(['Write speed for spede', 'Begin with spede = 0']);
  expect(changes(fixes[0])).toEqual([
    { do: 'set', id: 'wait', property: 'Delay', value: 'x = 1;\ny = speed + spede' },
  ]);
  expect(changes(fixes[1])?.[0]).toMatchObject({
    do: 'insert',
    link: 'begin-wait',
    block: { kind: 'VariableInit', properties: { variable: 'spede', value: '0' } },
  });
  expect(fixesOf(finding('wait', { ...at, line: 1, column: 5 }), drawn(sheet))).toEqual([]);
  // What is known there is another mistake: a sensor, a parameter, what a block gives a value.
  const known = (value: string) => {
    const blocks = sheet.blocks.map((one) =>
      one.id === 'wait' ? { ...one, properties: { Delay: value } } : one,
    );
    const body = block('body', 'Function', 500, 0, { Body: 'speed == 2; heat[0] = 3; u += 1' });
    const more = { ...sheet, blocks: [...blocks, body] };
    return fixesOf(finding('wait', { ...at, line: 1, column: 1 }), drawn(more)).length === 0;
  };
  expect(['sensorA1', 'far', 'heat', 'u'].map(known)).toEqual([true, true, true, true]);
  expect(known('speed')).toBe(false);
});

test('nothing where something has to be, and a word that a choice lacks, become what they are at first', () => {
  const stop = block('stop', 'TrikV6EnginesStop', 0, 0, { Mode: 'fast', Ports: '' });
  const sheet = sheetOf([stop, block('end', 'FinalNode', 100)], [link('end', 'stop'), link('stop', 'end')]);
  expect(titles(fixesOf(finding('stop', { property: 'Mode' }), drawn(sheet)))).toEqual([
    'Put float into Mode, for people',
  ]);
  expect(changes(fixesOf(finding('stop'), drawn(sheet))[1])).toEqual([
    { do: 'set', id: 'stop', property: 'Ports', value: 'M1' },
  ]);
});

test('links that are too many, or hang loose, go', () => {
  const blocks = [block('a', 'Timer', 0), block('b', 'Timer', 100), block('end', 'FinalNode', 200)];
  const many = sheetOf(blocks, [link('a', 'b'), link('a', 'end'), link('b', 'a')]);
  expect(titles(fixesOf(finding('a'), drawn(many)))).toEqual([
    'Remove the link to b',
    'Remove the link to end',
  ]);
  const loose = sheetOf(blocks, [link('a', null), link('a', 'b'), link('b', 'a')]);
  expect(changes(fixesOf(finding('a-null'), drawn(loose))[0])).toEqual([{ do: 'remove', ids: ['a-null'] }]);
});

test('a diagram without a beginning gets one, and what is on no sheet has no mend', () => {
  const sheet = sheetOf([block('a', 'Timer', 300), block('end', 'FinalNode', 400)], [link('a', 'end')]);
  expect(changes(fixesOf(finding('d'), drawn(sheet))[0])).toEqual([
    {
      do: 'add',
      diagram: 'd',
      blocks: [{ kind: 'InitialNode', at: [180, 0], name: 'InitialNode' }],
      links: [],
    },
    { do: 'connect', from: 'new', to: 'a', guard: '' },
  ]);
  expect(fixesOf(finding('elsewhere'), drawn(sheet))).toEqual([]);
  expect(fixesOf({ ...finding(''), object: null }, drawn(sheet))).toEqual([]);
});

test('a call of nothing calls a subprogram', () => {
  const sheet = sheetOf([block('call', 'Subprogram', 0)], [link('call', 'call'), link('call', 'call')]);
  const fixes = fixesOf(finding('call'), { ...drawn(sheet), subprograms: [{ id: 's', name: 'turn' }] });
  expect(changes(fixes.find(({ title }) => title === 'Call turn'))).toEqual([
    { do: 'call', id: 'call', diagram: 's' },
  ]);
});

test('names are found by their place and by what is near', () => {
  expect(nameAt('a = \u0441\u043a\u043e\u0440(1)', 1, 5)).toEqual({
    name: '\u0441\u043a\u043e\u0440',
    isCall: true,
  });
  expect(nameAt('a = 1', 1, 5)).toBe(undefined);
  expect(nameAt('a', 7, 5)).toBe(undefined);
  // A letter outside of the first plane is one column.
  expect(replaced('"\u{1f600}" + n', 1, 7, 'n', 'speed')).toBe('"\u{1f600}" + speed');
  expect(distance('abc', 'acb', 2)).toBe(1);
  expect(distance('abc', 'abcdef', 2)).toBe(3);
  expect(nearNames('Speed', NAMES)).toEqual(['speed']);
  expect(nearNames('sensrA1', NAMES)).toEqual(['sensorA1']);
  expect(nearNames('xyz', NAMES)).toEqual([]);
});

test('a new block stands where no other one is', () => {
  const sheet = sheetOf([block('a', 'Timer', 0), block('b', 'Timer', 120), block('c', 'Timer', 0, 120)], []);
  const [first] = sheet.blocks;
  expect(first && beside(sheet, first)).toEqual([120, 120]);
});
