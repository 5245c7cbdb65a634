// Values on their way to actuators: not more often than a robot can use, and the newest always.
//
// Owns what waits. A rest and a stop wait for nothing, and nothing older follows them.

/** Least time between two orders to one actuator: 20 in a second. */
export const PERIOD_MS = 50;

/** What is needed of the world. */
export interface World {
  send(path: string, value: string): void;
  now_ms(): number;
  later(callback: () => void, after_ms: number): void;
}

interface Lane {
  sent_ms: number;
  waits: string | undefined;
  isDue: boolean;
}

export class Orders {
  readonly #lanes = new Map<string, Lane>();

  constructor(private readonly world: World) {}

  /** A value; it is sent now or, as the newest, soon. */
  put(path: string, value: string): void {
    const lane = this.#lane(path);
    const wait_ms = lane.sent_ms + PERIOD_MS - this.world.now_ms();
    if (wait_ms <= 0 && !lane.isDue) {
      this.#send(lane, path, value);
      return;
    }
    lane.waits = value;
    if (lane.isDue) return;
    lane.isDue = true;
    this.world.later(
      () => {
        lane.isDue = false;
        if (lane.waits !== undefined) this.#send(lane, path, lane.waits);
      },
      Math.max(wait_ms, 0),
    );
  }

  /** A value that waits for nothing: a rest. */
  now(path: string, value: string): void {
    this.#send(this.#lane(path), path, value);
  }

  /** Nothing that waits is sent. */
  drop(): void {
    for (const lane of this.#lanes.values()) lane.waits = undefined;
  }

  #lane(path: string): Lane {
    let lane = this.#lanes.get(path);
    if (!lane) this.#lanes.set(path, (lane = { sent_ms: -Infinity, waits: undefined, isDue: false }));
    return lane;
  }

  #send(lane: Lane, path: string, value: string): void {
    lane.waits = undefined;
    lane.sent_ms = this.world.now_ms();
    this.world.send(path, value);
  }
}
