import { afterEach, beforeEach, expect, test, vi } from 'vitest';
import { Table } from './table.svelte';

let socket: Server;

class Server {
  static readonly OPEN = 1;
  readyState = Server.OPEN;
  onopen?: () => void;
  onclose?: () => void;
  onmessage?: (event: { data: string }) => void;

  constructor() {
    // The last one that was made.
    // eslint-disable-next-line @typescript-eslint/no-this-alias
    socket = this;
  }

  close(): void {
    this.readyState = 3;
  }
}

beforeEach(() => {
  vi.useFakeTimers();
  vi.stubGlobal('WebSocket', Server);
});
afterEach(() => {
  vi.useRealTimers();
  vi.unstubAllGlobals();
});

const say = (news: object) => socket.onmessage?.({ data: JSON.stringify(news) });

/** Two pupils, one task. */
function table(): Table {
  const made = new Table('ws://server/');
  socket.onopen?.();
  say({
    is: 'hello',
    name: 'class',
    pupils: ['anna', '<b>'],
    columns: [{ name: 'line', weight: 2 }],
    passMark: null,
    leftOut: [],
    leftOutCount: 0,
  });
  return made;
}

const ROW = { is: 'row', cells: [{ waiting: 0, mark: null }], sum: 7, passed: true };

test('rows come in any order, and one that is not in the table is left out', () => {
  const one = table();
  say({ ...ROW, id: 1 });
  say({ ...ROW, id: 2 });
  expect(one.rows.map(({ sum }) => sum)).toEqual([0, 7]);
  expect(one.rows).toHaveLength(2);
  expect(one.hasWeights).toBe(true);
  one.close();
});

test('what was said last stays when the server is gone, and another server begins anew', () => {
  const one = table();
  say({ ...ROW, id: 0 });
  say({ is: 'progress', done: 1, all: 1, over: true });
  socket.onclose?.();
  expect([one.isConnected, one.rows[0]?.sum, one.progress.over]).toEqual([false, 7, true]);
  say({ is: 'hello', name: '', pupils: ['x'], columns: [], passMark: 3, leftOut: [], leftOutCount: 0 });
  expect(one.rows).toEqual([{ cells: [], sum: 0, passed: null }]);
  expect(one.progress.over).toBe(false);
  one.close();
});
