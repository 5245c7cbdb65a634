// What mends of mistakes do, in English; `ru.ts` has the same in Russian.

export const en = {
  mends: 'What can be done',
  connectTo: (name: string) => `Connect to ${name}`,
  connectFrom: (name: string) => `Connect from ${name}`,
  addEnd: 'Add an end',
  addBeginning: 'Add a beginning',
  remove: (name: string) => `Remove ${name}`,
  mark: (name: string, guard: string) => `The link to ${name} is ${guard}`,
  unlink: (name: string) => `Remove the link to ${name}`,
  removeLoose: 'Remove what hangs loose',
  call: (name: string) => `Call ${name}`,
  replace: (name: string, other: string) => `Write ${other} for ${name}`,
  giveValue: (name: string) => `Begin with ${name} = 0`,
  put: (value: string, title: string) => `Put ${value} into ${title}`,
};

export type Words = typeof en;
