// What the page of a class and its server say to each other; `page/src/class/word.rs` has the other end.

/** What the page wants. A file goes as such an object without `do` and with `run`, in one line, and the bytes behind that. */
export type Order = { do: 'stop'; robots: number[] } | { do: 'run'; robots: number[]; name: string };

/** A robot, as the class names it. */
export interface Title {
  name: string;
  group: string;
  at: string;
}

/** What became of a stop. */
export type Stop =
  { is: 'asked' } | { is: 'rests'; ms: number } | { is: 'failed'; why: string } | { is: 'missed' };

/** A file that was sent to a robot, or a program that was started there. */
export interface Sending {
  name: string;
  is: 'sending' | 'sent' | 'starts' | 'runs' | 'failed';
  done: number;
  /** 0: it was there already. */
  bytes: number;
  why: string | null;
}

/** What the battery of a robot had. */
export interface Battery {
  /** The value with its unit. */
  text: string;
  /** How long ago that was when it was told. */
  ageMs: number;
}

/** What is known of a robot. */
export interface Card {
  reach: 'unknown' | 'there' | 'absent';
  why: string | null;
  /** Where its own page is. */
  page: string | null;
  runs: string | null;
  last: string | null;
  error: string | null;
  /** Stays when the robot is gone. */
  battery: Battery | null;
  /** The computer that has started or stopped a program last; empty: the server of this page. */
  commander: string | null;
  /** The computer that controls the debugger. */
  debugger: string | null;
  stop: Stop | null;
  sending: Sending | null;
}

/** What the page is told. */
export type News =
  | { is: 'hello'; name: string; version: string; drives: boolean; marks: boolean; robots: Title[] }
  | ({ is: 'robot'; id: number } & Card)
  | { is: 'refused'; why: string }
  | { is: 'beat' };

/** Nothing is known of a robot. */
export const BLANK: Card = {
  reach: 'unknown',
  why: null,
  page: null,
  runs: null,
  last: null,
  error: null,
  battery: null,
  commander: null,
  debugger: null,
  stop: null,
  sending: null,
};
