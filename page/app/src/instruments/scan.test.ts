import { expect, it } from 'vitest';
import type { Reading } from './reading';
import { nearestOf, ringsOf, scanOf, seenOf } from './scan';

const readings = (values: (number | undefined)[], unit = 'mm', letter = 'd'): Reading[] =>
  values.map((value, at) => ({
    field: { name: `${letter}${at}`, kind: 'u16' },
    unit,
    value,
    text: '',
    isNumber: true,
  }));

it('many distances in a unit of length are a scan, and other numbers are none', () => {
  const values = [0, 500, 400, 900, 0, 300, 800, 700];
  const scan = scanOf(readings(values));
  expect(scan?.far).toEqual([NaN, 500, 400, 900, NaN, 300, 800, 700]);
  expect(scan && seenOf(scan)).toBe(6);
  // Five of eight parts of a turn to the right are three to the left.
  expect(scan && nearestOf(scan)).toEqual({ far: 300, degrees: -135 });
  expect(scanOf(readings(values, 'deg'))).toBeUndefined();
  expect(scanOf(readings(values, 'mm', 'x'))).toBeUndefined();
  expect(scanOf(readings(values.slice(1, 5)))).toBeUndefined();
});

it('without a sample or without an echo there is nothing near', () => {
  const empty = scanOf(readings(Array.from({ length: 8 }, () => undefined)));
  expect(empty && [nearestOf(empty), seenOf(empty)]).toEqual([undefined, 0]);
  const behind = scanOf(readings([0, 0, 0, 0, 50, 0, 0, 0]));
  expect(behind && nearestOf(behind)).toEqual({ far: 50, degrees: 180 });
});

it('rings have round distances and reach the farthest point', () => {
  expect(ringsOf(4000)).toEqual([1000, 2000, 3000, 4000]);
  expect(ringsOf(3999)).toEqual([1000, 2000, 3000, 4000]);
  expect(ringsOf(4001)).toEqual([2000, 4000, 6000]);
  expect(ringsOf(7.2)).toEqual([2, 4, 6, 8]);
  expect(ringsOf(0)).toEqual([1]);
  for (let far = 1; far < 1e5; far *= 1.07) {
    const rings = ringsOf(far);
    expect(rings.length).toBeLessThanOrEqual(4);
    expect(rings.at(-1)).toBeGreaterThanOrEqual(far * (1 - 1e-9));
  }
});
