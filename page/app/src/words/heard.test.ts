import { expect, it } from 'vitest';
import { translator } from './heard';
import { ru } from './ru';

/** The sources of the robot that have its sentences. */
const sources = import.meta.glob<string>(
  [
    '../../../../trikd/src/protocol/news.rs',
    '../../../../trikd/src/program.rs',
    '../../../../trikd/src/server/control.rs',
    '../../../../trikd/src/daemon.rs',
    '../../../../trikfs/src/errno.rs',
    '../../../../trikfs/src/lease.rs',
    '../../../../trikfs/src/device/i2c/bus.rs',
    '../../../../trikfs/src/newest.rs',
    '../../../../trikfs/src/newest/*.rs',
    '../../../../trikfs/src/files/param.rs',
    '../../../../trikfs/src/device/lines.rs',
    '../../../../config/lua/trik/*.lua',
    '../../../../page/src/error.rs',
    '../../../../lang/text/src/words.rs',
  ],
  { query: '?raw', import: 'default', eager: true },
);
const source = Object.values(sources).join('\n');

const heard = translator(ru.heard);

it('every piece of a sentence is one that the robot says', () => {
  // What is put together of shorter pieces there.
  const parts = ru.heard.flatMap(([english]) =>
    english.split(/\{\w+\}| as | killed by | by a client| by the stop key| after | s: | s$|:/),
  );
  const missing = parts
    .map((part) => part.trim())
    .filter((part) => part.length > 6 && !source.includes(part));
  expect(missing).toEqual([]);
});

it('both sides of a sentence have the same names in them', () => {
  const names = (text: string) => [...text.matchAll(/\{\w+\}/g)].map(([name]) => name);
  for (const [english, russian] of ru.heard) {
    const known = names(english);
    expect(names(russian).filter((name) => !known.includes(name))).toEqual([]);
  }
});

it('sentences within sentences are translated, and others stay', () => {
  const greedy = heard('a b.py was stopped after 1.5 s: it had 70 processes, and 64 are allowed');
  expect(greedy).toMatch(/^a b\.py: .* 1\.5 .*: .* 70, .* 64$/);
  expect(greedy).not.toMatch(/processes|stopped/);
  const lease = 'caller: process 12 (python3) holds the lease with priority 5: see motors/M3/owner';
  expect(heard(lease)).not.toMatch(/holds|caller/);
  expect(heard(lease)).toContain('12 (python3)');
  const bus = heard('device: no answer from 0x48 on /dev/i2c-2: Remote I/O error (os error 121)');
  expect(bus).toContain('0x48');
  expect(bus).not.toMatch(/answer|error/);
  expect(heard('params/alpha is a number from 0.01 to 1, not 7')).toBe(
    'params/alpha \u2014 \u044d\u0442\u043e \u0447\u0438\u0441\u043b\u043e \u043e\u0442 0.01 \u0434\u043e 1, \u0430 \u043d\u0435 7',
  );
  for (const text of ['', 'something else', 'a has begun', '{name}', 'x'.repeat(5000)]) {
    expect(heard(text)).toBe(text);
  }
  expect(translator([])('a.py has started')).toBe('a.py has started');
});
