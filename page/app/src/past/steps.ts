// Where programs were in the course of a recording: which one ran, and the blocks and variables of a diagram.
//
// Owns the reading of lines of `/programs` and `/diagram`; docs/protocol.md has what the latter say. Believes nothing.

import { VALUE_LETTERS_MAX } from '../limits';
import { isObject } from '../robot/plain';
import type { Line } from '../robot/recording';
import type { DebuggerState, Place, Thread, Variable } from '../robot/told';

/** How many lines are not later than a time. */
export function countUntil(lines: readonly Line[], time: number): number {
  let [low, high] = [0, lines.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((lines[middle]?.time ?? 0) <= time) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** The program that ran at a time, and since when. */
export function runningAt(lines: readonly Line[], time: number): { name: string; since: number } | undefined {
  for (let at = countUntil(lines, time) - 1; at >= 0; at--) {
    const line = lines[at];
    if (line?.topic !== '/programs' || line.name === '') continue;
    const isStart = line.text.startsWith(`${line.name} has started`);
    return isStart ? { name: line.name, since: line.time } : undefined;
  }
  return undefined;
}

/** The diagram in the course of time: each line says what has changed, so going forward costs little. */
export class Steps {
  #next = 0;
  #since = NaN;
  readonly #variables = new Map<string, unknown>();
  #last: Record<string, unknown> | undefined;

  /** Lines of `/diagram` alone. */
  constructor(private readonly lines: readonly Line[]) {}

  /** Where the diagram was that runs since a time; undefined if nothing is known of it. */
  at(time: number, since: number): DebuggerState | undefined {
    const end = countUntil(this.lines, time);
    if (this.#since !== since || end < this.#next) {
      this.#since = since;
      this.#next = countUntil(this.lines, since);
      this.#variables.clear();
      this.#last = undefined;
    }
    for (; this.#next < end; this.#next++) this.#take(this.lines[this.#next]?.text ?? '');
    return this.#last && this.#told(this.#last);
  }

  #take(text: string): void {
    let value: unknown;
    try {
      value = JSON.parse(text);
    } catch {
      return;
    }
    if (!isObject(value)) return;
    this.#last = value;
    if (isObject(value.variables))
      for (const [name, one] of Object.entries(value.variables)) this.#variables.set(name, one);
  }

  #told(last: Record<string, unknown>): DebuggerState {
    const threads = Array.isArray(last.threads) ? last.threads.filter(isObject) : [];
    const variables = [...this.#variables].map(([name, value]): Variable => ({
      name,
      type: typeof value === 'number' && !Number.isInteger(value) ? 'float' : '',
      value: (typeof value === 'string' ? value : JSON.stringify(value)).slice(0, VALUE_LETTERS_MAX),
    }));
    return {
      state: 'past',
      threads: threads.map((thread, number): Thread => ({
        number,
        name: String(thread.name ?? ''),
        at: placeOf(thread),
      })),
      variables,
      ...(typeof last.ms === 'number' ? { ms: last.ms } : {}),
    };
  }
}

function placeOf(thread: Record<string, unknown>): Place {
  const { diagram, id, block } = thread;
  return { diagram: String(diagram ?? ''), id: String(id ?? ''), block: String(block ?? '') };
}
