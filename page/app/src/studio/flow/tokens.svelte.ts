// The last token of each output while a program of data flow runs, and which blocks have reacted lately.
//
// Owns how long a text stands at a port. What a debugger tells is read in `robot/told`.

import { SvelteMap } from 'svelte/reactivity';
import { Reactions, portsOf, short } from '../../diagram/flow';
import { TOKEN_LETTERS_MAX } from '../../limits';
import { type DebuggerState, stateOf } from '../../robot/told';

/** The last token of each port, by the id of its block and its name. */
export const tokens = new SvelteMap<string, string>();

export const keyOf = (id: string, port: string): string => `${id} ${port}`;

/** What a run tells of itself. */
export class Flow {
  /** Ids of blocks that have reacted lately. */
  lit = $state.raw<ReadonlySet<string>>(new Set());
  #reactions = new Reactions();
  #told: DebuggerState | undefined;

  /** A new run begins. */
  clear(): void {
    tokens.clear();
    this.#told = undefined;
    this.#reactions = new Reactions();
    this.#reactions.hear({ state: 'running', ms: 0 });
    this.lit = new Set();
  }

  /** `told` is what the debugger says of the program, if it was asked; `ms` is the time of the program. */
  hear(told: unknown, ms: number): void {
    this.#told = stateOf(told) ?? this.#told;
    if (!this.#told) return;
    const lit = this.#reactions.hear({ ...this.#told, ms });
    if (lit.size !== this.lit.size || [...lit].some((id) => !this.lit.has(id))) this.lit = lit;
    for (const { id, port, last } of portsOf(this.#told)) {
      if (last === undefined) continue;
      const text = short(last, TOKEN_LETTERS_MAX);
      if (tokens.get(keyOf(id, port)) !== text) tokens.set(keyOf(id, port), text);
    }
  }
}
