import { expect, it } from 'vitest';
import { mixed, scaled, stick } from './mix';

it('two motors drive ahead, turn and never more than fully', () => {
  expect(mixed({ x: 0, y: 1 })).toEqual({ left: 1, right: 1 });
  expect(mixed({ x: 1, y: 0 })).toEqual({ left: 1, right: -1 });
  expect(mixed({ x: 1, y: 1 })).toEqual({ left: 1, right: 0 });
  expect(mixed({ x: -0.6, y: 0.6 })).toEqual({ left: 0, right: 1 });
  expect(mixed({ x: NaN, y: 5 })).toEqual({ left: 1, right: 1 });
});

it('a place is scaled with rest in the middle of a range that has both signs', () => {
  expect(scaled(0.5, { min: -100, max: 100 })).toBe(50);
  expect(scaled(-1, { min: -90, max: 100 })).toBe(-90);
  expect(scaled(0, { min: 0, max: 100 })).toBe(50);
  expect(scaled(NaN, { min: -100, max: 100 })).toBe(0);
  expect(scaled(9, { min: -100, max: 100 })).toBe(100);
});

it('a stick has a middle', () => {
  expect(stick(0.05, -0.1)).toEqual({ x: 0, y: 0 });
  expect(stick(0, 1)).toEqual({ x: 0, y: 1 });
  expect(Math.abs(stick(0.13, 0).x)).toBeLessThan(0.02);
  expect(stick(NaN, Infinity)).toEqual({ x: 0, y: 0 });
});
