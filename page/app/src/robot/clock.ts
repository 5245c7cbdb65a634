// The robot's clock, as the times of what comes from it show it.
//
// Owns by how much it is ahead of this page's, which is an argument. All times are seconds since 1970. Knows no recording.

/** Nothing that is on its way is so late: one of the clocks was set. */
const LATE_S = 10;
/** So long all that comes must be so late: what a node has had for long comes at the beginning, together with what is new. */
const PATIENCE_S = 2;
/** So long after the robot has set its clock back, what it had sampled before may still come. */
const BEFORE_S = 1;

export class Clock {
  #ahead = 0;
  #isKnown = false;
  /** What the clock is ahead of the time since the robot was switched on. */
  #offset: number | undefined;
  /** When the robot has told that its clock was set back. */
  #setBackAt = -Infinity;
  /** Since when all was late, and the least late of it. */
  #late: { since: number; ahead: number } | undefined;

  /** The robot's clock at a time of this page's. */
  at(now: number): number {
    return now + this.#ahead;
  }

  /** Another connection: the robot may have been switched off meanwhile. */
  begin(): void {
    this.#offset = undefined;
  }

  /** The robot says how its clock stands, which it does once more when that was set. */
  told(offset: number, now: number): void {
    if (!Number.isFinite(offset)) return;
    const by = this.#offset === undefined ? 0 : offset - this.#offset;
    this.#offset = offset;
    this.#ahead += by;
    this.#late = undefined;
    if (by < 0) this.#setBackAt = now;
  }

  /** Something of this time has come: the clocks differ by less than it was on its way, or by what was seen at the fastest. */
  hear(time: number, now: number): void {
    if (Math.abs(now - this.#setBackAt) < BEFORE_S) return;
    const ahead = time - now;
    if (!this.#isKnown || ahead > this.#ahead - LATE_S) {
      this.#ahead = this.#isKnown ? Math.max(this.#ahead, ahead) : ahead;
      this.#isKnown = true;
      this.#late = undefined;
      return;
    }
    this.#late ??= { since: now, ahead };
    this.#late.ahead = Math.max(this.#late.ahead, ahead);
    if (now - this.#late.since < PATIENCE_S) return;
    this.#ahead = this.#late.ahead;
    this.#late = undefined;
  }
}
