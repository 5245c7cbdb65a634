import { expect, it } from 'vitest';
import { History, KEPT } from './history';
import { request } from './wanted';

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
  for (let at = 0; at < KEPT + 10; at++) history.put(at, at);
  expect(history.count).toBe(KEPT);
  expect(history.newest).toBe(KEPT + 9);
  expect(history.since(0).times).toEqual(Array.from({ length: KEPT }, (_, at) => at + 10));
  history.put(5, 1);
  history.put(6, 2);
  expect(history.since(0)).toEqual({ times: [5, 6], values: [1, 2] });
});

it('a request names nodes, and no path is more than a path', () => {
  expect(request(['camera/picture', 'a'])).toBe('stream:camera/picture,a;hz=10');
  expect(request(['a;hz=1', '*', 'a,b'])).toBe('');
  expect(request([])).toBe('');
  expect(request(Array.from({ length: 99 }, (_, at) => `n${at}`)).split(',').length).toBe(64);
});
