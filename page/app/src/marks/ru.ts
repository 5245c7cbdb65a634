// What the page of marks says, in Russian.

import type { Words } from './en';

export const ru: Words = {
  title: (name) => (name ? `${name} — оценки ТРИК` : 'Оценки ТРИК'),
  heading: 'Оценки',
  headingOf: (name: string) => (name ? `Оценки: ${name}` : 'Оценки'),
  judged: ({ done, all }) => `Проверено: ${done} из ${all}`,
  over: 'Всё проверено.',
  stays: 'Страницу завершит Ctrl-C в терминале.',
  tally: ({ good, wrong, broken, missing }) =>
    [
      `выполнено: ${good}`,
      `не выполнено: ${wrong}`,
      broken > 0 && `не удалось проверить: ${broken}`,
      missing > 0 && `нет решений: ${missing}`,
    ]
      .filter(Boolean)
      .join(', '),
  connecting: 'Страница не соединена с командой, которая проверяет; попытки продолжаются.',
  gone: 'Команда проверки завершена: здесь последнее, что она сообщила, записи запусков больше не открываются.',
  table: 'Оценки всех учеников',
  scroll: 'Таблица оценок, прокручивается вбок',
  pupil: 'Ученик',
  times: (weight) => `\u00d7${weight}`,
  sum: 'Сумма',
  sumSoFar: 'Сумма пока',
  passed: (mark) => `Зачтено (\u2265 ${mark})`,
  yes: 'да',
  no: 'нет',
  notYet: 'пока нет',
  waiting: (runs) => (runs === 1 ? 'ещё не проверено' : `ещё не проверено запусков: ${runs}`),
  more: (runs) => `ещё не проверено: ${runs}`,
  missing: 'нет решения',
  seconds: (text) => `${text} с`,
  replay: (verdict, pupil, column) => `${verdict}: запись запуска, ${pupil}, ${column}`,
  nobody: 'Учеников нет.',
  leftOut: (count) => `Пропущено: ${count}`,
  unnamed: (count) => `и ещё ${count}`,
};
