import { afterEach, beforeEach, expect, test, vi } from 'vitest';
import type { Link } from '../link/link';
import type { Order } from '../link/words';
import { type Inner, Inside } from './inside.svelte';

let sent: Order[] = [];
let there: Inner[] = [];

beforeEach(() => {
  sent = [];
  const params = [
    { name: 'alpha', value: 0.5, min: 0, max: 1 },
    { name: 'gain', value: 3, min: null, max: null },
  ];
  there = [{ path: 'n', format: 'i32 x', units: 'cm', stages: true, params }];
  vi.stubGlobal('fetch', () => Promise.resolve({ ok: true, json: () => Promise.resolve(there) }));
  vi.useFakeTimers({ toFake: ['performance'] });
});
afterEach(() => {
  vi.unstubAllGlobals();
  vi.useRealTimers();
});

async function fresh(): Promise<Inside> {
  const order = (order: Order): boolean => sent.push(order) > 0;
  const one = new Inside({ order } as unknown as Link);
  await one.read();
  one.choose('n');
  return one;
}

const values = (one: Inside) => one.node?.params.map(({ value }) => value);

test('samples of the chosen node are kept, and of no other one', async () => {
  const one = await fresh();
  expect(sent).toEqual([{ do: 'inspect', path: 'n' }]);
  one.heard('n', 1, ['01', '02']);
  one.heard('other', 2, ['03']);
  one.heard('n', 3, []);
  one.heard('n', 3, ['04']);
  expect(one.passages.map(({ at_s }) => at_s)).toEqual([1, 3]);
  one.heard('n', 2, ['05']);
  expect(one.passages).toEqual([{ at_s: 2, tuples: ['05'] }]);
  for (let at = 3; at < 5000; at++) one.heard('n', at, ['00']);
  expect(one.passages).toHaveLength(1800);
});

test('what a slider does in one go is taken back in one go', async () => {
  const one = await fresh();
  for (const value of [0.6, 0.7, 0.8]) one.turn('alpha', value);
  one.turn('gain', 4);
  vi.advanceTimersByTime(1001);
  one.turn('gain', 5);
  expect(values(one)).toEqual([0.8, 5]);
  expect(one.turned).toBe(3);
  sent = [];
  one.undo();
  expect(values(one)).toEqual([0.8, 4]);
  one.undo();
  one.undo();
  one.undo();
  expect(values(one)).toEqual([0.5, 3]);
  const writes = sent.filter((order) => order.do === 'write');
  expect(writes.map(({ param, value }) => [param, value])).toEqual([
    ['gain', '4'],
    ['gain', '3'],
    ['alpha', '0.5'],
  ]);
});

test('a number that is refused is said, and the one before is shown again', async () => {
  const one = await fresh();
  one.turn('alpha', 7, true);
  expect(one.turned).toBe(1);
  one.turn('none', 7);
  one.turn('gain', NaN);
  expect(sent.filter((order) => order.do === 'write')).toHaveLength(1);
  one.written('n', 'alpha', 'out of range');
  await vi.waitFor(() => expect(values(one)).toEqual([0.5, 3]), 60_000);
  expect(one.wrong).toEqual({ alpha: 'out of range' });
  expect(one.turned).toBe(0);
  one.explain('n', 'alpha', 'params/alpha is a number from 0 to 1');
  one.explain('n', 'gain', 'nobody has asked');
  expect(one.wrong).toEqual({ alpha: 'params/alpha is a number from 0 to 1' });
  one.written('n', 'alpha', null);
  expect(one.wrong).toEqual({});
});
