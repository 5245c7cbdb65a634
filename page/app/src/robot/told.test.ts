// What is believed of what a debugger tells.

import { expect, it } from 'vitest';
import { TOLD_ITEMS_MAX, TOLD_NAME_LETTERS_MAX, VALUE_LETTERS_MAX } from '../limits';
import { stateOf } from './told';

it('what is no state is nothing', () => {
  for (const odd of [null, 1, 'running', [], {}, { state: 'flying' }, { state: ['running'] }])
    expect(stateOf(odd)).toBeUndefined();
});

it('members of another type are left out', () => {
  const odd = { state: 'stopped', ms: '1', attached: 1, stop: [], threads: {}, variables: [null, 'x', [1]] };
  expect(stateOf(odd)).toEqual({ state: 'stopped', threads: [], variables: [] });
  const told = stateOf({ state: 'running', ports: [{ id: 5, value: { a: 1 }, count: -1 }], waiting: 'none' });
  expect(told?.ports).toMatchObject([{ id: '', value: '', count: 0 }]);
  expect(told?.waiting).toBeUndefined();
});

it('long texts and lists are cut, and counted', () => {
  const long = 'x'.repeat(1 << 20);
  const ports = Array.from({ length: TOLD_ITEMS_MAX + 7 }, (_, at) => ({ id: String(at), port: 'OUT' }));
  ports[0] = { id: long, port: long };
  const variables = [
    { name: 'n', value: long },
    { name: 'n', value: '2' },
  ];
  const told = stateOf({ state: 'running', ports, variables, reacted_left_out: 3, ports_left_out: 'many' });
  expect(told?.ports).toHaveLength(TOLD_ITEMS_MAX);
  expect(told?.ports?.[0]?.id).toHaveLength(TOLD_NAME_LETTERS_MAX);
  expect(told?.variables).toHaveLength(1);
  expect(told?.variables?.[0]?.value).toHaveLength(VALUE_LETTERS_MAX);
  expect(told?.leftOut).toBe(10);
});

it('a stop of data flow says what is about to arrive, and where', () => {
  const at = { diagram: 'd', id: 'i', block: 'DFSay', caption: 'say', port: 'DATA', type: 'int', value: '5' };
  const told = stateOf({ state: 'stopped', stop: { reason: 'step', at } });
  expect(told?.stop).toEqual({
    reason: 'step',
    at: { diagram: 'd', id: 'i', block: 'DFSay' },
    next: { caption: 'say', port: 'DATA', type: 'int', value: '5' },
  });
  const other = stateOf({ state: 'stopped', stop: { reason: 'pause', at: { id: 'i' } } });
  expect(other?.stop?.next).toBeUndefined();
});
