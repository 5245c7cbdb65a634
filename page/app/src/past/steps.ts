// Where programs were in the course of a recording: which one ran, the blocks and variables of a diagram, and what happened at
// the blocks of a program of data flow.
//
// Owns the reading of lines of `/programs` and `/diagram`; docs/protocol.md has what the latter say. Believes nothing.

import { SEEN_MS } from '../diagram/flow';
import { TOLD_NAME_LETTERS_MAX, VALUE_LETTERS_MAX } from '../limits';
import { isObject } from '../robot/plain';
import type { Line } from '../robot/recording';
import type { DebuggerState, LastToken, Place, Thread, Variable } from '../robot/told';

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

/** A block of data flow, as far as it was told. */
interface FlowBlock extends Place {
  caption: string;
  reacted: number;
  ports: Map<string, { type: string; value: string; count: number }>;
  /** When something happened there last; never, as far as it is known. */
  time: number;
}

/** The diagram in the course of time: each line says what has changed, so going forward costs little. */
export class Steps {
  #next = 0;
  #since = NaN;
  readonly #variables = new Map<string, unknown>();
  /** Of each call, by their ids. */
  readonly #blocks = new Map<string, FlowBlock>();
  #last: Record<string, unknown> | undefined;
  /** Whether counts are known from their beginning. */
  #isWhole = false;

  /** Lines of `/diagram` alone. */
  constructor(private readonly lines: readonly Line[]) {}

  /** Where the diagram was that runs since a time; undefined if nothing is known of it. */
  at(time: number, since: number): DebuggerState | undefined {
    const end = countUntil(this.lines, time);
    if (this.#since !== since || end < this.#next) {
      this.#since = since;
      this.#next = countUntil(this.lines, since);
      this.#variables.clear();
      this.#blocks.clear();
      this.#isWhole = false;
      this.#last = undefined;
    }
    for (; this.#next < end; this.#next++) this.#take(this.lines[this.#next]);
    return this.#last && this.#told(this.#last);
  }

  /** Blocks of data flow at which something has happened lately, at the time that was asked for last or a later one. */
  litAt(time: number): ReadonlySet<string> {
    const lit = new Set<string>();
    for (const block of this.#blocks.values()) {
      const since_ms = (time - block.time) * 1000;
      if (since_ms >= 0 && since_ms <= SEEN_MS) lit.add(block.id);
    }
    return lit;
  }

  #take(line: Line | undefined): void {
    let value: unknown;
    try {
      value = JSON.parse(line?.text ?? '');
    } catch {
      return;
    }
    if (!isObject(value)) return;
    this.#last = value;
    if (isObject(value.variables))
      for (const [name, one] of Object.entries(value.variables)) this.#variables.set(name, one);
    if (value.anew === true) {
      this.#blocks.clear();
      this.#isWhole = true;
    }
    for (const one of objects(value.blocks)) this.#takeBlock(one, line?.time ?? 0);
  }

  #takeBlock(told: Record<string, unknown>, time: number): void {
    const key = `${text(told.id)} ${count(told.instance)}`;
    let block = this.#blocks.get(key);
    // Of a recording that begins later nobody knows when what it is told of first has happened.
    let isKnown = true;
    if (!block) {
      const named = { diagram: '', block: '', caption: '' };
      const unknown = { reacted: 0, ports: new Map(), time: -Infinity };
      this.#blocks.set(key, (block = { ...named, id: text(told.id), ...unknown }));
      isKnown = this.#isWhole;
    }
    let hasMore = count(told.reacted) > block.reacted;
    // Names come only now and then.
    if ('caption' in told) Object.assign(block, placeOf(told), { caption: text(told.caption) });
    block.reacted = Math.max(block.reacted, count(told.reacted));
    for (const one of objects(told.ports)) {
      const token = { type: text(one.type), value: text(one.value), count: count(one.count) };
      hasMore ||= token.count > (block.ports.get(text(one.port))?.count ?? 0);
      block.ports.set(text(one.port), token);
    }
    // All is told once more for somebody else who has missed it.
    if (hasMore && isKnown) block.time = time;
  }

  /** What is known of blocks of data flow. */
  #flow(): Partial<DebuggerState> {
    if (this.#blocks.size === 0) return {};
    const blocks = [...this.#blocks.values()];
    const ports = blocks.flatMap(({ ports, diagram, id, block, caption }) =>
      [...ports].map(([port, token]): LastToken => ({ diagram, id, block, caption, port, ...token })),
    );
    return {
      ports,
      reacted: blocks.map(({ diagram, id, block, reacted }) => ({ diagram, id, block, count: reacted })),
    };
  }

  #told(last: Record<string, unknown>): DebuggerState {
    const threads = objects(last.threads);
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
      // What a line has no room for comes in one of the next, so nothing is missing for long.
      ...this.#flow(),
      ...(typeof last.ms === 'number' ? { ms: last.ms } : {}),
    };
  }
}

function objects(value: unknown): Record<string, unknown>[] {
  return Array.isArray(value) ? value.filter(isObject) : [];
}

function text(value: unknown): string {
  return typeof value === 'string' ? value.slice(0, TOLD_NAME_LETTERS_MAX) : '';
}

function count(value: unknown): number {
  return typeof value === 'number' && value > 0 && Number.isFinite(value) ? value : 0;
}

function placeOf(thread: Record<string, unknown>): Place {
  const { diagram, id, block } = thread;
  return { diagram: String(diagram ?? ''), id: String(id ?? ''), block: String(block ?? '') };
}
