// The values of this module. Places are those of JavaScript's strings, from 0.

/** What a request came to. Nothing is thrown but mistakes of the package itself. */
export type Answer<T> = { ok: true; value: T } | { ok: false; error: Failure };

/**
 * Why a request is not answered: `request` is a mistake of the code that asks, `model` a name of a model, `mistakes` a model with
 * mistakes, `refused` something that cannot be done, `solution` a solution that ends before its time.
 */
export interface Failure {
  kind: 'request' | 'model' | 'mistakes' | 'refused' | 'solution';
  message: string;
}

/** From the first letter to the one after the last. */
export type Range = [from: number, to: number];

/** Something that is wrong, as `trik dcml lint --json` tells it. */
export interface Diagnostic {
  code: string;
  severity: 'error' | 'warning';
  at: Range;
  /** From 1. */
  line: number;
  column: number;
  message: string;
  /** For the place itself. */
  label: string;
  hint: string | null;
  notes: { at: Range; text: string }[];
}

export type NameKind = 'action' | 'parameter' | 'constant' | 'configuration' | 'variable';

export interface ModelFacts {
  name: string;
  package: string | null;
  names: { name: string; kind: NameKind; unit: string | null }[];
}

export interface Shipped {
  name: string;
  text: string;
}

export type Language = 'rust' | 'c' | 'java' | 'java-hipparchus' | 'python' | 'lua' | 'javascript' | 'latex';

/** What is replaced with what. */
export interface Edit {
  at: Range;
  text: string;
}

export interface Hover {
  at: Range;
  /** How the word is declared or called, in the language. */
  code: string;
  what: string;
  said: string;
  /** Its equations. */
  more: string;
}

export interface Offers {
  /** The likeliest first. */
  offers: {
    label: string;
    is: NameKind | 'number' | 'function' | 'keyword' | 'unit' | 'snippet';
    detail: string;
    said: string;
    insert: string;
    /** The same with places to fill in: `${1:x}` and `$0`. */
    snippet: string | null;
    /** What it replaces. */
    at: Range;
  }[];
  isAll: boolean;
}

export interface Reference {
  at: Range;
  declares: boolean;
}

export interface Signature {
  code: string;
  said: string;
  /** Places in `code`. */
  arguments: Range[];
  active: number;
}

export interface Outlined {
  name: string;
  detail: string;
  is: NameKind | 'model' | 'equation';
  at: Range;
  name_at: Range;
  inside: Outlined[];
}

export interface Fix {
  title: string;
  /** Which diagnostic it mends. */
  of: number;
  edits: Edit[];
  isPreferred: boolean;
}

export interface Word {
  at: Range;
  is:
    | 'keyword'
    | 'model'
    | 'package'
    | 'parameter'
    | 'configuration'
    | 'variable'
    | 'function'
    | 'unit'
    | 'number'
    | 'comment';
  declares: boolean;
}

/** How a model is solved, as `trik dcml sim`. */
export interface SolveOptions {
  /** The name of the model, if the text has several. */
  model?: string;
  /** All parameters. */
  params?: Record<string, number>;
  /** The state at the beginning; 0 where nothing is said. */
  start?: Record<string, number>;
  /** Actions from these times in s on, rising; 0 before and where nothing is said. */
  actions?: ({ at: number } & Record<string, number>)[];
  seconds: number;
  /** Between two rows, in s: a 200th of all without it. */
  every?: number;
  method?: 'euler' | 'heun' | 'rk4' | 'rk45';
  /** In s; the largest one with rk45. */
  step?: number;
}

export interface Solution {
  /** Time, states, outputs, actions. */
  columns: { name: string; unit: string | null }[];
  rows: number[][];
}
