// What many marks say together, and how their numbers are written.
//
// Owns the sums. Pure.

import type { Row } from './news';

/** How many marks are what. */
export interface Tally {
  good: number;
  wrong: number;
  broken: number;
  /** Nobody has handed anything in for it. */
  missing: number;
}

export function tallyOf(rows: readonly Row[]): Tally {
  const tally = { good: 0, wrong: 0, broken: 0, missing: 0 };
  for (const { mark, waiting } of rows.flatMap(({ cells }) => cells)) {
    if (mark) tally[mark.tone] += 1;
    else if (waiting === 0) tally.missing += 1;
  }
  return tally;
}

/** Points and weights, with no more digits than they need. */
export function numberOf(value: number, language: string): string {
  return new Intl.NumberFormat(language, { maximumFractionDigits: 9, useGrouping: false }).format(value + 0);
}

/** When a run ended, in seconds. */
export function secondsOf(ms: number, language: string): string {
  const digits = { minimumFractionDigits: 2, maximumFractionDigits: 2, useGrouping: false };
  // Cut as the command does, so that both say the same.
  return new Intl.NumberFormat(language, digits).format(Math.floor(ms / 10) / 100);
}
