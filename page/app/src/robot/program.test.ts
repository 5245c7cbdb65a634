import { describe, expect, test } from 'vitest';
import { failureOf, isName, type OutputLine, runningOf } from './program.svelte';

describe('programs', () => {
  test('the status names what runs', () => {
    expect(runningOf('status: program none\nprograms 0 started, 0 failed\n')).toBe('');
    expect(runningOf('status: program l.qrs (diagram, process 1429) for 1 s\nx')).toBe('l.qrs');
    expect(runningOf('status: program a (b).py (Python, process 2) for 3 s\n')).toBe('a (b).py');
    expect(runningOf('')).toBe('');
  });

  test('the reasons of a failure are those of the last run', () => {
    const lines = (...texts: [OutputLine['kind'], string][]) =>
      texts.map(([kind, text], number) => ({ kind, text, number }));
    const failed = lines(
      ['error', 'of before'],
      ['info', 'a.flow has started'],
      ['error', 'no sensor'],
      ['info', 'a.flow has failed with exit code 1 after 0.0 s'],
      ['error', 'of another one'],
    );
    expect(failureOf(failed, 'a.flow')).toEqual(['no sensor']);
    expect(failureOf(failed, 'b.flow')).toEqual([]);
    const again = [...failed, ...lines(['info', 'a.flow has started'], ['error', 'a warning'])];
    expect(failureOf(again, 'a.flow')).toEqual([]);
  });

  test('names that the control port would take for something else are refused', () => {
    for (const good of ['a.py', 'sub/a.qrs', '\u041b\u0438\u043d\u0438\u044f 1.qrs', '<b>.js'])
      expect(isName(good)).toBe(true);
    for (const bad of ['', 'a:b', 'a\nb', 'a\u0000', 'x\\y', 'n'.repeat(201)])
      expect(isName(bad)).toBe(false);
  });
});
