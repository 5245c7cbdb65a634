import { expect, it } from 'vitest';
import type { Cell, Mark, Row } from './news';
import { numberOf, secondsOf, tallyOf } from './tally';

const mark = (tone: Mark['tone']): Mark => ({
  tone,
  verdict: tone,
  points: 1,
  ms: 10,
  solution: 'a.qrs',
  why: '',
  replay: null,
});
const row = (...cells: Cell[]): Row => ({ cells, sum: 0, passed: null });

it('marks are counted by how they are, and what waits is not missing', () => {
  const rows = [
    row({ waiting: 0, mark: mark('good') }, { waiting: 1, mark: mark('wrong') }),
    row({ waiting: 1, mark: null }, { waiting: 0, mark: null }),
    row({ waiting: 0, mark: mark('broken') }),
    row(),
  ];
  expect(tallyOf(rows)).toEqual({ good: 1, wrong: 1, broken: 1, missing: 1 });
});

it('numbers have no more digits than they need, in the way of the language', () => {
  expect(numberOf(5, 'en')).toBe('5');
  expect(numberOf(-0, 'en')).toBe('0');
  expect(numberOf(12345.5, 'en')).toBe('12345.5');
  expect(numberOf(2.5, 'ru')).toBe('2,5');
  expect(secondsOf(1029, 'en')).toBe('1.02');
  expect(secondsOf(60_000, 'ru')).toBe('60,00');
});
