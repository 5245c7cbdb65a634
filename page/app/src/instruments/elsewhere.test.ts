import { expect, test } from 'vitest';
import { Elsewhere, OWN_MS } from './elsewhere';

test('what has moved and rests without an order from here was stopped elsewhere', () => {
  const held = new Elsewhere();
  expect(held.reported('m', true, 0)).toBe(false);
  held.ordered('m', false, 0);
  // The report from before the order.
  expect(held.reported('m', true, 1000)).toBe(false);
  expect(held.reported('m', false, 1010)).toBe(false);
  held.ordered('m', false, 1020);
  expect(held.reported('m', true, 1030)).toBe(true);
  held.released('m');
  expect(held.reported('m', true, 1040)).toBe(false);
});

test('a hand that passes through the middle stops nothing', () => {
  const held = new Elsewhere();
  held.ordered('m', false, 0);
  held.reported('m', false, 500);
  held.ordered('m', true, 1000);
  held.ordered('m', false, 1010);
  // Late reports: of before, of the middle, of now.
  expect(held.reported('m', false, 1020)).toBe(false);
  expect(held.reported('m', true, 1030)).toBe(false);
  expect(held.reported('m', false, 1040)).toBe(false);
  expect(held.reported('m', true, 1010 + OWN_MS)).toBe(true);
});
