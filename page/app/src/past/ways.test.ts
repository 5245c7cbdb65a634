import { expect, test, vi } from 'vitest';
import type { Line } from '../robot/recording';
import { state } from '../world/example';
import { Trail } from '../world/trail';
import { PastWorld } from './around.svelte';
import { count, Ways } from './ways';

const at = (x: number, marker = '') => ({
  ...state(),
  robots: [{ at: [x, 0, 0] as [number, number, number], read: [], rays: [], stuck: false, marker }],
});

const xs = (points: number[] | undefined) => points?.filter((_, index) => index % 2 === 0);

test('a moment has the way until then, whichever moment was looked at before', () => {
  const ways = new Ways();
  ways.tell(0);
  for (let time = 0; time < 10; time++) ways.put(time, at(time / 10, time < 5 ? '#f00' : ''));
  ways.tell(10);
  ways.put(10, at(3, '#00f'));
  const trail = new Trail();
  const cut = (time: number) => {
    ways.cut(time, trail);
    return [xs(trail.ways[0]?.points)?.length, trail.marks.map(({ points }) => points.length / 2)];
  };
  expect(cut(-1)).toEqual([0, []]);
  expect(cut(9)).toEqual([10, [5]]);
  expect(cut(2.5)).toEqual([3, [3]]);
  // A jump, and another world without the marks of the one before.
  expect(cut(10)).toEqual([12, [1]]);
  expect(cut(9.9)).toEqual([10, [5]]);
});

test('times are found by halves', () => {
  expect([count([], 1), count([1, 2, 2, 3], 2), count([1, 2], 0), count([1, 2], 9)]).toEqual([0, 3, 0, 2]);
});

test('a step back reads one line, and what was found once is not read again', () => {
  const places = Array.from({ length: 3000 }, (_, time): Line => ({
    topic: '/world',
    time,
    level: 20,
    name: 'world',
    text: JSON.stringify(at(time / 100)),
    errno: 0,
  }));
  let now = 2999;
  const world = new PastWorld({ scenes: [], places }, () => now);
  // It takes as many looks as it takes, and each shows where the robot is.
  const ways = () => (world.look(), xs(world.trail.ways[0]?.points)?.length ?? 0);
  ways();
  expect(world.state?.robots[0]?.at[0]).toBe(29.99);
  while (ways() < 3000);
  const parse = vi.spyOn(JSON, 'parse');
  now = 1500;
  expect(ways()).toBe(1501);
  expect(world.state?.robots[0]?.at[0]).toBe(15);
  expect(parse).toHaveBeenCalledTimes(1);
  parse.mockRestore();
});
