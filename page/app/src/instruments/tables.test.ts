import { describe, expect, it } from 'vitest';
import { cell, table } from './csv';
import { joined, summary, thinned, valueAt } from './series';

describe('a table', () => {
  it('has no formulas', () => {
    expect(cell('anna')).toBe('anna');
    expect(cell('=HYPERLINK("http://x")')).toBe('"\'=HYPERLINK(""http://x"")"');
    expect(cell(' =1')).toBe('"\' =1"');
    expect(cell('-5')).toBe('"\'-5"');
    expect(cell('@a')).toBe('"\'@a"');
    expect(cell('a,b;c')).toBe('"a,b;c"');
    expect(cell('\uff1d1')).toBe('"\'\uff1d1"');
  });

  it('has a row for each time, and nothing where nothing was', () => {
    const text = table(
      ['a', '+b'],
      [0, 1.5],
      [
        [-1, null],
        [undefined, 2],
      ],
    );
    expect(text).toBe('time_s,a,"\'+b"\n0.000000,-1,\n1.500000,,2\n');
  });
});

describe('series', () => {
  it('are joined with gaps only where a number failed', () => {
    const both = joined([
      { times: [1, 3, 6], values: [10, NaN, 15] },
      { times: [2, 3, 4, 5], values: [20, 30, 40, 50] },
    ]);
    expect(both.times).toEqual([1, 2, 3, 4, 5, 6]);
    expect(both.columns).toEqual([
      [10, undefined, null, null, null, 15],
      [undefined, 20, 30, 40, 50, undefined],
    ]);
  });

  it('keep peaks and gaps when thinned', () => {
    const times = Array.from({ length: 10_000 }, (_, at) => at);
    const values = times.map((at) => (at === 5001 ? 99 : at === 7000 ? NaN : at % 2));
    const thin = thinned({ times, values }, 1000);
    expect(thin.times.length).toBeLessThanOrEqual(1010);
    expect(thin.values).toContain(99);
    expect(thin.values.some(Number.isNaN)).toBe(true);
    expect([...thin.times].sort((one, other) => one - other)).toEqual(thin.times);
  });

  it('are summed up over time, as values hold until the next one', () => {
    const samples = { times: [0, 10, 13, 14], values: [4, 8, NaN, 6] };
    expect(summary(samples, 9, 15)).toEqual({ min: 4, max: 8, mean: (4 + 3 * 8 + 6) / 5 });
    expect(summary(samples, 13.2, 13.5)).toBeUndefined();
    expect(summary({ times: [1], values: [5] }, 1, 1)).toEqual({ min: 5, max: 5, mean: 5 });
    expect(summary({ times: [], values: [] }, 0, 1)).toBeUndefined();
    expect(valueAt(samples, 12)).toBe(8);
    expect(valueAt(samples, 13.5)).toBeNaN();
    expect(valueAt(samples, -1)).toBeNaN();
  });
});
