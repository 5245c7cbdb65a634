// Ports and reactions of a program of data flow.

import { expect, it } from 'vitest';
import { stateOf } from '../robot/told';
import { portsOf, Reactions, SEEN_MS, short } from './flow';

const at = (id: string, port: string) => ({ diagram: 'd', id, block: 'DFSay', caption: id, port });

it('what a port has given, and what waits there, stand together', () => {
  const told = stateOf({
    state: 'running',
    ms: 40,
    ports: [
      { ...at('a', 'OUT'), type: 'int', value: '7', count: 3 },
      { ...at('a', 'OUT'), type: 'float', value: '0.30000000000000004', count: 1 },
    ],
    waiting: [
      { ...at('b', 'DATA'), count: 2, lost: 5 },
      { ...at('a', 'OUT'), count: 0, lost: 1 },
    ],
  });
  const [a, b] = portsOf(told);
  expect(a).toMatchObject({ id: 'a', last: '0.3', count: 4, waiting: 0, lost: 1 });
  expect(b).toMatchObject({ id: 'b', last: undefined, waiting: 2, lost: 5 });
  expect(portsOf(undefined)).toEqual([]);
});

/** What is told at a time. */
function told(ms: number, counts: Record<string, number>) {
  const reacted = Object.entries(counts).map(([id, count]) => ({ ...at(id, ''), count }));
  return stateOf({ state: 'running', ms, reacted });
}

it('a block that reacts is lit for a while of the program', () => {
  const reactions = new Reactions();
  expect([...reactions.hear(told(100, { a: 900 }))]).toEqual([]);
  expect([...reactions.hear(told(200, { a: 900, b: 1 }))]).toEqual(['b']);
  expect([...reactions.hear(told(300, { a: 901, b: 1 }))]).toEqual(['a', 'b']);
  // Heard again, as while it is stopped.
  expect([...reactions.hear(told(300, { a: 901, b: 1 }))]).toEqual(['a', 'b']);
  expect([...reactions.hear(told(300 + SEEN_MS, { a: 901, b: 1 }))]).toEqual(['a']);
  // What is no longer told of is not lit, and what is told anew has just reacted.
  expect([...reactions.hear(told(900, {}))]).toEqual([]);
  expect([...reactions.hear(told(1000, { b: 1 }))]).toEqual(['b']);
});

it('a block that gives by itself is lit as well', () => {
  const given = (count: number) =>
    stateOf({
      state: 'running',
      ms: 100 * count,
      ports: [{ ...at('a', 'OUT'), type: 'int', value: '1', count }],
    });
  const reactions = new Reactions();
  reactions.hear(given(1));
  expect([...reactions.hear(given(2))]).toEqual(['a']);
});

it('a program that begins anew is heard anew', () => {
  const reactions = new Reactions();
  reactions.hear(told(5000, { a: 10 }));
  reactions.hear(told(5100, { a: 11 }));
  expect([...reactions.hear(told(10, { a: 1 }))]).toEqual(['a']);
  reactions.hear(undefined);
  expect([...reactions.hear(told(20, { a: 2 }))]).toEqual([]);
});

it('nothing is lit in the past, and nothing is new when the present comes back', () => {
  const reactions = new Reactions();
  reactions.hear(told(5000, { a: 10, b: 1 }));
  expect([...reactions.hear(told(5100, { a: 11, b: 1 }))]).toEqual(['a']);
  for (const state of ['searching', 'past']) {
    const past = stateOf({ state, ms: 5090, reacted: [], ports: [] });
    expect([...reactions.hear(past)]).toEqual([]);
  }
  expect([...reactions.hear(told(5100, { a: 11, b: 1 }))]).toEqual(['a']);
  expect([...reactions.hear(told(5100 + SEEN_MS + 1, { a: 11, b: 1 }))]).toEqual([]);
  // Who first looks in the past has heard nothing of the present.
  const late = new Reactions();
  late.hear(stateOf({ state: 'past', ms: 50, reacted: [], ports: [] }));
  expect([...late.hear(told(100, { a: 7 }))]).toEqual([]);
});

it('a text for a picture is one short line', () => {
  expect(short('  1\n2 ', 12)).toBe('1 2');
  expect(short('x'.repeat(1000), 12)).toBe(`${'x'.repeat(12)}...`);
});
