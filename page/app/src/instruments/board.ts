// The dashboard of a person: which nodes and graphs are pinned, by the name of the robot.
//
// Owns its text in the store of the browser. What is no dashboard is none: it is ignored, in whole or in part.

import { GRAPH_NUMBERS_MAX, PINNED_MAX, STORED_NAME_LENGTH_MAX } from '../limits';

/** One number of a node. */
export interface Source {
  path: string;
  field: string;
}

export type Pinned = { is: 'node'; path: string } | { is: 'graph'; numbers: Source[]; window_s: number };

/** What a graph can show. */
export const WINDOWS_S = [10, 30, 120] as const;
const VERSION = 1;

/** The parts of the store that are needed. */
export type Store = Pick<Storage, 'getItem' | 'setItem'>;

function isName(value: unknown): value is string {
  return typeof value === 'string' && value.length > 0 && value.length <= STORED_NAME_LENGTH_MAX;
}

function isRecord(value: unknown): value is Record<string, unknown> {
  return typeof value === 'object' && value !== null && !Array.isArray(value);
}

function source(value: unknown): Source[] {
  return isRecord(value) && isName(value.path) && isName(value.field)
    ? [{ path: value.path, field: value.field }]
    : [];
}

function pinned(value: unknown): Pinned[] {
  if (!isRecord(value)) return [];
  if (value.is === 'node') return isName(value.path) ? [{ is: 'node', path: value.path }] : [];
  if (value.is !== 'graph' || !Array.isArray(value.numbers)) return [];
  const sources = value.numbers.slice(0, GRAPH_NUMBERS_MAX).flatMap(source);
  const isFirst = (one: Source, at: number) =>
    sources.findIndex(({ path, field }) => path === one.path && field === one.field) === at;
  const numbers = sources.filter(isFirst);
  const window_s = WINDOWS_S.find((one) => one === value.window_s);
  return numbers.length > 0 && window_s !== undefined ? [{ is: 'graph', numbers, window_s }] : [];
}

/** What an entry shows, as a text: two of the same are one, whatever their windows. */
export function keyOf(one: Pinned): string {
  return one.is === 'node'
    ? `node ${one.path}`
    : JSON.stringify(one.numbers.map(({ path, field }) => [path, field]));
}

export function same(one: Pinned, other: Pinned): boolean {
  return keyOf(one) === keyOf(other);
}

/** A dashboard of a text; what is wrong in it is left out. */
export function read(text: string | null): Pinned[] {
  let value: unknown;
  try {
    value = JSON.parse(text ?? '');
  } catch {
    return [];
  }
  if (!isRecord(value) || value.version !== VERSION || !Array.isArray(value.pinned)) return [];
  const all: Pinned[] = [];
  for (const one of value.pinned.slice(0, PINNED_MAX).flatMap(pinned)) {
    if (!all.some((other) => same(one, other))) all.push(one);
  }
  return all;
}

export function text(all: readonly Pinned[]): string {
  return JSON.stringify({ version: VERSION, pinned: all });
}

/** The list with one entry a place further to the front (-1) or to the end (1); the same if there is no such place. */
export function moved(all: readonly Pinned[], from: number, by: number): Pinned[] {
  const out = [...all];
  const to = from + by;
  if (from < 0 || from >= out.length || to < 0 || to >= out.length) return out;
  out.splice(to, 0, ...out.splice(from, 1));
  return out;
}

/** The store of the browser; undefined if it has none for this page. */
export function store(): Store | undefined {
  try {
    return localStorage;
  } catch {
    return undefined;
  }
}

/** What is kept under a name; nothing if the browser keeps nothing. */
export function kept(store: Store | undefined, key: string): string | null {
  try {
    return store?.getItem(key) ?? null;
  } catch {
    return null;
  }
}

/** Keeps a text; a browser that keeps nothing shows the page all the same. */
export function keep(store: Store | undefined, key: string, value: string): void {
  try {
    store?.setItem(key, value);
  } catch {
    // Full, or forbidden.
  }
}
