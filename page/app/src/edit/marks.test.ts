import { describe, expect, test } from 'vitest';
import { marksOfConfiguration, marksOfRun } from './marks';

describe('the line of an error', () => {
  test('is the deepest one of the program itself in a traceback of Python', () => {
    const said = [
      'Traceback (most recent call last):',
      '  File "/var/programs/a.py", line 4, in <module>',
      '    f()',
      '  File "/var/programs/a.py", line 3, in f',
      '    return json.loads("x")',
      '  File "/usr/lib/python3/json/decoder.py", line 355, in raw_decode',
      '    raise JSONDecodeError("Expecting value", s, err.value) from None',
      'json.decoder.JSONDecodeError: Expecting value: line 1 column 1 (char 0)',
    ].join('\n');
    expect(marksOfRun('a.py', said)).toEqual([
      { line: 3, text: 'json.decoder.JSONDecodeError: Expecting value: line 1 column 1 (char 0)' },
    ]);
    const syntax = '  File "/x/sub/s.py", line 2\n    for x in\n            ^\nSyntaxError: invalid syntax\n';
    expect(marksOfRun('sub/s.py', syntax)).toEqual([{ line: 2, text: 'SyntaxError: invalid syntax' }]);
    expect(marksOfRun('b.py', said)).toEqual([]);
  });

  test('is the first one that JavaScript and Lua name', () => {
    const script = "Line 3: TypeError: Result of expression 'a.b' [undefined] is not an object.\nf() at 3\n";
    expect(marksOfRun('a.js', script)).toEqual([
      { line: 3, text: "TypeError: Result of expression 'a.b' [undefined] is not an object." },
    ]);
    const lua =
      '/usr/bin/luajit: /x/a.lua:2: attempt to call a nil value\nstack traceback:\n\t/x/a.lua:9: in main chunk';
    expect(marksOfRun('a.lua', lua)).toEqual([{ line: 2, text: 'attempt to call a nil value' }]);
    expect(marksOfRun('a.lua', 'extra.lua:2: x')).toEqual([]);
    const flow = "no program\nc.flow is not changed: 2:6 there is no block 'Sensr'";
    expect(marksOfRun('c.flow', flow)).toEqual([{ line: 2, text: "there is no block 'Sensr'" }]);
    expect(marksOfRun('c.lua', flow)).toEqual([]);
    expect(marksOfRun('a(b.lua', 'x/a(b.lua:7: y')).toEqual([{ line: 7, text: 'y' }]);
  });

  test('is in what the filesystem says, once for each node', () => {
    const refused = "config refused: config:20: unexpected symbol near '='";
    expect(marksOfConfiguration(refused, [])).toEqual([{ line: 20, text: "unexpected symbol near '='" }]);
    const fault = "converter: config:4: attempt to index local 'x' (a number value)";
    expect(
      marksOfConfiguration('config ok: 2 nodes', [
        ['m', fault],
        ['n', 'device: no answer'],
        ['m', fault],
      ]),
    ).toEqual([{ line: 4, text: "m: attempt to index local 'x' (a number value)" }]);
    expect(marksOfConfiguration('config refused: trik.lua:3: x', [])).toEqual([]);
  });
});
