// What the studio says of programs with text, in Russian.

import type { Words } from './en';

export const ru: Words = {
  newPython: 'Новая на Python',
  newJavaScript: 'Новая на JavaScript',
  newHint: 'Программа в виде текста',
  program: (name) => `Программа ${name}`,
  tooLarge: (mib) => `он больше ${mib} МиБ`,
  loading: 'Загружается Python',
  computing: 'Программа выполняется',
  seen: 'Момент',
  play: 'Показать',
  pause: 'Пауза',
  world: 'Мир',
  worldOf: (name) => `Мир: ${name}`,
  worldTask: 'Мир: из задачи',
  worldEmpty: 'Мир: пустой пол',
  inputs: 'Ответы на input(), по одному в строке',
  line: (line) => `строка ${line}`,
  remarks: 'Замечания',
  noPython:
    'На этом сервере нет Python: студию нужно собрать командой web/site.sh --python. Программы на JavaScript выполняются и без него.',
  silent: (seconds) =>
    `Программа вычисляла ${seconds} с и ни о чём не спрашивала робота, поэтому она остановлена. Может быть, в цикле нет ожидания?`,
  noEngine: (seconds) => `Среда выполнения не загрузилась за ${seconds} с.`,
  crashed: (why) => `Среда выполнения завершилась: ${why}`,
  notRun: (why) => `Программа не выполняется: ${why}`,
  examples: {
    py: 'brick.motor(M3).setPower(50)\nbrick.motor(M4).setPower(50)\nscript.wait(2000)\nbrick.stop()\n',
    js: 'brick.motor(M3).setPower(50);\nbrick.motor(M4).setPower(50);\nscript.wait(2000);\nbrick.stop();\n',
  },
  untitled: { py: 'program.py', js: 'program.js' },
};
