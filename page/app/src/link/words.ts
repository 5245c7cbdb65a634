// What this page and its server say to each other beside the control port; `page/src/word.rs` has the other end.

import type { Scene, WorldState } from '../world/types';

/** What the page wants. */
export type Order =
  | { do: 'write'; path: string; param?: string; value: string }
  /** To see the bytes inside of a node, or of none any more. */
  | { do: 'inspect'; path: string | null }
  | { do: 'world'; order: string }
  | { do: 'playback'; order: string }
  | { do: 'configure'; text: string }
  | { do: 'remove'; name: string }
  | { do: 'rename'; name: string; to: string }
  | { do: 'look'; world: boolean }
  | { do: 'take' }
  | { do: 'leave' }
  /** Digits that somebody has who is at the robot. */
  | { do: 'pair'; code: string }
  | { do: 'stop' };

/** What it is told. */
export type News =
  | {
      is: 'hello';
      name: string;
      version: string;
      world: boolean;
      /** The world takes orders: it is none that was recorded. */
      orders: boolean;
      /** The studio is served beside it. */
      studio: boolean;
      drives: boolean;
      configures: boolean;
    }
  | { is: 'control'; mine: boolean; who: string | null }
  | { is: 'robot'; there: boolean; why: string | null }
  | { is: 'written'; path: string; param: string | null; value: string; why: string | null }
  | { is: 'stages'; path: string; at_s: number; tuples: string[] }
  | { is: 'configured'; why: string | null }
  /** This computer may do things from now on; or the code was refused. */
  | { is: 'paired'; why: string | null }
  /** A program has another name; null: it is gone. */
  | { is: 'programs'; name: string; to: string | null }
  | { is: 'refused'; why: string }
  | { is: 'scene'; scene: Scene }
  | { is: 'world'; state: WorldState }
  | { is: 'playback'; state: Playback }
  | { is: 'beat' };

/** Where the recording is that is played; times are seconds. */
export interface Playback {
  at_s: number;
  length_s: number;
  speed: number;
  runs: boolean;
  loop: boolean;
}
