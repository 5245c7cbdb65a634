// Orders that come with every move of a finger, told at most so often; the last one is always told.
//
// Owns the pace.

/** Between two orders: twenty in a second. */
export const PERIOD_MS = 50;

export class Paced {
  #told = -Infinity;
  #waiting: string | undefined;
  #timer: ReturnType<typeof setTimeout> | undefined;

  constructor(
    private readonly tell: (order: string) => void,
    private readonly now: () => number = () => performance.now(),
  ) {}

  put(order: string): void {
    this.#waiting = order;
    if (this.#timer !== undefined) return;
    const wait = this.#told + PERIOD_MS - this.now();
    if (wait <= 0) this.#flush();
    else this.#timer = setTimeout(() => this.#flush(), wait);
  }

  /** Nothing is told any more. */
  end(): void {
    clearTimeout(this.#timer);
    this.#timer = undefined;
    this.#waiting = undefined;
  }

  #flush(): void {
    this.#timer = undefined;
    const order = this.#waiting;
    this.#waiting = undefined;
    if (order === undefined) return;
    this.#told = this.now();
    this.tell(order);
  }
}
