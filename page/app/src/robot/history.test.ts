import { expect, test } from 'vitest';
import { History, KEPT } from './history';

test('a history keeps the newest and gives what is since a time', () => {
  const history = new History();
  expect(history.newest).toBe(-Infinity);
  for (let at = 0; at < KEPT + 10; at++) history.put(at, at * 2);
  expect(history.count).toBe(KEPT);
  expect(history.newest).toBe(KEPT + 9);
  expect(history.since(-1).times[0]).toBe(10);
  expect(history.since(KEPT + 8)).toEqual({
    times: [KEPT + 8, KEPT + 9],
    values: [2 * KEPT + 16, 2 * KEPT + 18],
  });
});
