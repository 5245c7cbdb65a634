// The world as the simulator tells it: what stands still, and what moves. `sim` makes these texts.

/** What stands still. */
export interface Scene {
  /** Left, top, right and bottom, in metres, y upwards. */
  bounds: [number, number, number, number];
}

/** What moves. */
export interface WorldState {
  /** Simulated time in seconds. */
  t: number;
}
