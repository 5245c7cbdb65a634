// What the page of a class says, in English; `ru.ts` has the same in Russian, and does not compile without a text of it.

import type { Mark, StopSum, Sum } from './sum';

export const en = {
  stopUnsent:
    'The last stop was not sent: the page was not connected to its server. Stop again, or stop the robots themselves.',
  title: (name: string) => (name ? `${name} - TRIK class` : 'TRIK class'),
  stopAll: 'Stop all',
  stopHint: 'Everything on all robots to rest, their programs to their end (space bar)',
  keys: 'Space bar: stop all. Enter: choose a robot, press a button.',
  connecting: 'The page is not connected to its server; it tries again.',
  onlyLook: 'This computer may only look; robots are commanded on the computer that serves the page.',
  sum: ({ all, there, run }: Sum) => `${there} of ${all} reached, ${run} running`,
  stopped: ({ rest, slowest_ms, waiting, away, failed }: StopSum) =>
    [
      rest > 0 && `${rest} at rest, the last after ${slowest_ms} ms`,
      waiting > 0 && `${waiting} not yet`,
      failed > 0 && `${failed} NOT at rest`,
      away > 0 && `${away} not reached`,
    ]
      .filter(Boolean)
      .join('; '),
  stopTold: 'Stop',
  dismiss: 'Dismiss',
  noRobots: 'The class has no robots.',

  robots: 'Robots',
  marks: 'Marks',
  choose: (name: string) => `Choose ${name}`,
  everybody: 'All',
  nobody: 'None',
  group: (name: string) => `Group ${name}`,
  chosen: (count: number, all: number) => `${count} of ${all} chosen`,
  stopChosen: 'Stop the chosen ones',

  sendTitle: 'Send a program',
  drop: 'Choose a file, or drop it anywhere on the page (.qrs, .flow, .py, .js, .lua)',
  file: (name: string, bytes: number) =>
    `${name}, ${bytes < 2048 ? `${bytes} B` : `${Math.round(bytes / 1024)} KiB`}`,
  sendRun: (count: number) => `Send to ${count} and run`,
  send: (count: number) => `Only send to ${count}`,
  runAgain: (name: string, count: number) => `Run ${name} on ${count}`,
  notSent: {
    name: 'A file of this name cannot be a program: it has a colon, a backslash or control characters.',
    size: 'The file is larger than 16 MiB, which is the most that a robot takes.',
    offline: 'The page is not connected to its server.',
    unread: 'The file cannot be read any more: choose it again.',
    stopped: 'Stop was pressed before it was sent.',
  },

  mark: {
    unknown: 'being looked for',
    absent: 'not reached',
    wrong: 'something is wrong',
    runs: 'runs',
    idle: 'ready',
  } satisfies Record<Mark, string>,
  runs: (name: string) => `${name} runs`,
  nothingRuns: 'no program runs',
  battery: (text: string) => `battery ${text}`,
  ago: (seconds: number) => (seconds < 120 ? `${seconds} s ago` : `${Math.floor(seconds / 60)} min ago`),
  commander: (who: string) => (who ? `${who} is in control` : 'this page is in control'),
  debugger: (who: string) => `${who} debugs`,
  openPage: 'Its page',
  openPageOf: (name: string) => `Its page: ${name}`,
  stopAsked: 'is being stopped',
  stopAway: 'will be stopped as soon as it is reached',
  stopRests: (ms: number) => `at rest, ${ms} ms after the order`,
  stopFailed: (why: string) => `NOT at rest: ${why}`,
  stopMissed: 'was not reached within a minute: not stopped',
  progress: (name: string) => `${name} is on its way`,
  sending: {
    sending: (name: string) => `${name} is on its way`,
    sent: (name: string) => `${name} has arrived`,
    starts: (name: string) => `${name} is being started`,
    runs: (name: string) => `${name} has started`,
    failed: (name: string) => `${name}: not done`,
  },
};

export type Words = typeof en;
