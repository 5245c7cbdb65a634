// Programs that are texts: which they are, and what a new one begins with.
//
// Owns the ends of their names. What is run is known to the robot.

const BEGINNINGS: Record<string, string> = {
  py: [
    'import os',
    '',
    "TREE = os.environ.get('TRIK_TREE', '/trikfs')",
    '',
    "with open(TREE + '/battery/value') as battery:",
    "    print('battery:', battery.read().strip(), 'V')",
    '',
  ].join('\n'),
  js: "print('battery: ' + brick.battery().readVoltage() + ' V');\n",
  lua: [
    "local TREE = os.getenv('TRIK_TREE') or '/trikfs'",
    '',
    "local battery = assert(io.open(TREE .. '/battery/value'))",
    "print('battery: ' .. battery:read('*l') .. ' V')",
    '',
  ].join('\n'),
  flow: [
    '# A value every second, and what is done with it.',
    'diagram "Clock"',
    '  clock: Loop(start_border = 1, end_border = 10, time = 1000)',
    '  count: "Text programming"(IO0 = `print("second " .. I0); I0`)',
    '  clock.OUT -> count.I0',
    '',
  ].join('\n'),
};

/** The end of a name, without its dot. */
export const endOf = (name: string): string => /\.([^./]+)$/.exec(name)?.[1] ?? '';

/** Whether a program is a text that can be edited. */
export const isSource = (name: string): boolean => endOf(name) in BEGINNINGS;

/** What a new program of this name begins with. */
export const beginningOf = (name: string): string => BEGINNINGS[endOf(name)] ?? '';
