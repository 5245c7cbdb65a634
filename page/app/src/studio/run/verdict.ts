// How a run has ended, in a sentence.

import type { Judged } from '../engine/facts';
import { words } from '../words';

export function verdictOf({ verdict, failure }: Pick<Judged, 'verdict' | 'failure'>): string {
  return (verdict === 'failed' && failure !== null && words.failures[failure]) || words.verdicts[verdict];
}
