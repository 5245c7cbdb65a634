import { expect, test } from 'vitest';
import { HEAT_CELLS_MAX } from '../limits';
import { colourOf, Heat } from './heat';

const at = (heat: Heat, column: number, row: number) => heat.counts[row * heat.columns + column];

test('a place counts once for each way, however long a robot stays there', () => {
  const heat = new Heat([-1, -1, 1, 1]);
  expect([heat.columns, heat.rows]).toEqual([100, 100]);
  heat.put(new Float64Array([0.01, 0.01, 0.01, 0.01, 0.5, 0.01]));
  heat.put(new Float64Array([0.01, 0.01]));
  expect(at(heat, 50, 50)).toBe(2);
  expect(at(heat, 52, 50)).toBe(2);
  expect(at(heat, 53, 50)).toBe(0);
  expect(at(heat, 75, 50)).toBe(1);
  expect(heat.most).toBe(2);
});

test('what is outside of the world, or nowhere, counts nothing, and a vast world has as many cells as any', () => {
  const heat = new Heat([0, 0, 1000, 500]);
  expect(heat.columns).toBe(HEAT_CELLS_MAX);
  expect(heat.rows).toBe(HEAT_CELLS_MAX / 2);
  heat.put(new Float64Array([NaN, NaN, -5, 3, 2000, 3, 1, Infinity]));
  expect(heat.most).toBe(0);
});

test('more is another colour, and the most is the last one', () => {
  expect(colourOf(1, 10)).not.toEqual(colourOf(5, 10));
  expect(colourOf(10, 10)).toEqual(colourOf(1, 1));
  expect(colourOf(10, 10)[0]).toBe(215);
});
