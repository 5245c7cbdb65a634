import { expect, it } from 'vitest';
import { BLANK, type Card } from './news';
import { markOf, partOf, stopSumOf, sumOf } from './sum';

const card = (change: Partial<Card> = {}): Card => ({ ...BLANK, reach: 'there', ...change });

it('a robot that is gone runs nothing', () => {
  const cards = [card({ runs: 'a.py' }), card(), card({ reach: 'absent', runs: 'b.py' })];
  expect(sumOf(cards)).toEqual({ all: 3, there: 2, run: 1 });
});

it('a stop of many is told by the slowest and by those that are missing', () => {
  expect(stopSumOf([card(), card()])).toBeUndefined();
  const sum = stopSumOf([
    card({ stop: { is: 'rests', ms: 12 } }),
    card({ stop: { is: 'rests', ms: 90 } }),
    card({ stop: { is: 'asked' } }),
    card({ stop: { is: 'asked' }, reach: 'absent' }),
    card({ stop: { is: 'missed' } }),
    card({ stop: { is: 'failed', why: 'x' } }),
    card(),
  ]);
  expect(sum).toEqual({ rest: 2, slowest_ms: 90, waiting: 1, away: 2, failed: 1 });
});

it('what is wrong is seen before what runs', () => {
  expect(markOf(card({ reach: 'unknown' }))).toBe('unknown');
  expect(markOf(card({ reach: 'absent', runs: 'a' }))).toBe('absent');
  expect(markOf(card({ runs: 'a' }))).toBe('runs');
  expect(markOf(card({ runs: 'a', stop: { is: 'failed', why: 'x' } }))).toBe('wrong');
  expect(markOf(card({ last: 'a.py has failed after 1.0 s' }))).toBe('wrong');
  expect(markOf(card({ last: 'a.py was stopped by a client after 1.0 s' }))).toBe('idle');
  expect(markOf(card({ last: 'a.py has ended after 1.0 s' }))).toBe('idle');
});

it('a file that is on its way is a part of itself', () => {
  const sending = { name: 'a', is: 'sending', done: 5, bytes: 10, why: null } as const;
  expect(partOf(card({ sending }))).toBe(0.5);
  expect(partOf(card({ sending: { ...sending, done: 20 } }))).toBe(1);
  expect(partOf(card({ sending: { ...sending, is: 'sent' } }))).toBeUndefined();
  expect(partOf(card())).toBeUndefined();
});
