// What the view of the world shows, wherever it is from: the simulator, a recording, or what a real robot tells of itself.
//
// Owns that border.

import type { Trail } from './trail';
import type { Scene, WorldState } from './types';

export interface Around {
  /** What stands still; undefined: nothing is known yet. */
  readonly scene: Scene | undefined;
  /** What moves, at the moment that is shown. */
  readonly state: WorldState | undefined;
  /** The ways until then; undefined if those who look keep them. */
  readonly trail: Trail | undefined;
  /** It is only what the robot says of itself. */
  readonly isGround: boolean;
  /** Somebody looks: what is made of other things is made now. */
  look(): void;
}
