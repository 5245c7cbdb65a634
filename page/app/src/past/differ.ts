// Where two runs of a robot begin to differ.
//
// Owns what a difference is. Two runs never give a value at the same moment, so a value is the same if the other run has it, or
// passes it, at most a tenth of a second earlier or later. Knows no files and no robot.

import { NEAR_VALUES_MAX, SLICE_MS } from '../limits';

/** The values of one field at their times, in order; each holds until the next one. NaN: there was none. */
export interface Row {
  times: readonly number[];
  values: readonly (number | string)[];
}

/** One of two runs. */
export interface Side {
  begin: number;
  end: number;
  paths: readonly string[];
  /** The fields of a node. */
  rows(path: string): ReadonlyMap<string, Row>;
}

export interface Difference {
  path: string;
  field: string;
  /** In the time of the first run. */
  time: number;
  here: number | string;
  there: number | string;
}

export interface Differences {
  /** What was compared, in the time of the first run. */
  from: number;
  to: number;
  /** How many nodes are the same. */
  same: number;
  /** The first of each node, the earliest first. */
  different: Difference[];
  onlyHere: string[];
  onlyThere: string[];
}

const NEAR_S = 0.1;

/** The place of the value that holds at a time; -1: none yet. */
function placeAt(row: Row, time: number): number {
  let [low, high] = [0, row.times.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((row.times[middle] ?? 0) <= time) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}

/** Whether values of a row, from one place to another, have a value or pass it. */
function meets(value: number | string, row: Row, from: number, to: number): boolean {
  if (to - from > NEAR_VALUES_MAX) return true;
  let [least, greatest] = [Infinity, -Infinity];
  for (let at = Math.max(0, from); at <= to; at++) {
    const other = row.values[at];
    if (Object.is(other, value)) return true;
    if (typeof other !== 'number' || Number.isNaN(other)) continue;
    least = Math.min(least, other);
    greatest = Math.max(greatest, other);
  }
  return typeof value === 'number' && value >= least && value <= greatest;
}

/** When a row first has a value that another does not have; `later` is how much later the times of that are. */
function firstAlone(row: Row, other: Row, later: number, from: number, to: number): number | undefined {
  let low = -1;
  let high = -1;
  for (let at = Math.max(0, placeAt(row, from)); at < row.times.length; at++) {
    const time = Math.max(row.times[at] ?? 0, from);
    if (time > to) return undefined;
    while (low + 1 < other.times.length && (other.times[low + 1] ?? 0) + later <= time - NEAR_S) low++;
    while (high + 1 < other.times.length && (other.times[high + 1] ?? 0) + later <= time + NEAR_S) high++;
    // Before its first value the other one says nothing.
    if (high < 0) continue;
    if (!meets(row.values[at] ?? NaN, other, low, high)) return time;
  }
  return undefined;
}

/** The first difference of a field, in the time of the first row. */
export function firstDifference(
  here: Row,
  there: Row,
  shift: number,
  from: number,
  to: number,
): { time: number; here: number | string; there: number | string } | undefined {
  // Both must have said something.
  const begin = Math.max(from, here.times[0] ?? Infinity, (there.times[0] ?? Infinity) + shift);
  if (begin > to) return undefined;
  const mine = firstAlone(here, there, shift, begin, to);
  const theirs = firstAlone(there, here, -shift, begin - shift, to - shift);
  if (mine === undefined && theirs === undefined) return undefined;
  const time = Math.min(mine ?? Infinity, (theirs ?? Infinity) + shift);
  return {
    time,
    here: here.values[placeAt(here, time)] ?? NaN,
    there: there.values[placeAt(there, time - shift + EPSILON_S)] ?? NaN,
  };
}

/** Times that were shifted and shifted back are so near. */
const EPSILON_S = 1e-6;

/** Compares all nodes; `isWanted` is asked in between whether to go on. */
export async function compare(
  here: Side,
  there: Side,
  shift: number,
  isWanted: () => boolean,
): Promise<Differences | undefined> {
  const from = Math.max(here.begin, there.begin + shift);
  const to = Math.min(here.end, there.end + shift);
  const others = new Set(there.paths);
  const mine = new Set(here.paths);
  const result: Differences = {
    from,
    to,
    same: 0,
    different: [],
    onlyHere: here.paths.filter((path) => !others.has(path)).sort(),
    onlyThere: there.paths.filter((path) => !mine.has(path)).sort(),
  };
  let end_ms = performance.now() + SLICE_MS;
  for (const path of here.paths) {
    if (!others.has(path)) continue;
    if (performance.now() > end_ms) {
      await new Promise((next) => setTimeout(next));
      if (!isWanted()) return undefined;
      end_ms = performance.now() + SLICE_MS;
    }
    const first = firstOf(path, here.rows(path), there.rows(path), shift, from, to);
    if (first) result.different.push(first);
    else result.same++;
  }
  result.different.sort((one, other) => one.time - other.time || (one.path < other.path ? -1 : 1));
  return result;
}

/** The earliest difference of the fields that both have. */
function firstOf(
  path: string,
  here: ReadonlyMap<string, Row>,
  there: ReadonlyMap<string, Row>,
  shift: number,
  from: number,
  to: number,
): Difference | undefined {
  let first: Difference | undefined;
  for (const [field, row] of here) {
    const other = there.get(field);
    const found = other && firstDifference(row, other, shift, from, first ? first.time : to);
    if (found && (!first || found.time < first.time)) first = { path, field, ...found };
  }
  return first;
}
