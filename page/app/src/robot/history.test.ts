import { expect, it } from 'vitest';
import { History, KEPT, KEPT_S } from './history';

it('a history gives what is since a time, and what held before', () => {
  const history = new History();
  for (let at = 0; at < 5; at++) history.put(at, at * 10);
  expect(history.since(2.5)).toEqual({ times: [2, 3, 4], values: [20, 30, 40] });
  expect(history.since(2)).toEqual({ times: [2, 3, 4], values: [20, 30, 40] });
  expect(history.since(9)).toEqual({ times: [4], values: [40] });
  expect(history.since(-1).times).toEqual([0, 1, 2, 3, 4]);
});

it('a history forgets the oldest, and what a clock said that was set back', () => {
  const history = new History();
  // 64 in a second: all its room is needed.
  for (let at = 0; at < KEPT + 10; at++) history.put(at / 64, at);
  expect(history.count).toBe(KEPT);
  expect(history.newest).toBe((KEPT + 9) / 64);
  expect(history.since(0).times).toEqual(Array.from({ length: KEPT }, (_, at) => (at + 10) / 64));
  history.put(5, 1);
  history.put(6, 2);
  expect(history.since(0)).toEqual({ times: [5, 6], values: [1, 2] });
});

it('a slow number takes little room and keeps its minutes in order', () => {
  const history = new History();
  for (let at = 0; at < 5000; at++) history.put(at, at);
  expect(history.count).toBeLessThan(256);
  const { times } = history.since(4999 - KEPT_S + 1);
  expect(times).toEqual(Array.from({ length: times.length }, (_, at) => 5000 - times.length + at));
  expect(times.length).toBeGreaterThanOrEqual(KEPT_S - 1);
});
