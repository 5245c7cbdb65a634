// What the studio says of files and folders, in Russian.

import type { Words } from './en';

export const ru: Words = {
  openFolder: 'Открыть папку',
  folder: (name) => `Папка ${name}`,
  emptyFolder: 'Файлов NAME.qrs в ней нет.',
  cut: (most) => `Есть и другие: показаны первые найденные, не больше ${most}.`,
  lookAgain: 'Обновить',
  closeFolder: 'Закрыть папку',
  noFolder: (why) => `Папка не открыта: ${why}`,
  saved: (name) => `${name}: сохранено туда, откуда открыто.`,
  denied: (name) => `Браузеру нельзя записывать ${name}.`,
  changed: (name) => `${name} кто-то изменил с тех пор, как файл открыт здесь.`,
  gone: (name) => `${name} больше нет там, откуда файл открыт.`,
  notWritten: (name, why) => `${name} не записан: ${why}`,
  writeOver: 'Записать поверх',
  saveCopy: 'Сохранить копию',
  notSaved: 'Не сохранено',
};
