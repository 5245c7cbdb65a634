import { expect, test } from 'vitest';
import { told } from './failure';

const FILE = 'blob:http://robot/1-2';

function thrown(name: string, message: string, stack: string): Error {
  return Object.assign(new Error(message), { name, stack });
}

test('a failure has its line and its calls, whoever wrote the stack', () => {
  const chromium = [
    'TypeError: no such thing',
    `    at f (${FILE}:3:10)`,
    `    at new Robot (${FILE}:5:1)`,
    '    at kit.part (http://robot/assets/player.js:1:1)',
    `    at globalThis.trikProgram (${FILE}:9:1)`,
  ].join('\n');
  const firefox = [
    `f@${FILE}:3:10`,
    `Robot@${FILE}:5:1`,
    'kit.part@http://robot/assets/player.js:1:1',
    `globalThis.trikProgram@${FILE}:9:1`,
    '',
  ].join('\n');
  for (const stack of [chromium, firefox])
    expect(told(thrown('TypeError', 'no such thing', stack), FILE, 'trikProgram')).toBe(
      'Line 3: TypeError: no such thing\nf() at 3\nRobot() at 5\n<global>() at 9',
    );
});

test('whatever is thrown has a text', () => {
  expect(told('a word', FILE, 'trikProgram')).toBe('a word');
  expect(told(undefined, FILE, 'trikProgram')).toBe('undefined');
  expect(told(thrown('', 'only words', ''), FILE, 'trikProgram')).toBe('only words');
  const hostile = {
    toString() {
      throw new Error('no');
    },
  };
  expect(told(hostile, FILE, 'trikProgram')).toBe('something that has no text');
  const long = thrown('Error', 'x'.repeat(1e6), `at f (${FILE}:1:1)\n`.repeat(1e4));
  expect(told(long, FILE, 'trikProgram').length).toBeLessThan(3000);
  const robbed = Object.defineProperty(new Error('x'), 'stack', {
    get() {
      throw new Error('no');
    },
  });
  expect(told(robbed, FILE, 'trikProgram')).toBe('Error: x');
});
