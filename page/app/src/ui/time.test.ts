import { expect, test } from 'vitest';
import { clock } from './time';

test('times have minutes, seconds and tenths, and never sixty seconds', () => {
  expect(clock(0)).toBe('0:00.0');
  expect(clock(59.96)).toBe('1:00.0');
  expect(clock(90)).toBe('1:30.0');
  expect(clock(3723.45)).toBe('62:03.5');
  expect(clock(-1)).toBe('0:00.0');
});
