import { expect, test } from 'vitest';
import { bytesIn, guessed, hexText, numbersIn, partsOf } from './tuple';

const kinds = (bytes: number, format: string) => guessed(bytes, format).map(({ kind }) => kind);

test('bytes become numbers by a format', () => {
  const parts = partsOf('i16 x, >u16 y, f32 z');
  expect(parts.map(({ name }) => name)).toEqual(['x', 'y', 'z']);
  expect(numbersIn(bytesIn('feff01020000c03f'), parts)).toEqual([-2, 258, 1.5]);
  expect(numbersIn(bytesIn('feff01'), parts)).toEqual([-2, NaN, NaN]);
  expect(numbersIn(bytesIn('0001'), partsOf('u8 x 2'))).toEqual([0, 1]);
  expect(numbersIn(bytesIn('ffffffffffffffff'), partsOf('i64 n'))).toEqual([-1]);
});

test('a text has no numbers, and neither has what is no format', () => {
  for (const format of ['text 64', '', 'i32 x, u9 y']) expect(partsOf(format)).toEqual([]);
});

test('what nobody has told is the format of the node if that fits, else whole numbers', () => {
  expect(kinds(4, 'f32 x')).toEqual(['f32']);
  expect(kinds(2, 'i32 x')).toEqual(['u16']);
  expect(kinds(1, 'i32 x')).toEqual(['u8']);
  expect(kinds(8, 'i32 x')).toEqual(['i32', 'i32']);
  expect(kinds(3, 'i32 x')).toEqual(['u8', 'u8', 'u8']);
  expect(kinds(100, 'text 100')).toHaveLength(100);
});

test('a large tuple is shown by its beginning', () => {
  expect(hexText('4201')).toBe('42 01');
  expect(hexText('00'.repeat(40))).toBe(`${'00 '.repeat(32)}...`);
  expect(hexText('00'.repeat(4) + '...')).toBe('00 00 00 00 ...');
  expect(bytesIn('0102...')).toEqual(new Uint8Array([1, 2]));
});
