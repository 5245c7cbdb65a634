import { describe, expect, test } from 'vitest';
import { isName, runningOf } from './program.svelte';

describe('programs', () => {
  test('the status names what runs', () => {
    expect(runningOf('status: program none\nprograms 0 started, 0 failed\n')).toBe('');
    expect(runningOf('status: program l.qrs (diagram, process 1429) for 1 s\nx')).toBe('l.qrs');
    expect(runningOf('status: program a (b).py (Python, process 2) for 3 s\n')).toBe('a (b).py');
    expect(runningOf('')).toBe('');
  });

  test('names that the control port would take for something else are refused', () => {
    for (const good of ['a.py', 'sub/a.qrs', '\u041b\u0438\u043d\u0438\u044f 1.qrs', '<b>.js'])
      expect(isName(good)).toBe(true);
    for (const bad of ['', 'a:b', 'a\nb', 'a\u0000', 'x\\y', 'n'.repeat(201)])
      expect(isName(bad)).toBe(false);
  });
});
