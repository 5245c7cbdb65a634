// The last minutes of one number: a ring of times and values.
//
// Owns how much is kept. Times are seconds of the robot's clock.

/** How long samples are kept, in seconds: what a graph shows at most, and a little more. */
export const KEPT_S = 125;
/** Samples of one number that are kept: so long at 60 in a second. */
export const KEPT = 7500;
/** Room to begin with: most numbers of a robot come seldom, and a lidar has hundreds. */
const FIRST = 64;

/** What is known of one number until now, or until the moment that is shown. */
export interface Timeline {
  /** The samples since a time, the oldest first, and before them the one that was there at that time. */
  since(time: number): { times: number[]; values: number[] };
}

export class History implements Timeline {
  #times = new Float64Array(FIRST);
  #values = new Float64Array(FIRST);
  #next = 0;
  #count = 0;

  /** How many samples there are. */
  get count(): number {
    return this.#count;
  }

  /** NaN is a gap: the number had no value then. */
  put(time: number, value: number): void {
    const isFull = this.#count === this.#times.length;
    // Slow numbers need little room: what is older goes.
    const oldest = this.#times[this.#next] ?? 0;
    if (isFull && this.#count < KEPT && time - oldest < KEPT_S) this.#grow();
    const size = this.#times.length;
    this.#times[this.#next] = time;
    this.#values[this.#next] = value;
    this.#next = (this.#next + 1) % size;
    this.#count = Math.min(this.#count + 1, size);
  }

  #grow(): void {
    const size = Math.min(this.#times.length * 2, KEPT);
    const [times, values] = [this.#times, this.#values];
    this.#times = new Float64Array(size);
    this.#values = new Float64Array(size);
    // The oldest first.
    for (const [from, to] of [
      [times, this.#times],
      [values, this.#values],
    ] as const) {
      to.set(from.subarray(this.#next));
      to.set(from.subarray(0, this.#next), from.length - this.#next);
    }
    this.#next = this.#count;
  }

  /** Time of the newest sample; -Infinity without one. */
  get newest(): number {
    const size = this.#times.length;
    return this.#count === 0 ? -Infinity : (this.#times[(this.#next + size - 1) % size] ?? -Infinity);
  }

  /**
   * The samples since a time, the oldest first, and before them the one that was there at that time. A clock that was set back
   * begins anew.
   */
  since(time: number): { times: number[]; values: number[] } {
    const times: number[] = [];
    const values: number[] = [];
    const size = this.#times.length;
    let last = Infinity;
    for (let back = 1; back <= this.#count && last > time; back++) {
      const index = (this.#next + size - back) % size;
      const when = this.#times[index] ?? 0;
      if (when > last) break;
      last = when;
      times.push(when);
      values.push(this.#values[index] ?? NaN);
    }
    return { times: times.reverse(), values: values.reverse() };
  }
}
