// What many cards say together.
//
// Owns the sums. Pure.

import type { Card } from './news';

/** How many robots do what. */
export interface Sum {
  all: number;
  there: number;
  run: number;
}

export function sumOf(cards: readonly Card[]): Sum {
  const there = cards.filter((card) => card.reach === 'there');
  return {
    all: cards.length,
    there: there.length,
    run: there.filter((card) => card.runs !== null).length,
  };
}

/** What became of a stop of many. */
export interface StopSum {
  /** They rest. */
  rest: number;
  /** The last one of these, after the order. */
  slowest_ms: number;
  /** They were told and have not answered. */
  waiting: number;
  /** They are not reached. */
  away: number;
  /** They say that something does not rest. */
  failed: number;
}

/** Nothing: nobody was told to stop since something has begun again. */
export function stopSumOf(cards: readonly Card[]): StopSum | undefined {
  const sum = { rest: 0, slowest_ms: 0, waiting: 0, away: 0, failed: 0 };
  for (const { stop, reach } of cards) {
    if (stop === null) continue;
    if (stop.is === 'rests') {
      sum.rest += 1;
      sum.slowest_ms = Math.max(sum.slowest_ms, stop.ms);
    } else if (stop.is === 'failed') sum.failed += 1;
    else if (stop.is === 'asked' && reach === 'there') sum.waiting += 1;
    else sum.away += 1;
  }
  return sum.rest + sum.waiting + sum.away + sum.failed > 0 ? sum : undefined;
}

/** How much of a file is on its way, from 0 to 1; nothing: that is not known or over. */
export function partOf(card: Card): number | undefined {
  const { sending } = card;
  if (sending?.is !== 'sending' || sending.bytes === 0) return undefined;
  return Math.min(sending.done / sending.bytes, 1);
}

/** What a card is marked by. */
export type Mark = 'unknown' | 'absent' | 'wrong' | 'runs' | 'idle';

export function markOf(card: Card): Mark {
  if (card.reach !== 'there') return card.reach;
  const isWrong = card.stop?.is === 'failed' || card.sending?.is === 'failed';
  if (isWrong) return 'wrong';
  if (card.runs !== null) return 'runs';
  return / has failed | was killed by | was stopped after /.test(card.last ?? '') ? 'wrong' : 'idle';
}
