// A stop that comes from elsewhere, as the values of what is held tell it: what was moving rests although nobody here let it go.
//
// Owns what each held actuator was ordered and has reached. Times are given, values are texts of the tree.

/** After an order to rest from here, reports of rest are its own for so long. */
export const OWN_MS = 400;

interface Held {
  isRest: boolean;
  /** It has reported that it moves, since it was ordered to. */
  hasMoved: boolean;
  rested_ms: number;
}

export class Elsewhere {
  readonly #held = new Map<string, Held>();

  /** A hand here orders this; `isRest` says whether that is its rest. */
  ordered(path: string, isRest: boolean, now_ms: number): void {
    const before = this.#held.get(path);
    if (isRest) this.#held.set(path, { isRest, hasMoved: false, rested_ms: now_ms });
    else if (!before || before.isRest)
      this.#held.set(path, { isRest, hasMoved: false, rested_ms: before?.rested_ms ?? now_ms });
  }

  /** No hand holds it any more. */
  released(path: string): void {
    this.#held.delete(path);
  }

  /** The robot reports it. True: somebody else has brought it to rest. */
  reported(path: string, isRest: boolean, now_ms: number): boolean {
    const held = this.#held.get(path);
    if (!held || held.isRest) return false;
    if (!isRest) held.hasMoved = true;
    return isRest && held.hasMoved && now_ms - held.rested_ms > OWN_MS;
  }
}
