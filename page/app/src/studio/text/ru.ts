// What mends of mistakes do, in Russian.

import type { Words } from './en';

export const ru: Words = {
  mends: 'Что можно сделать',
  connectTo: (name) => `Соединить с ${name}`,
  connectFrom: (name) => `Соединить от ${name}`,
  addEnd: 'Добавить конец',
  addBeginning: 'Добавить начало',
  remove: (name) => `Удалить ${name}`,
  mark: (name, guard) => `Связь к ${name} — ${guard}`,
  unlink: (name) => `Удалить связь к ${name}`,
  removeLoose: 'Удалить висящие связи',
  call: (name) => `Вызывать ${name}`,
  replace: (name, other) => `Написать ${other} вместо ${name}`,
  giveValue: (name) => `Начать с ${name} = 0`,
  put: (value, title) => `Поставить ${value} в поле «${title}»`,
};
