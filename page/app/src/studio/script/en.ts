// What the studio says of programs with text, in English.

export const en = {
  newPython: 'New in Python',
  newJavaScript: 'New in JavaScript',
  newHint: 'A program with text',
  program: (name: string) => `Program ${name}`,
  tooLarge: (mib: number) => `it is larger than ${mib} MiB`,
  loading: 'Python is being loaded',
  computing: 'The program runs',
  seen: 'Moment',
  play: 'Show',
  pause: 'Pause',
  world: 'World',
  worldOf: (name: string) => `World: ${name}`,
  worldTask: 'World: that of the task',
  worldEmpty: 'World: an empty floor',
  inputs: 'Answers to input(), one in a line',
  line: (line: number) => `line ${line}`,
  remarks: 'Remarks',
  noPython:
    'Python is not on this server: the studio has to be built with web/site.sh --python. Programs in JavaScript run without it.',
  silent: (seconds: number) =>
    `The program has computed for ${seconds} s and asked its robot for nothing: it was ended. Does a loop lack a wait?`,
  noEngine: (seconds: number) => `The engine has not come in ${seconds} s.`,
  crashed: (why: string) => `The engine has ended: ${why}`,
  notRun: (why: string) => `The program does not run: ${why}`,
  examples: {
    py: 'brick.motor(M3).setPower(50)\nbrick.motor(M4).setPower(50)\nscript.wait(2000)\nbrick.stop()\n',
    js: 'brick.motor(M3).setPower(50);\nbrick.motor(M4).setPower(50);\nscript.wait(2000);\nbrick.stop();\n',
  },
  untitled: { py: 'program.py', js: 'program.js' },
};

export type Words = typeof en;
