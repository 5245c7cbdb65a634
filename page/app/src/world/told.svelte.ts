// The world around a virtual robot as the simulator tells it while somebody looks.
//
// Owns the newest of it.

import type { Around } from './around';
import type { Scene, WorldState } from './types';

export class ToldWorld implements Around {
  scene = $state.raw<Scene | undefined>(undefined);
  state: WorldState | undefined;
  /** It has no past here: who looks keeps the ways. */
  readonly trail = undefined;
  readonly isGround = false;

  look(): void {
    // All that it knows it was told.
  }
}
