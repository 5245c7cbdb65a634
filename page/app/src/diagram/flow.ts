// What a running program of data flow tells, made ready to be shown: its ports one by one, and the blocks that react.
//
// Owns how long a reaction is seen. Knows no elements.

import type { DebuggerState } from '../robot/told';
import { shown } from './value';

/** What is known of one port. */
export interface PortFacts {
  /** No other one has it. */
  key: string;
  /** Of its block. */
  id: string;
  caption: string;
  port: string;
  /** The last token that it gave, for people; undefined: none was given lately. */
  last: string | undefined;
  /** Tokens given since somebody looks. */
  count: number;
  waiting: number;
  lost: number;
}

/** In milliseconds of the program, which stand still while it is stopped. */
export const SEEN_MS = 500;

/** Its ports, in the order of its blocks; those of a subprogram that is called twice count together. */
export function portsOf(told: DebuggerState | undefined): PortFacts[] {
  const all = new Map<string, PortFacts>();
  const at = ({ id, caption, port }: { id: string; caption: string; port: string }): PortFacts => {
    const key = `${id} ${port}`;
    let facts = all.get(key);
    if (!facts)
      all.set(key, (facts = { key, id, caption, port, last: undefined, count: 0, waiting: 0, lost: 0 }));
    return facts;
  };
  for (const given of told?.ports ?? []) {
    const facts = at(given);
    facts.last = shown(given.type, given.value);
    facts.count += given.count;
  }
  for (const one of told?.waiting ?? []) {
    const facts = at(one);
    facts.waiting += one.count;
    facts.lost += one.lost;
  }
  return [...all.values()];
}

/**
 * Which blocks have reacted lately, or given a token by themselves, as sensors and timers do. What was heard twice is heard once.
 */
export class Reactions {
  /** How often each block had reacted and given, and when that was heard to be more. */
  readonly #blocks = new Map<string, { count: number; at_ms: number }>();
  #isFirst = true;

  /** Their ids, after what the program tells now. */
  hear(told: DebuggerState | undefined): ReadonlySet<string> {
    if (!told) {
      this.#blocks.clear();
      this.#isFirst = true;
      return new Set();
    }
    // Nothing is said of the past: what was heard before it still stands when the present comes back.
    if (told.state === 'past' || told.state === 'searching') return new Set();
    const now = told.ms ?? 0;
    const counts = new Map<string, number>();
    for (const { id, count } of [...(told.reacted ?? []), ...(told.ports ?? [])])
      counts.set(id, (counts.get(id) ?? 0) + count);
    for (const [id, count] of counts) {
      const before = this.#blocks.get(id);
      if (before?.count === count) continue;
      // What is told first may be seconds old, and less than before is a new beginning.
      this.#blocks.set(id, { count, at_ms: this.#isFirst ? -Infinity : now });
    }
    this.#isFirst = false;
    const lit = new Set<string>();
    for (const [id, { at_ms }] of this.#blocks) {
      if (!counts.has(id)) this.#blocks.delete(id);
      // A program that began anew has an earlier time.
      else if (Math.abs(now - at_ms) <= SEEN_MS) lit.add(id);
    }
    return lit;
  }
}

/** A text that fits into a picture. */
export function short(text: string, most: number): string {
  const line = text.replace(/\s+/g, ' ').trim();
  return line.length > most ? `${line.slice(0, most)}...` : line;
}
