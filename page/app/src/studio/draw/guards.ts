// What stands at the links of blocks that decide.
//
// Owns the words of guards, which are those of TRIK Studio.

import type { DrawnLink } from '../engine/facts';

/** Guards of each kind of block that decides, in the order in which a person draws its links. */
const GUARDS: Record<string, string[]> = {
  IfBlock: ['true', 'false'],
  Loop: ['iteration'],
  PreconditionalLoop: ['iteration'],
};

/** All that can stand at a link of such a block; undefined if it is any text. */
export function guardsOf(kind: string): string[] | undefined {
  return GUARDS[kind];
}

/** What the next link of a block has for a guard, after those that leave it. */
export function guardOfNext(kind: string, leaving: readonly DrawnLink[]): string {
  const guards = GUARDS[kind] ?? [];
  const taken = new Set(leaving.map(({ guard }) => guard.toLowerCase()));
  // Of two branches the one without a word is the other one: it was drawn first.
  if (guards.length === 2 && taken.has('') && !guards.some((guard) => taken.has(guard)))
    return guards[1] ?? '';
  return guards.find((guard) => !taken.has(guard)) ?? '';
}
