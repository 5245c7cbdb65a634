// Reads a recording that is a whole file, in slices, so that the page does not stand still meanwhile.
//
// Owns what becomes of a recording that is damaged or cut off: what stands before that place counts.

import { FILE_BYTES_MAX, SLICE_MS } from '../limits';
import { Memory } from './memory';
import { Walk } from './records';
import { Wrong } from './wrong';

/** A recording that was read. */
export interface Read {
  memory: Memory;
  /** Why it was not read to its end. */
  wrong: Wrong | undefined;
}

/** Reads all of it at once: for tests, and for what is small. */
export function readNow(bytes: Uint8Array): Read {
  const reading = new Reading(bytes);
  while (reading.step());
  return reading.done();
}

/**
 * Reads it in slices. `told` is told which part is done, and says whether to go on; undefined comes out if not.
 *
 * Throws what is wrong if there is nothing to show.
 */
export async function read(bytes: Uint8Array, told: (part: number) => boolean): Promise<Read | undefined> {
  if (bytes.length > FILE_BYTES_MAX) throw new Wrong('large', FILE_BYTES_MAX);
  const reading = new Reading(bytes);
  for (let isMore = true; isMore;) {
    if (!told(reading.part)) return undefined;
    const end_ms = performance.now() + SLICE_MS;
    while (isMore && performance.now() < end_ms) isMore = reading.step();
    await new Promise((next) => setTimeout(next));
  }
  return reading.done();
}

class Reading {
  readonly #memory = new Memory();
  readonly #walk: Walk;
  #wrong: Wrong | undefined;

  constructor(private readonly bytes: Uint8Array) {
    this.#walk = new Walk(bytes, this.#memory);
  }

  get part(): number {
    return this.#walk.at / Math.max(1, this.bytes.length);
  }

  /** False: there is no more. */
  step(): boolean {
    try {
      return this.#walk.step();
    } catch (error) {
      if (!(error instanceof Wrong)) throw error;
      this.#wrong = error.at === 0 && error.what === 'much' ? new Wrong('much', this.#walk.at) : error;
      return false;
    }
  }

  done(): Read {
    this.#memory.sort();
    if (this.#memory.isEmpty) throw this.#wrong ?? new Wrong('empty', 0);
    return { memory: this.#memory, wrong: this.#wrong };
  }
}
