import { expect, test } from 'vitest';
import type { DrawnBlock, DrawnSheet, PaletteBlock, PortFacts } from '../engine/facts';
import { arranged } from './arrange';
import { iconOf } from './icon';
import { inputFor, portsOf, sideOf, through } from './ports';
import { roomFor } from './room';

const port = (name: string, way: PortFacts['way'], of: PortFacts['of'], x = 0, y = 50): PortFacts => ({
  name,
  way,
  of,
  at: [x, y],
});

const facts = (kind: string, ports: PortFacts[]): PaletteBlock => ({
  kind,
  title: kind,
  category: 'control',
  kits: [],
  isOld: false,
  text: '',
  icon: '',
  size: [100, 100],
  ports,
  properties: [],
});

const motors = facts('Motors', [
  port('CF_IN', 'in', 'unit'),
  port('CF_OUT', 'out', 'unit'),
  port('M3', 'in', 'whole'),
  port('M4', 'in', 'whole'),
]);
const wait = facts('Wait', [
  port('CF_IN', 'in', 'unit'),
  port('DATA', 'in', 'any'),
  port('OUT', 'out', 'any'),
  port('CF_OUT', 'out', 'unit'),
]);
const value = port('OUT', 'out', 'any');
const done = port('CF_OUT', 'out', 'unit');

test('a value means an input for values that is free, and a signal one that starts', () => {
  expect(inputFor(value, motors, new Set())?.name).toBe('M3');
  expect(inputFor(value, motors, new Set([2]))?.name).toBe('M4');
  expect(inputFor(done, motors, new Set())?.name).toBe('CF_IN');
  expect(inputFor(value, facts('Value', [value]), new Set())).toBe(undefined);
  expect(portsOf(motors, 'out').map(({ index }) => index)).toEqual([1]);
});

test('a block goes into a line by ports of its kind', () => {
  expect(through(value, port('M3', 'in', 'whole'), wait)).toEqual([1, 2]);
  expect(through(done, port('CF_IN', 'in', 'unit'), wait)).toEqual([0, 3]);
  expect(through(value, value, facts('Value', [value]))).toBe(undefined);
});

test('a port is at the side that is nearest', () => {
  const size = [100, 100] as const;
  const sides = [
    [2, 50],
    [98, 50],
    [50, 2],
    [50, 98],
  ].map(([x, y]) => sideOf(port('', 'in', 'any', x, y), size));
  expect(sides).toEqual(['left', 'right', 'top', 'bottom']);
});

const block = (id: string, x: number, y: number): DrawnBlock => ({
  id,
  kind: 'DFWaitBlock',
  name: id,
  title: id,
  details: '',
  at: [x, y],
  size: [100, 100],
  properties: {},
  calls: null,
  arguments: [],
});
const link = (from: string, to: string) => ({ id: from + to, from, to, guard: '', path: [] });

test('blocks in order stand in columns and never on each other', () => {
  const blocks = ['a', 'b', 'c', 'd', 'e', 'f'].map((id) => block(id, 0, 0));
  // e and f are a ring into which nothing leads.
  const links = [
    link('a', 'c'),
    link('b', 'c'),
    link('c', 'd'),
    link('d', 'c'),
    link('e', 'f'),
    link('f', 'e'),
  ];
  const places = new Map(arranged({ id: 's', blocks, links }).map(({ id, at }) => [id, at]));
  expect(places.size).toBe(6);
  expect(new Set([...places.values()].map((at) => at.join())).size).toBe(6);
  expect(places.get('a')?.[0]).toBe(places.get('b')?.[0]);
  expect(places.get('c')?.[0]).toBeGreaterThan(places.get('a')?.[0] ?? 0);
});

test('a new block stands where it has room, and nowhere if there is none', () => {
  const sheet: DrawnSheet = { id: 's', blocks: [block('a', 200, 200)], links: [] };
  const seen = { left: 0, top: 0, right: 600, bottom: 500 };
  const [x, y] = roomFor(sheet, [100, 100], seen) ?? [200, 200];
  expect(Math.abs(x - 200) >= 150 || Math.abs(y - 200) >= 150).toBe(true);
  expect(roomFor(sheet, [700, 100], seen)).toBe(undefined);
});

test('a block without a picture has its ports for one', () => {
  expect(iconOf(motors).match(/circle/g)?.length).toBe(4);
  expect(iconOf({ ...motors, icon: '<g/>' })).toBe('<g/>');
});
