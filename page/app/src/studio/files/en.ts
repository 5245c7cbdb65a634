// What the studio says of files and folders of the computer, in English; `ru.ts` has the same in Russian.

export const en = {
  openFolder: 'Open a folder',
  folder: (name: string) => `Folder ${name}`,
  emptyFolder: 'No NAME.qrs is in it.',
  cut: (most: number) => `There are more: the first ${most} that were found are listed.`,
  lookAgain: 'Look again',
  closeFolder: 'Close the folder',
  noFolder: (why: string) => `The folder is not opened: ${why}`,
  saved: (name: string) => `${name} was saved where it was opened.`,
  denied: (name: string) => `The browser may not write ${name}.`,
  changed: (name: string) => `Somebody else has changed ${name} since it was opened here.`,
  gone: (name: string) => `${name} is no longer where it was opened.`,
  notWritten: (name: string, why: string) => `${name} was not written: ${why}`,
  writeOver: 'Write over it',
  saveCopy: 'Save a copy',
  notSaved: 'It is not saved',
};

export type Words = typeof en;
