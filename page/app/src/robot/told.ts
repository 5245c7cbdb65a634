// Where a program is, as the robot's debugger tells it.
//
// Owns the shape of it, and what of it is believed: lists and texts that are too long are cut, what is of another type is left
// out, and no name stands twice. docs/protocol.md has what each member means.

import { TOLD_ITEMS_MAX, TOLD_NAME_LETTERS_MAX, VALUE_LETTERS_MAX } from '../limits';
import { isObject } from './plain';

/** A block of a diagram. */
export interface Place {
  diagram: string;
  id: string;
  block: string;
}

export interface Thread {
  number: number;
  name: string;
  at?: Place;
  /** Unknown of the past. */
  does?: 'enters' | 'gives way' | 'waits' | 'held' | 'failed';
  for?: string;
  left_ms?: number;
  port?: string;
  calls?: Place[];
}

export interface Variable {
  name: string;
  type: string;
  value: string;
}

/** A port of a block of data flow. */
export interface PortPlace extends Place {
  caption: string;
  port: string;
}

/** The last token that a port has given, and how many there were. */
export interface LastToken extends PortPlace {
  type: string;
  value: string;
  count: number;
}

/** Tokens that wait at a port, and how many were lost there. */
export interface Waiting extends PortPlace {
  count: number;
  lost: number;
}

/** How often a block has reacted. */
export interface Reacted extends Place {
  count: number;
}

export interface Stop {
  reason: string;
  text?: string;
  at?: Place;
  /** Of data flow: what is about to arrive at the block, and at which port. */
  next?: { caption: string; port: string; type: string; value: string };
}

/** Where the program is. */
export interface DebuggerState {
  state: 'running' | 'stopped' | 'past' | 'searching' | 'ended' | 'gone';
  ms?: number;
  attached?: boolean;
  stop?: Stop;
  threads?: Thread[];
  variables?: Variable[];
  /** Only of data flow, as the next ones. */
  ports?: LastToken[];
  reacted?: Reacted[];
  waiting?: Waiting[];
  /** Of how many items in all lists nothing is said. */
  leftOut?: number;
}

const STATES = ['running', 'stopped', 'past', 'searching', 'ended', 'gone'] as const;
const DOES = ['enters', 'gives way', 'waits', 'held', 'failed'] as const;
const LISTS = ['threads', 'calls', 'variables', 'ports', 'reacted', 'waiting'];

/** What the robot says of a program; undefined if that is nothing. */
export function stateOf(value: unknown): DebuggerState | undefined {
  if (!isObject(value)) return undefined;
  const state = STATES.find((one) => one === value.state);
  if (!state) return undefined;
  const cut = LISTS.map((name) => Math.max(sizeOf(value[name]) - TOLD_ITEMS_MAX, 0));
  const untold = LISTS.map((name) => count(value[`${name}_left_out`]));
  const leftOut = [...cut, ...untold].reduce((all, one) => all + one, 0);
  const stop = isObject(value.stop) ? stopOf(value.stop) : undefined;
  return {
    state,
    ...(typeof value.ms === 'number' ? { ms: value.ms } : {}),
    ...(typeof value.attached === 'boolean' ? { attached: value.attached } : {}),
    ...(stop ? { stop } : {}),
    threads: unique(list(value.threads).map(threadOf), ({ number }) => number),
    variables: unique(list(value.variables).map(variableOf), ({ name }) => name),
    ...(Array.isArray(value.ports) ? { ports: list(value.ports).map(lastTokenOf) } : {}),
    ...(Array.isArray(value.reacted) ? { reacted: list(value.reacted).map(reactedOf) } : {}),
    ...(Array.isArray(value.waiting) ? { waiting: list(value.waiting).map(waitingOf) } : {}),
    ...(leftOut > 0 ? { leftOut } : {}),
  };
}

type JsonObject = Record<string, unknown>;

function sizeOf(value: unknown): number {
  return Array.isArray(value) ? value.length : 0;
}

function list(value: unknown): JsonObject[] {
  return Array.isArray(value) ? value.slice(0, TOLD_ITEMS_MAX).filter(isObject) : [];
}

function unique<T>(items: T[], key: (item: T) => string | number): T[] {
  const seen = new Set<string | number>();
  return items.filter((item) => !seen.has(key(item)) && seen.add(key(item)));
}

function text(value: unknown, letters = TOLD_NAME_LETTERS_MAX): string {
  return typeof value === 'string' ? value.slice(0, letters) : '';
}

function count(value: unknown): number {
  return typeof value === 'number' && value > 0 && Number.isFinite(value) ? value : 0;
}

function placeOf(value: JsonObject): Place {
  return { diagram: text(value.diagram), id: text(value.id), block: text(value.block) };
}

function portOf(value: JsonObject): PortPlace {
  return { ...placeOf(value), caption: text(value.caption), port: text(value.port) };
}

function variableOf(value: JsonObject): Variable {
  return { name: text(value.name), type: text(value.type), value: text(value.value, VALUE_LETTERS_MAX) };
}

function lastTokenOf(value: JsonObject): LastToken {
  const token = { type: text(value.type), value: text(value.value, VALUE_LETTERS_MAX) };
  return { ...portOf(value), ...token, count: count(value.count) };
}

function waitingOf(value: JsonObject): Waiting {
  return { ...portOf(value), count: count(value.count), lost: count(value.lost) };
}

function reactedOf(value: JsonObject): Reacted {
  return { ...placeOf(value), count: count(value.count) };
}

function threadOf(value: JsonObject): Thread {
  const does = DOES.find((one) => one === value.does);
  return {
    number: typeof value.number === 'number' ? value.number : 0,
    name: text(value.name),
    ...(isObject(value.at) ? { at: placeOf(value.at) } : {}),
    ...(does ? { does } : {}),
    ...(typeof value.for === 'string' ? { for: text(value.for) } : {}),
    ...(typeof value.left_ms === 'number' ? { left_ms: value.left_ms } : {}),
    ...(typeof value.port === 'string' ? { port: text(value.port) } : {}),
    calls: list(value.calls).map(placeOf),
  };
}

function stopOf(value: JsonObject): Stop {
  const at = isObject(value.at) ? value.at : undefined;
  const given = at && 'value' in at ? lastTokenOf(at) : undefined;
  return {
    reason: text(value.reason),
    ...(typeof value.text === 'string' ? { text: text(value.text, VALUE_LETTERS_MAX) } : {}),
    ...(at ? { at: placeOf(at) } : {}),
    ...(given
      ? { next: { caption: given.caption, port: given.port, type: given.type, value: given.value } }
      : {}),
  };
}
