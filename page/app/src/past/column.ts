// A row of numbers that grows.
//
// Owns its room; how much there may be in all is known to those who keep it.

const FIRST = 16;

export class Column {
  #values = new Float64Array(FIRST);
  length = 0;

  /** Returns by how much its room has grown. */
  push(value: number): number {
    const room = this.#values.length;
    if (this.length === room) {
      const values = new Float64Array(room + (room >> 1));
      values.set(this.#values);
      this.#values = values;
    }
    this.#values[this.length++] = value;
    return this.#values.length - room;
  }

  at(index: number): number {
    return index < this.length ? (this.#values[index] ?? NaN) : NaN;
  }

  /** From one place until before another. */
  slice(from: number, to: number): number[] {
    return Array.from(this.#values.subarray(Math.max(0, from), Math.min(to, this.length)));
  }

  /** How many are not greater than a value, if they are in order. */
  until(value: number): number {
    let [low, high] = [0, this.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if ((this.#values[middle] ?? 0) <= value) low = middle + 1;
      else high = middle;
    }
    return low;
  }
}
