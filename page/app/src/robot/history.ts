// The last minutes of one number: a ring of times and values.
//
// Owns how much is kept. Times are seconds of the robot's clock.

/** Samples of one number that are kept: two minutes at 30 in a second. */
export const KEPT = 3600;

export class History {
  readonly #times = new Float64Array(KEPT);
  readonly #values = new Float64Array(KEPT);
  #next = 0;
  #count = 0;

  /** How many samples there are. */
  get count(): number {
    return this.#count;
  }

  /** NaN is a gap: the number had no value then. */
  put(time: number, value: number): void {
    this.#times[this.#next] = time;
    this.#values[this.#next] = value;
    this.#next = (this.#next + 1) % KEPT;
    this.#count = Math.min(this.#count + 1, KEPT);
  }

  /** Time of the newest sample; -Infinity without one. */
  get newest(): number {
    return this.#count === 0 ? -Infinity : (this.#times[(this.#next + KEPT - 1) % KEPT] ?? -Infinity);
  }

  /**
   * The samples since a time, the oldest first, and before them the one that was there at that time. A clock that was set back
   * begins anew.
   */
  since(time: number): { times: number[]; values: number[] } {
    const times: number[] = [];
    const values: number[] = [];
    let last = Infinity;
    for (let back = 1; back <= this.#count && last > time; back++) {
      const index = (this.#next + KEPT - back) % KEPT;
      const when = this.#times[index] ?? 0;
      if (when > last) break;
      last = when;
      times.push(when);
      values.push(this.#values[index] ?? NaN);
    }
    return { times: times.reverse(), values: values.reverse() };
  }
}
