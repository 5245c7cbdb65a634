import { afterEach, beforeEach, expect, test, vi } from 'vitest';
import { BLANK } from './news';
import { Room } from './room.svelte';

/** What went to the server. */
let sent: (string | Uint8Array)[] = [];
let socket: Server;

class Server {
  static readonly OPEN = 1;
  readyState = Server.OPEN;
  onopen?: () => void;
  onmessage?: (event: { data: string }) => void;

  constructor() {
    // The last one that was made.
    // eslint-disable-next-line @typescript-eslint/no-this-alias
    socket = this;
  }

  send(data: string | Uint8Array): void {
    sent.push(data);
  }

  close(): void {
    this.readyState = 3;
  }
}

beforeEach(() => {
  vi.useFakeTimers();
  vi.stubGlobal('WebSocket', Server);
  sent = [];
});
afterEach(() => {
  vi.useRealTimers();
  vi.unstubAllGlobals();
});

/** Two robots, both chosen. */
function room(): Room {
  const made = new Room('ws://server/');
  socket.onopen?.();
  const robots = ['anna', 'boris'].map((name) => ({ name, group: '', at: name }));
  socket.onmessage?.({
    data: JSON.stringify({ is: 'hello', name: 'room', drives: true, marks: true, robots }),
  });
  return made;
}

/** A file that is read when the test wants it. */
function slow(text: string): { file: File; read: () => void; lose: () => void } {
  const file = new File([text], 'a.py');
  let [read, lose] = [() => {}, () => {}];
  const content = new Promise<ArrayBuffer>((resolve, reject) => {
    read = () => resolve(new TextEncoder().encode(text).buffer);
    lose = () => reject(new Error('gone'));
  });
  vi.spyOn(file, 'arrayBuffer').mockReturnValue(content);
  return { file, read, lose };
}

test('a file that is read after a stop was pressed is not sent to be run', async () => {
  const one = room();
  const { file, read } = slow('print(1)');
  const done = one.send(file, true);
  one.stopAll();
  read();
  expect(await done).toBe(false);
  expect(sent).toEqual(['{"do":"stop","robots":[0,1]}']);
  expect(one.unsent).toBe('stopped');
});

test('a file that shall not run is sent all the same', async () => {
  const one = room();
  const { file, read } = slow('print(1)');
  const done = one.send(file, false);
  one.stopAll();
  read();
  expect(await done).toBe(true);
  expect(new TextDecoder().decode(sent[1] as Uint8Array)).toBe(
    '{"robots":[0,1],"name":"a.py","run":false}\nprint(1)',
  );
});

test('a file that cannot be read any more is said to be so', async () => {
  const one = room();
  const { file, lose } = slow('');
  const done = one.send(file, true);
  lose();
  expect(await done).toBe(false);
  expect([sent, one.unsent]).toEqual([[], 'unread']);
});

test('a stop that is not sent is not taken for one, until one is', () => {
  const one = room();
  socket.readyState = 3;
  one.stopAll();
  expect(one.hasMissedStop).toBe(true);
  socket.readyState = Server.OPEN;
  one.stopChosen();
  expect(one.hasMissedStop).toBe(false);
  expect(sent).toEqual(['{"do":"stop","robots":[0,1]}']);
});

test('a battery that is old says so, also when nothing more comes of its robot', () => {
  const one = room();
  const card = { is: 'robot', id: 0, ...BLANK, reach: 'there' };
  socket.onmessage?.({ data: JSON.stringify({ ...card, battery: { text: '11.8 V', ageMs: 6000 } }) });
  expect([one.batteryAge_s(0), one.batteryAge_s(1)]).toEqual([undefined, undefined]);
  vi.advanceTimersByTime(3000);
  socket.onmessage?.({ data: '{"is":"beat"}' });
  expect(one.batteryAge_s(0)).toBeUndefined();
  vi.advanceTimersByTime(3000);
  socket.onmessage?.({ data: '{"is":"beat"}' });
  vi.advanceTimersByTime(3500);
  socket.onmessage?.({ data: '{"is":"beat"}' });
  expect(one.batteryAge_s(0)).toBe(15);
});
