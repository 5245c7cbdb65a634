// What the page of marks says, in English; `ru.ts` has the same in Russian, and does not compile without a text of it.

import type { Progress } from './news';
import type { Tally } from './tally';

export const en = {
  title: (name: string) => (name ? `${name} - TRIK marks` : 'TRIK marks'),
  heading: 'Marks',
  headingOf: (name: string) => (name ? `Marks: ${name}` : 'Marks'),
  judged: ({ done, all }: Progress) => `${done} of ${all} judged`,
  over: 'All is judged.',
  stays: 'Ctrl-C in the terminal ends this page.',
  tally: ({ good, wrong, broken, missing }: Tally) =>
    [
      `${good} good`,
      `${wrong} not accomplished`,
      broken > 0 && `${broken} could not be judged`,
      missing > 0 && `${missing} missing`,
    ]
      .filter(Boolean)
      .join(', '),
  connecting: 'The page is not connected to the command that judges; it tries again.',
  gone: 'The command that judges has ended: what is here is the last that it said, and replays open no more.',
  table: 'Marks of all pupils',
  scroll: 'Table of marks; it can be moved sideways',
  pupil: 'Pupil',
  times: (weight: string) => `\u00d7${weight}`,
  sum: 'Sum',
  sumSoFar: 'Sum so far',
  passed: (mark: string) => `Passed (\u2265 ${mark})`,
  yes: 'yes',
  no: 'no',
  notYet: 'not yet',
  waiting: (runs: number) => (runs === 1 ? 'not judged yet' : `${runs} runs not judged yet`),
  more: (runs: number) => `${runs} more not judged yet`,
  missing: 'missing',
  seconds: (text: string) => `${text} s`,
  replay: (verdict: string, pupil: string, column: string) => `${verdict}: replay of ${pupil}, ${column}`,
  nobody: 'There are no pupils.',
  leftOut: (count: number) => `Left out: ${count}`,
  unnamed: (count: number) => `and ${count} more`,
};

export type Words = typeof en;
