import { expect, test } from 'vitest';
import type { DrawnBlock, DrawnSheet } from '../engine/facts';
import { arranged } from './arrange';
import { completed } from './complete';
import { guardOfNext } from './guards';
import { linkAt, roomIn } from './near';
import { pieceOf } from './piece';
import { wayOf } from './way';

const block = (id: string, x: number, y: number, kind = 'Timer'): DrawnBlock => ({
  id,
  kind,
  name: id,
  title: id,
  details: '',
  at: [x, y],
  size: [50, 50],
  properties: {},
  calls: null,
  arguments: [],
});
const link = (from: string, to: string, guard = '') => ({ id: `${from}-${to}`, from, to, guard, path: [] });
const sheet: DrawnSheet = {
  id: 'd',
  blocks: [block('a', 0, 0, 'InitialNode'), block('b', 300, 0), block('c', 300, 100)],
  links: [link('a', 'b'), link('b', 'c')],
};

test('a place on a link is on that link, and one beside it on none', () => {
  expect(linkAt(sheet, [150, 30])).toBe('a-b');
  expect(linkAt(sheet, [320, 80])).toBe('b-c');
  expect(linkAt(sheet, [150, 60])).toBe(undefined);
  expect(linkAt(sheet, [600, 25])).toBe(undefined);
});

test('a block in a link stands in its middle, or below it where there is no room', () => {
  const [long, short] = sheet.links;
  expect(long && roomIn(sheet, long)).toEqual([150, 0]);
  expect(short && roomIn(sheet, short)).toEqual([300, 150]);
});

test('blocks in order go from left to right, and on below', () => {
  const count = 45;
  const names = Array.from({ length: count }, (_, at) => `n${at}`);
  const blocks = names.map((id, at) => block(id, 7, 7, at === 0 ? 'InitialNode' : 'Timer'));
  const links = names.slice(1).map((id, at) => link(names[at] ?? '', id));
  const places = arranged({ id: 'd', blocks, links: [...links, link('n44', 'n1')] });
  expect(new Set(places.map(({ at }) => at.join())).size).toBe(count);
  expect(places[1]?.at).toEqual([225, 100]);
  expect(places[20]?.at).toEqual([100, 225]);
  expect(Math.max(...places.map(({ at }) => at[0]))).toBeLessThan(2600);
});

test('names are offered for what is typed, and not within quotes', () => {
  const names = [
    { name: 'sensorA1', is: 'sensor' },
    { name: 'sin', is: 'function' },
    { name: 'side', is: 'variable' },
  ] as const;
  expect(completed('x = si', 6, names).map(({ name }) => name)).toEqual(['side', 'sin(']);
  expect(completed('x = si', 4, names)).toEqual([]);
  expect(completed('"si', 3, names)).toEqual([]);
  expect(completed("'\\'si", 5, names)).toEqual([]);
  expect(completed('side', 4, names)).toEqual([]);
});

test('the next link of a block that decides has the guard that is left', () => {
  expect(guardOfNext('IfBlock', [])).toBe('true');
  expect(guardOfNext('IfBlock', [link('a', 'b', 'TRUE')])).toBe('false');
  expect(guardOfNext('IfBlock', [link('a', 'b', 'true'), link('a', 'c', 'false')])).toBe('');
  expect(guardOfNext('Timer', [])).toBe('');
});

test('a text is blocks only if it is', () => {
  const text = '{"blocks": [{"kind": "Timer", "at": [1, 2]}], "links": []}';
  expect(pieceOf(text)?.blocks.length).toBe(1);
  for (const other of [
    '',
    '1',
    '{}',
    '{"blocks": [], "links": []}',
    text.replace('[1, 2]', '[1]'),
    text.replace('1,', 'null,'),
  ])
    expect(pieceOf(other)).toBe(undefined);
});

test('a link leaves and enters boxes at their edges', () => {
  const [from, to] = [0, 200].map((x) => ({ x, y: 0, width: 50, height: 50 }));
  if (!from || !to) throw new Error('no boxes');
  expect(wayOf(from, to, [], false).d).toBe('M50 25L200 25');
  const back = wayOf(from, to, [], true).label;
  expect(back[1]).not.toBe(25);
  expect(wayOf(from, from, [], false).ends[0]).toEqual([50, 25]);
});
