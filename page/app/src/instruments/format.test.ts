import { describe, expect, it } from 'vitest';
import { type Field, fieldsOf, named, rangeOf, sliderOf, textOf, tupleText, typed, unitsOf } from './format';

const field = (kind: string): Field => ({ name: 'n', kind });

describe('formats', () => {
  it('have fields, bytes or a text', () => {
    expect(fieldsOf('i32 x, >u16 Y')).toEqual([
      { name: 'x', kind: 'i32' },
      { name: 'y', kind: 'u16' },
    ]);
    expect(fieldsOf('u8 x 65536')).toEqual([{ name: 'data', kind: 'bytes' }]);
    expect(fieldsOf('text 128')).toEqual([{ name: 'data', kind: 'text' }]);
    expect(fieldsOf('u8 x')).toEqual([{ name: 'x', kind: 'u8' }]);
    expect(fieldsOf(',,').every(({ kind }) => rangeOf(field(kind)) === undefined)).toBe(true);
  });

  it('take the names of samples if there are as many', () => {
    expect(named(fieldsOf('i8 a, i8 b'), ['c', 'd']).map(({ name }) => name)).toEqual(['c', 'd']);
    expect(named(fieldsOf('i8 a, i8 b'), []).map(({ name }) => name)).toEqual(['a', 'b']);
  });

  it('have units for all or for each', () => {
    expect(unitsOf('mg', 2)).toEqual(['mg', 'mg']);
    expect(unitsOf('mm, mm, deg', 3)).toEqual(['mm', 'mm', 'deg']);
    expect(unitsOf('mm, deg', 3)).toEqual(['mm', 'deg', '']);
  });
});

describe('ranges', () => {
  it('are those of the kind', () => {
    expect(rangeOf(field('i8'))).toEqual({ min: -128, max: 127 });
    expect(rangeOf(field('u16'))).toEqual({ min: 0, max: 65535 });
    expect(rangeOf(field('i32'))).toEqual({ min: -2147483648, max: 2147483647 });
    expect(rangeOf(field('u64'))).toEqual({ min: 0, max: Number.MAX_SAFE_INTEGER });
    for (const kind of ['text', 'bytes', '', 'i7', 'f16']) expect(rangeOf(field(kind))).toBeUndefined();
  });

  it('of sliders follow the unit within the kind', () => {
    expect(sliderOf(field('i32'), '%')).toEqual({ min: -100, max: 100 });
    expect(sliderOf(field('u8'), '%')).toEqual({ min: 0, max: 100 });
    expect(sliderOf(field('u8'), '')).toEqual({ min: 0, max: 255 });
    expect(sliderOf(field('i8'), 'mdeg')).toEqual({ min: -128, max: 127 });
    expect(sliderOf(field('f64'), '')).toEqual({ min: -100, max: 100 });
    expect(sliderOf(field('f64'), 'toString')).toEqual({ min: -100, max: 100 });
    expect(sliderOf(field('text'), '%')).toBeUndefined();
  });
});

describe('what is sent', () => {
  it('is finite and in the range', () => {
    expect(textOf(field('i32'), 29.6)).toBe('30');
    expect(textOf(field('i32'), -0.2)).toBe('0');
    expect(textOf(field('f32'), 0.5)).toBe('0.5');
    const wrong: [string, number][] = [
      ['i32', NaN],
      ['f64', Infinity],
      ['f32', 1e39],
      ['i8', 127.6],
      ['u8', -1],
      ['text', 1],
    ];
    for (const [kind, value] of wrong) expect(textOf(field(kind), value), kind).toBeUndefined();
  });

  it('is all of a tuple or nothing', () => {
    const fields = [field('i8'), field('f32')];
    expect(tupleText(fields, [1, 2.5])).toBe('1 2.5');
    expect(tupleText(fields, [1])).toBeUndefined();
    expect(tupleText(fields, [1, NaN])).toBeUndefined();
    expect(tupleText([], [])).toBeUndefined();
  });

  it('is a number as a person types it', () => {
    expect(typed(field('f64'), ' 1,5 ')).toBe(1.5);
    expect(typed(field('i32'), '-30')).toBe(-30);
    for (const text of ['', 'x', '1e999', '0x10', '1.5', 'NaN', 'Infinity', '1 2', '--1']) {
      expect(typed(field('i32'), text), text).toBeUndefined();
    }
  });
});
