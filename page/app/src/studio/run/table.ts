// What many runs came to, as a table for other programs.
//
// Owns its columns.

import { cell } from '../../instruments/csv';
import type { Judged } from '../engine/facts';

/** A run that is done. */
export interface DoneRun extends Pick<Judged, 'verdict' | 'ms' | 'totalScore'> {
  /** The place of its field among those that were chosen; -1: the world of the project. */
  number: number;
  /** The name of its field; empty: the world of the project. */
  field: string;
  seed: number;
  /** Why it was not run; empty: it was. */
  why: string;
}

/** A line for each run; a score that is not there is an empty cell. */
export function csv(made: readonly DoneRun[]): string {
  const lines = made.map(({ field, seed, verdict, ms, totalScore, why }) =>
    [cell(field), seed, verdict, (ms / 1000).toFixed(2), totalScore ?? '', cell(why)].join(','),
  );
  return ['field,seed,verdict,time_s,score,why', ...lines].join('\n') + '\n';
}
