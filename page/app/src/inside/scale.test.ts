import { expect, test } from 'vitest';
import { scaleOf } from './scale';

const scale = (value: number, min: number | null = null, max: number | null = null) =>
  scaleOf({ name: 'a', value, min, max });

test('a slider goes over the range of its number, in whole steps if these make sense', () => {
  expect(scale(3, 0, 10)).toEqual({ min: 0, max: 10, step: 1 });
  expect(scale(0.5, 0, 1)).toEqual({ min: 0, max: 1, step: 0.005 });
  expect(scale(1, 0, 1)).toEqual({ min: 0, max: 1, step: 0.005 });
  expect(scale(50, 0, 2000)).toEqual({ min: 0, max: 2000, step: 10 });
});

test('without a range it goes over what is around the number', () => {
  expect(scale(0.25)).toMatchObject({ min: 0, max: 1 });
  expect(scale(8)).toEqual({ min: 0, max: 16, step: 1 });
  expect(scale(-3)).toMatchObject({ min: -6, max: 0 });
  expect(scale(0)).toMatchObject({ min: 0, max: 1 });
  expect(scale(4, 1)).toMatchObject({ min: 1, max: 9 });
  for (const one of [scale(7, 5), scale(-7, null, -5), scale(0, null, 0)]) {
    expect(one.min).toBeLessThan(one.max);
  }
});
