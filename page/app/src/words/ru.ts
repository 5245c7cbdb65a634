// Что говорит страница, по-русски.

import type { Words } from './en';

export const ru: Words = {
  title: (robot) => (robot ? `${robot} - ТРИК` : 'ТРИК'),
  stop: 'Стоп',
  stopHint: 'Всё остановить, программу завершить (пробел)',
  connecting: 'Страница не соединена, она пробует снова.',
  robotAbsent: (why) => `Робот не отвечает: ${why}`,
  world: 'Мир',
  instruments: 'Приборы',
  program: 'Программа',
  diagram: 'Диаграмма',
  log: 'Журнал',
  inControl: 'Управляете вы',
  otherControl: (who) => `Управляет ${who}`,
  nobodyControl: 'Никто не управляет',
  takeControl: 'Взять управление',
  leaveControl: 'Отдать управление',
  onlyLook: 'Этот компьютер может только смотреть',
  dismiss: 'Закрыть',
};
