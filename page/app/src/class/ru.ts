// What the page of a class says, in Russian.

import type { Words } from './en';

export const ru: Words = {
  stopUnsent:
    'Последняя остановка не отправлена: страница не была соединена со своим сервером. Остановите ещё раз или остановите роботов на них самих.',
  title: (name) => (name ? `${name} — класс ТРИК` : 'Класс ТРИК'),
  stopAll: 'Стоп всем',
  stopHint: 'Остановить всё на всех роботах и завершить их программы (пробел)',
  keys: 'Пробел: остановить всех. Enter: выбрать робота, нажать кнопку.',
  connecting: 'Страница не соединена со своим сервером; попытки продолжаются.',
  onlyLook: 'С этого компьютера можно только смотреть; роботами управляют там, где работает страница.',
  sum: ({ all, there, run }) => `На связи: ${there} из ${all}, выполняют программу: ${run}`,
  stopped: ({ rest, slowest_ms, waiting, away, failed }) =>
    [
      rest > 0 && `остановлено: ${rest}, последний через ${slowest_ms} мс`,
      waiting > 0 && `ещё нет: ${waiting}`,
      failed > 0 && `НЕ остановлено: ${failed}`,
      away > 0 && `нет связи: ${away}`,
    ]
      .filter(Boolean)
      .join('; '),
  stopTold: 'Стоп',
  dismiss: 'Скрыть',
  noRobots: 'В классе нет роботов.',

  robots: 'Роботы',
  marks: 'Оценки',
  choose: (name) => `Выбрать: ${name}`,
  everybody: 'Все',
  nobody: 'Никто',
  group: (name) => `Группа ${name}`,
  chosen: (count, all) => `Выбрано: ${count} из ${all}`,
  stopChosen: 'Остановить выбранных',

  sendTitle: 'Отправить программу',
  drop: 'Выберите файл или перетащите его на страницу (.qrs, .flow, .py, .js, .lua)',
  file: (name, bytes) => `${name}, ${bytes < 2048 ? `${bytes} Б` : `${Math.round(bytes / 1024)} КиБ`}`,
  sendRun: (count) => `Отправить и запустить (${count})`,
  send: (count) => `Только отправить (${count})`,
  runAgain: (name, count) => `Запустить ${name} (${count})`,
  notSent: {
    name: 'Файл с таким именем не может быть программой: в имени двоеточие, обратная черта или управляющие символы.',
    size: 'Файл больше 16 МиБ, робот столько не принимает.',
    offline: 'Страница не соединена со своим сервером.',
    unread: 'Файл больше не читается: выберите его ещё раз.',
    stopped: 'Остановка была нажата раньше, чем файл был отправлен.',
  },

  mark: {
    unknown: 'поиск',
    absent: 'нет связи',
    wrong: 'что-то не так',
    runs: 'выполняет программу',
    idle: 'готов',
  },
  runs: (name) => `Выполняется ${name}`,
  nothingRuns: 'программа не выполняется',
  battery: (text) => `батарея: ${text}`,
  ago: (seconds) => (seconds < 120 ? `${seconds} с назад` : `${Math.floor(seconds / 60)} мин назад`),
  commander: (who) => (who ? `управляет ${who}` : 'управляет эта страница'),
  debugger: (who) => `отлаживает ${who}`,
  openPage: 'Его страница',
  openPageOf: (name) => `Его страница: ${name}`,
  stopAsked: 'останавливается',
  stopAway: 'будет остановлен, как только появится связь',
  stopRests: (ms) => `остановлен через ${ms} мс после команды`,
  stopFailed: (why) => `НЕ остановлен: ${why}`,
  stopMissed: 'не было связи целую минуту: не остановлен',
  progress: (name) => `${name}: отправляется`,
  sending: {
    sending: (name) => `${name}: отправляется`,
    sent: (name) => `${name}: получена`,
    starts: (name) => `${name}: запускается`,
    runs: (name) => `${name}: запущена`,
    failed: (name) => `${name}: не вышло`,
  },
};
