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

  /** All samples since a time, the oldest first. */
  since(time: number): { times: number[]; values: number[] } {
    const times: number[] = [];
    const values: number[] = [];
    for (let at = 0; at < this.#count; at++) {
      const index = (this.#next + KEPT - this.#count + at) % KEPT;
      const when = this.#times[index] ?? 0;
      if (when >= time) {
        times.push(when);
        values.push(this.#values[index] ?? NaN);
      }
    }
    return { times, values };
  }
}
