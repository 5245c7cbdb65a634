// What the debugger of a run tells the page.
//
// Owns what of its answers the page shows. The words of orders are those of docs/protocol.md.

import type { DebugAnswer, DebugReport } from '../engine/facts';
import { type DebuggerState, stateOf } from '../../robot/told';
import { isObject } from '../../robot/plain';

/** Where the program is. */
export interface HeldState extends DebuggerState {
  /** The first moment that is kept, in milliseconds. */
  from_ms: number;
  /** After a change that was waited for: the variable, what it was and what it is. */
  change?: { variable: string; was: string; is: string };
}

/** What an order came to. */
export interface Answered {
  /** Empty: it is done. */
  why: string;
  /** Of an expression, or of a variable that was set. */
  value: string;
}

/** Letters of a value that was asked for. */
const VALUE_LETTERS = 4096;

export function heldOf(program: unknown): HeldState | undefined {
  const state = stateOf(program);
  if (!state || !isObject(program)) return undefined;
  const kept = isObject(program['kept']) ? program['kept']['from_ms'] : 0;
  const stop = isObject(program['stop']) ? program['stop'] : {};
  const { variable } = stop;
  const change =
    typeof variable === 'string' ? { variable, was: text(stop['was']), is: text(stop['is']) } : undefined;
  return { ...state, from_ms: typeof kept === 'number' ? kept : 0, ...(change ? { change } : {}) };
}

export function answerOf(answer: DebugAnswer): Answered {
  if (!answer.done) return { why: answer.why, value: '' };
  return { why: '', value: text(answer['value']) };
}

/** Of what a debugger has told by itself the newest state, and all lines. */
export function reported(reports: readonly DebugReport[]): { log: string[]; told: HeldState | undefined } {
  const log: string[] = [];
  let told: HeldState | undefined;
  for (const report of reports) {
    if (Array.isArray(report['log'])) log.push(...report['log'].map(text));
    told = heldOf(report) ?? told;
  }
  return { log, told };
}

function text(value: unknown): string {
  return typeof value === 'string' ? value.slice(0, VALUE_LETTERS) : '';
}
