// What the server of the page of marks says; `page/src/marks/word.rs` has the other end. The page says nothing.

/** A task in one of its worlds. */
export interface Column {
  name: string;
  /** What its points are multiplied with. */
  weight: number;
}

/** A run that was judged. */
export interface Mark {
  tone: 'good' | 'wrong' | 'broken';
  /** How it ended, in words. */
  verdict: string;
  /** Nothing: it was not judged. */
  points: number | null;
  /** When it ended, in its own time. */
  ms: number | null;
  solution: string;
  /** The first error of the rules. */
  why: string;
  /** The number of its replay, if there is one. */
  replay: number | null;
}

/** What a pupil has in a column. */
export interface Cell {
  /** Runs that are not judged yet. */
  waiting: number;
  /** The best of those that are. */
  mark: Mark | null;
}

/** A pupil. */
export interface Row {
  cells: Cell[];
  sum: number;
  /** Nothing: there is no mark to pass. */
  passed: boolean | null;
}

/** How far the judging is. */
export interface Progress {
  done: number;
  all: number;
  /** Nothing more comes. */
  over: boolean;
}

/** What the page is told. */
export type News =
  | {
      is: 'hello';
      name: string;
      version: string;
      pupils: string[];
      columns: Column[];
      passMark: number | null;
      leftOut: string[];
      leftOutCount: number;
    }
  | ({ is: 'row'; id: number } & Row)
  | ({ is: 'progress' } & Progress)
  | { is: 'beat' };

/** Nothing is known of a pupil. */
export const BLANK: Row = { cells: [], sum: 0, passed: null };
