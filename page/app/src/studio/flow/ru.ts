// What the studio says of programs of data flow, in Russian.

import type { Words } from './en';

export const ru: Words = {
  blank: 'Новая потоковая',
  blankHint: 'Программа из блоков, которые обмениваются значениями по линиям',
  categories: {
    control: 'Вычисления',
    streams: 'Потоки',
    devices: 'Робот',
    shell: 'Звук, камера, файлы',
  },
  source: 'текст потоковой программы',
  of: {
    unit: 'сигнал без значения',
    truth: 'true или false',
    whole: 'целое число',
    text: 'текст',
    list: 'список',
    any: 'любое значение',
  },
  input: (name: string, of: string) => `Вход ${name}: ${of}`,
  output: (name: string, of: string) => `Выход ${name}: ${of}`,
  from: 'От выхода',
  to: 'К входу',
  noPorts: 'У этого блока нет выхода, от которого могла бы идти связь.',
  linked: (from: string, to: string) => `Связь от ${from} к ${to}`,
  policy: 'Если данные приходят быстрее, чем их берут',
  policies: {
    '': 'как обычно: теряется самое старое',
    fifo: 'теряется самое старое',
    latest: 'остаётся только самое новое',
    error: 'программа кончается ошибкой',
  },
  capacity: 'Сколько данных ждёт самое большее',
  textOpened: (name: string) => `${name} нарисован и сохраняется как проект. Комментарии не сохраняются.`,
};
