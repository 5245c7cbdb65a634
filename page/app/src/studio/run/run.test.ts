import { expect, test } from 'vitest';
import type { State } from '../engine/facts';
import { RUN_MOMENTS_MAX } from '../../limits';
import { Moments } from './moments';
import { orderOf, orders, PLAIN } from './point';
import { answerOf, reported, heldOf } from './told';

const state = (ms: number, x: number, variables: Record<string, string> = {}): State => ({
  ms,
  progress: 'runs',
  motors: { M3: 100 },
  sensors: { A1: x },
  variables,
  threads: [],
  world: {
    t: ms / 1000,
    robots: [{ at: [x, 0, 350], read: [], rays: [1, 2, 3], stuck: false, marker: '' }],
    things: [[0, x, 0]],
  },
});

test('a breakpoint is an order, whatever stands in its fields', () => {
  expect(orderOf('{b}', PLAIN)).toBe('break {b}');
  expect(orderOf('{b}', { condition: ' n > 3 ', from: 2, log: 'n is\n{n}' })).toBe(
    'break {b} from 2\nif n > 3\nlog n is {n}',
  );
  // A second line would be another part of the order.
  expect(orderOf('{b}', { ...PLAIN, condition: 'n\nlog x' })).toBe('break {b}\nif n log x');
  expect(orders(new Map([['{b}', PLAIN]]), new Set(['n']))).toEqual(['break {b}', 'watch n']);
});

test('what moves is found again at a time, and between two as if it moved straight', () => {
  const moments = new Moments();
  expect(moments.at(5)).toBe(undefined);
  moments.put(state(0, 0));
  moments.put({ ...state(100, 1), world: { ...state(100, 1).world, things: [[0, 1, 20]] } });
  expect(moments.at(25)?.robots[0]?.at[0]).toBeCloseTo(0.25);
  expect(moments.at(25)?.things).toEqual([[0, 0.25, 5]]);
  expect(moments.at(-5)?.robots[0]?.at[0]).toBe(0);
  expect(moments.at(500)?.robots[0]?.at[0]).toBe(1);
  expect(moments.at(500)?.robots[0]?.rays).toEqual([]);
});

test('a robot turns the shorter way between two moments', () => {
  const moments = new Moments();
  moments.put(state(0, 0));
  const next = state(100, 0);
  moments.put({
    ...next,
    world: {
      ...next.world,
      robots: [{ at: [0, 0, 10], read: [], rays: [], stuck: false, marker: '' }],
    },
  });
  expect(moments.at(50)?.robots[0]?.at[2]).toBe(360);
});

test('what is kept of a long run is bounded, begins at its beginning and ends at its end', () => {
  const moments = new Moments();
  const last = 5 * RUN_MOMENTS_MAX;
  for (let at = 0; at <= last; at++) moments.put(state(at * 10, at));
  expect(moments.all.length).toBeLessThanOrEqual(RUN_MOMENTS_MAX);
  expect(moments.all.length).toBeGreaterThan(RUN_MOMENTS_MAX / 4);
  expect(moments.all[0]?.ms).toBe(0);
  expect(moments.all.at(-1)?.ms).toBe(last * 10);
  const steps = moments.all.slice(1).map(({ ms }, at) => ms - (moments.all[at]?.ms ?? 0));
  expect(Math.max(...steps.slice(0, -1))).toBeLessThan((last * 10) / (RUN_MOMENTS_MAX / 8));
});

test('numbers of variables, motors and sensors are samples; texts are none', () => {
  const moments = new Moments();
  moments.put(state(0, 7, { t: 'hello' }));
  moments.put(state(10, 8, { n: '1.5', isThere: 'true', t: 'hello', empty: '' }));
  moments.put(state(20, 9, { t: 'hello' }));
  expect(moments.names).toEqual(['A1', 'M3', 'n', 'isThere']);
  expect(moments.samples('A1')).toEqual({ times: [0, 0.01, 0.02], values: [7, 8, 9] });
  expect(moments.samples('n')).toEqual({ times: [0.01, 0.02], values: [1.5, NaN] });
  expect(moments.numbersAt(15)).toMatchObject({ A1: 8, n: 1.5 });
  expect(moments.numbersAt(-1)).toEqual({});
  // Of one moment the newest is kept.
  moments.put(state(20, 11));
  expect(moments.samples('A1').values).toEqual([7, 8, 11]);
});

test('what a debugger tells is taken apart, and what is no text is none', () => {
  const stop = { reason: 'change', variable: 'n', was: '1', is: 2 };
  const told = heldOf({ state: 'stopped', ms: 30, stop, kept: { from_ms: 10 }, variables: [] });
  expect(told?.from_ms).toBe(10);
  expect(told?.change).toEqual({ variable: 'n', was: '1', is: '' });
  expect(heldOf(undefined)).toBe(undefined);
  expect(answerOf({ to: 0, done: false, why: 'no' })).toEqual({ why: 'no', value: '' });
  expect(answerOf({ to: 0, done: true, value: '3' })).toEqual({ why: '', value: '3' });
  const news = reported([
    { log: ['a', 'b'], lost: 0 },
    { state: 'past', ms: 5 },
  ]);
  expect(news.log).toEqual(['a', 'b']);
  expect(news.told?.state).toBe('past');
});
