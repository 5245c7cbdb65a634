// What the studio says of programs of data flow, in English; `ru.ts` has the same in Russian.

export const en = {
  blank: 'New data flow',
  blankHint: 'A program of blocks that exchange values along lines',
  categories: {
    control: 'Computing',
    streams: 'Streams',
    devices: 'Robot',
    shell: 'Sound, camera, files',
  },
  source: 'text of data flow',
  of: {
    unit: 'a signal without a value',
    truth: 'true or false',
    whole: 'a whole number',
    text: 'a text',
    list: 'a list',
    any: 'any value',
  },
  input: (name: string, of: string) => `Input ${name}: ${of}`,
  output: (name: string, of: string) => `Output ${name}: ${of}`,
  from: 'From the output',
  to: 'To the input',
  noPorts: 'This block has no output from which a link could lead.',
  linked: (from: string, to: string) => `Link from ${from} to ${to}`,
  policy: 'If tokens come faster than they are taken',
  policies: {
    '': 'as usual: the oldest is lost',
    fifo: 'the oldest is lost',
    latest: 'only the newest is kept',
    error: 'the program ends with an error',
  },
  capacity: 'Tokens that wait at most',
  textOpened: (name: string) => `${name} is drawn, and saved as a project. Its comments are not kept.`,
};

export type Words = typeof en;
