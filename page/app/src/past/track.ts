// What one node gave in the course of a recording: samples and failures in their order.
//
// Owns how they are kept: a column for each number, and texts beside them. Knows no files and no moment that is shown.

import { TEXT_COST } from '../limits';
import type { Fields, Node } from '../robot/recording';
import type { Samples } from '../instruments/series';
import { Column } from './column';
import { Message, type Part } from './cdr';

/** What there is room for still, of a recording as a whole. */
export interface Room {
  numbers: number;
  textBytes: number;
}

export class Track {
  readonly times = new Column();
  readonly numbers = new Map<string, Column>();
  /** Texts and bytes by their field and their place. */
  readonly others = new Map<string, Map<number, string | Uint8Array>>();
  /** Why there is no value, by place. */
  readonly faults = new Map<number, string>();

  constructor(
    readonly node: Node,
    private readonly parts: readonly Part[],
    private readonly room: Room,
  ) {
    for (const { name, kind } of parts) {
      if (kind === 'text' || kind === 'bytes') this.others.set(name, new Map());
      else this.numbers.set(name, new Column());
    }
  }

  /** A sample. False: it is none of this node. */
  sample(time: number, data: Uint8Array): boolean {
    const message = new Message(data);
    if (!message.skipBefore()) return false;
    const values = this.parts.map(({ kind, size }) =>
      kind === 'text' ? message.text() : kind === 'bytes' ? message.take(size) : message.number(kind),
    );
    if (values.includes(undefined)) return false;
    const place = this.#begin(time);
    for (const [at, { name }] of this.parts.entries()) {
      const value = values[at] ?? NaN;
      if (typeof value === 'number') this.#put(this.numbers.get(name), value);
      else this.#keep(name, place, value);
    }
    return true;
  }

  /** A failure. */
  fault(time: number, why: string): void {
    const place = this.#begin(time);
    this.faults.set(place, why);
    this.room.textBytes -= why.length * 2 + TEXT_COST;
    for (const column of this.numbers.values()) this.#put(column, NaN);
  }

  /** Times go on, also where the robot's clock was set back. */
  #begin(time: number): number {
    const place = this.times.length;
    this.#put(this.times, place === 0 ? time : Math.max(time, this.times.at(place - 1)));
    return place;
  }

  #put(column: Column | undefined, value: number): void {
    if (column) this.room.numbers -= column.push(value);
  }

  #keep(name: string, place: number, value: string | Uint8Array): void {
    const kept = this.others.get(name);
    const last = kept?.get(place - 1);
    // A text that stays the same is one text; bytes are copied, because those of the chunk go.
    const isSame = typeof value === 'string' && value === last;
    kept?.set(place, isSame ? last : typeof value === 'string' ? value : value.slice());
    this.room.textBytes -= (isSame ? 0 : value.length * (typeof value === 'string' ? 2 : 1)) + TEXT_COST;
  }

  /** The place of what was there at a time; -1: nothing yet. */
  placeAt(time: number): number {
    return this.times.until(time) - 1;
  }

  /** The newest sample at a place or before it; undefined without one. */
  fieldsAt(place: number): Fields | undefined {
    let at = place;
    while (at >= 0 && this.faults.has(at)) at--;
    if (at < 0) return undefined;
    const fields: Fields = {};
    for (const { name } of this.parts) {
      const value = this.numbers.get(name)?.at(at) ?? this.others.get(name)?.get(at);
      if (value !== undefined) fields[name] = value;
    }
    return fields;
  }

  /** The samples of a number from the one that held at a time until another time. */
  samples(field: string, since: number, to: number): Samples {
    const column = this.numbers.get(field);
    if (!column) return { times: [], values: [] };
    const from = Math.max(0, this.times.until(since) - 1);
    const end = this.times.until(to);
    return { times: this.times.slice(from, end), values: column.slice(from, end) };
  }
}
