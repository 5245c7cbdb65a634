import { expect, it } from 'vitest';
import { age, axisText, bytesText, numberText, valueText } from './numbers';

it('numbers have sensible digits', () => {
  const texts: [number, boolean | undefined, string][] = [
    [0, undefined, '0'],
    [-30, undefined, '\u221230'],
    [12.20634, undefined, '12.206'],
    [0.031999, undefined, '0.0320'],
    [121.26, undefined, '121.26'],
    [12345.678, undefined, '12346'],
    [1e-7, undefined, '1.000e\u22127'],
    [123456789.5, undefined, '1.235e+8'],
    [2, false, '2.000'],
    [-0.00001, false, '\u22121.000e\u22125'],
    [NaN, undefined, 'NaN'],
    [-Infinity, undefined, '\u2212\u221e'],
  ];
  for (const [value, isWhole, text] of texts) expect(numberText(value, isWhole)).toBe(text);
  expect(numberText(-12345678901234567890n)).toBe('\u221212345678901234567890');
  expect(axisText(38.75)).toBe('38.75');
  expect(axisText(-2e9)).toBe('\u22122.00e+9');
});

it('words, truths and bytes are shown as such', () => {
  expect(valueText('abc', false)).toBe('abc');
  expect(valueText(true, false)).toBe('1');
  expect(bytesText(12)).toBe('12 B');
  expect(bytesText(65536)).toBe('64 KiB');
});

it('an age is told from the first second on', () => {
  expect(age(0.9)).toBeUndefined();
  expect(age(NaN)).toBeUndefined();
  expect(age(12.7)).toEqual({ count: 12, unit: 's' });
  expect(age(150)).toEqual({ count: 2, unit: 'min' });
  expect(age(10_000)).toEqual({ count: 2, unit: 'h' });
});
