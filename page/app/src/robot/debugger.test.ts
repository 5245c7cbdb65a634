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
