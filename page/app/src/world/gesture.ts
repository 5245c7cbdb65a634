// Pointers on the picture: one pans or carries what it has taken hold of, two zoom and pan.
//
// Owns which pointers are down. What is panned and carried is told to `Hands`; knows no canvas.

import type { Spot } from './camera';

/** Who carries out what pointers do. */
export interface Hands<Held> {
  /** What can be taken hold of at a spot. */
  take(at: Spot): Held | undefined;
  /** What is held goes to a spot; the last call has `isLast`. */
  carry(held: Held, to: Spot, isLast: boolean): void;
  pan(right: number, down: number): void;
  pinch(from: [Spot, Spot], to: [Spot, Spot]): void;
}

export class Gesture<Held> {
  readonly #pointers = new Map<number, Spot>();
  #held: Held | undefined;

  constructor(private readonly hands: Hands<Held>) {}

  get isHolding(): boolean {
    return this.#held !== undefined;
  }

  down(pointer: number, at: Spot): void {
    this.#pointers.set(pointer, at);
    // A second finger means the picture, and what the first one held stays where it is.
    this.#held = this.#pointers.size === 1 ? this.hands.take(at) : undefined;
  }

  move(pointer: number, at: Spot): void {
    const before = this.#pointers.get(pointer);
    if (!before) return;
    const [first, second] = [...this.#pointers.keys()];
    if (this.#held !== undefined) {
      this.hands.carry(this.#held, at, false);
    } else if (first !== undefined && second !== undefined) {
      if (pointer === first || pointer === second) {
        const other = this.#pointers.get(pointer === first ? second : first);
        if (other) this.hands.pinch([before, other], [at, other]);
      }
    } else {
      this.hands.pan(at.x - before.x, at.y - before.y);
    }
    this.#pointers.set(pointer, at);
  }

  up(pointer: number): void {
    const at = this.#pointers.get(pointer);
    this.#pointers.delete(pointer);
    if (this.#held !== undefined && at) this.hands.carry(this.#held, at, true);
    this.#held = undefined;
  }
}
