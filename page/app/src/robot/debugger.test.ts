// Breakpoints: planned before a run, set when it begins, and toggled quickly.

import { expect, it } from 'vitest';
import type { Link } from '../link/link';
import { Debugger } from './debugger.svelte';

/** A robot that answers every order, some of them with a refusal. */
function robot(refuses: (order: string) => boolean = () => false) {
  const orders: string[] = [];
  let number = 0;
  const link = {
    request(request: string): boolean {
      const [, tag, order] = /^debug:(\d+) (.*)$/.exec(request) ?? [];
      if (order === undefined) return true;
      orders.push(order);
      const done = !refuses(order);
      const more = order.startsWith('break ') && done ? { number: ++number } : {};
      const answer = { to: Number(tag), done, ...(done ? {} : { why: 'no such block' }), ...more };
      queueMicrotask(() => desk.message(`debug: ${JSON.stringify(answer)}`));
      return true;
    },
  };
  const desk: Debugger = new Debugger(link as unknown as Link);
  return { desk, orders };
}

it('breakpoints that were planned are set before the first block is left', async () => {
  const { desk, orders } = robot((order) => order === 'break gone');
  await desk.toggle('a.qrs', 'one', false);
  await desk.toggle('a.qrs', 'gone', false);
  await desk.toggle('a.qrs', 'two', false);
  await desk.toggle('b.qrs', 'other', false);
  expect(orders).toEqual([]);
  await desk.run('a.qrs', false);
  expect(orders.filter((order) => order !== 'attach')).toEqual([
    'run a.qrs',
    'break one',
    'break gone',
    'break two',
    'continue',
  ]);
  expect([...desk.breakpoints.keys()]).toEqual(['one', 'two']);
  expect(desk.why).toBe('no such block');
  expect(desk.planned('a.qrs')).toEqual(['one', 'gone', 'two']);
});

it('quick toggles are one after the other', async () => {
  const { desk, orders } = robot();
  await Promise.all(['one', 'two', 'one', 'one'].map((id) => desk.toggle('a.qrs', id, true)));
  expect([...desk.breakpoints.keys()].sort()).toEqual(['one', 'two']);
  expect([...desk.planned('a.qrs')].sort()).toEqual(['one', 'two']);
  expect(orders.filter((order) => order.startsWith('clear'))).toEqual(['clear 1']);
  await desk.detach('a.qrs');
  expect([desk.breakpoints.size, desk.planned('a.qrs')]).toEqual([0, []]);
});

it('breakpoints of others are learned, whichever way their blocks are told', async () => {
  const asked: string[] = [];
  const breakpoints = [
    { number: 3, block: 'a block of data flow', hits: 0 },
    { number: 4, block: { diagram: 'd', id: 'a block', block: 'Timer' }, hits: 0 },
    { number: 5, variable: 'n', hits: 0 },
  ];
  const link = {
    request(request: string): boolean {
      const [, tag, order = ''] = /^debug:(\d+) (.*)$/.exec(request) ?? [];
      asked.push(order);
      const more = order === 'look' ? { program: { state: 'running', attached: true } } : { breakpoints };
      queueMicrotask(() =>
        desk.message(`debug: ${JSON.stringify({ to: Number(tag), done: true, ...more })}`),
      );
      return true;
    },
  };
  const desk: Debugger = new Debugger(link as unknown as Link);
  await desk.look();
  expect(asked).toEqual(['look', 'breakpoints']);
  expect([...desk.breakpoints]).toEqual([
    ['a block of data flow', 3],
    ['a block', 4],
  ]);
});

it('what is no state changes nothing', () => {
  const { desk } = robot();
  desk.message('debug: {"state":"running","ms":5}');
  for (const odd of [
    '{',
    'null',
    '[]',
    '5',
    '{"state":7}',
    '{"log":["a"],"lost":0}',
    '{"to":99,"done":true}',
  ])
    desk.message(`debug: ${odd}`);
  expect(desk.told).toMatchObject({ state: 'running', ms: 5 });
  desk.message('debug: {"state":"gone"}');
  expect(desk.told).toBeUndefined();
});
