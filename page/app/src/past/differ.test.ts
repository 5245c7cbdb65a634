import { expect, it } from 'vitest';
import { compare, firstDifference, type Row, type Side } from './differ';

const row = (...pairs: [number, number | string][]): Row => ({
  times: pairs.map(([time]) => time),
  values: pairs.map(([, value]) => value),
});

function side(begin: number, end: number, nodes: Record<string, Row>): Side {
  return { begin, end, paths: Object.keys(nodes), rows: (path) => new Map([['v', nodes[path] ?? row()]]) };
}

it('a change that comes a little later is the same, and one that comes much later is none', () => {
  const here = row([0, 0], [5, 33], [8, 0]);
  expect(firstDifference(here, row([0, 0], [5.09, 33], [7.95, 0]), 0, 0, 10)).toBeUndefined();
  expect(firstDifference(here, row([0, 0], [5.3, 33], [8, 0]), 0, 0, 10)).toMatchObject({
    time: 5,
    here: 33,
    there: 0,
  });
  expect(firstDifference(here, row([0, 0], [4, 33], [8, 0]), 0, 0, 10)).toMatchObject({
    time: 4,
    here: 0,
    there: 33,
  });
  expect(firstDifference(here, row([0, 0]), 0, 0, 4)).toBeUndefined();
});

it('a number that another one passes is the same', () => {
  const ramp = (later: number) =>
    row(...Array.from({ length: 100 }, (_, at) => [at / 10 + later, at] as [number, number]));
  expect(firstDifference(ramp(0), ramp(0.05), 0, 0.2, 9)).toBeUndefined();
  expect(firstDifference(ramp(0), ramp(0.5), 0, 1, 9)).toBeDefined();
  expect(firstDifference(ramp(0), ramp(0.5), -0.5, 1, 9)).toBeUndefined();
});

it('a constant that is another one differs from the beginning on, and a gap from a value', () => {
  expect(firstDifference(row([0, 1]), row([0.5, 2]), 0, 0, 10)).toEqual({ time: 0.5, here: 1, there: 2 });
  expect(firstDifference(row([0, 1], [3, NaN]), row([0, 1]), 0, 0, 10)).toEqual({
    time: 3,
    here: NaN,
    there: 1,
  });
  expect(firstDifference(row([0, 1], [3, NaN]), row([0, 1], [3.05, NaN]), 0, 0, 10)).toBeUndefined();
  expect(firstDifference(row([0, 'a'], [2, 'b']), row([0, 'a'], [2, 'c']), 0, 0, 10)).toMatchObject({
    time: 2,
  });
  expect(firstDifference(row(), row([0, 1]), 0, 0, 10)).toBeUndefined();
});

it('many samples at one moment end', () => {
  const many = row(...Array.from({ length: 50_000 }, () => [1, 0] as [number, number]));
  expect(
    firstDifference(many, row(...Array.from({ length: 50_000 }, () => [1, 1] as [number, number])), 0, 0, 2),
  ).toBeUndefined();
});

it('a table has the nodes that differ in the order of time, and those that only one run has', async () => {
  const here = side(100, 110, {
    same: row([100, 1]),
    late: row([100, 0], [108, 1]),
    soon: row([100, 0], [102, 1]),
    mine: row(),
  });
  const there = side(7, 30, { same: row([7, 1]), late: row([7, 0]), soon: row([7, 0]), theirs: row() });
  expect(await compare(here, there, 93, () => true)).toEqual({
    from: 100,
    to: 110,
    same: 1,
    different: [
      { path: 'soon', field: 'v', time: 102, here: 1, there: 0 },
      { path: 'late', field: 'v', time: 108, here: 1, there: 0 },
    ],
    onlyHere: ['mine'],
    onlyThere: ['theirs'],
  });
});
