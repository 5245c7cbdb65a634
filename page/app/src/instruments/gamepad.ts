// A real gamepad as two pads and buttons.
//
// Owns its dead-man: after each release everything must have been let go once before it counts again, so that a stick that is
// held, or broken, moves nothing by itself.

import { type Place, stick } from './mix';
import { BUTTONS } from './setup';

/** What is needed of a gamepad of the browser. */
export interface Sticks {
  axes: readonly number[];
  buttons: readonly { pressed: boolean }[];
}

export interface Held {
  first: Place;
  second: Place;
  buttons: boolean[];
}

export const NOTHING: Held = {
  first: { x: 0, y: 0 },
  second: { x: 0, y: 0 },
  buttons: Array.from({ length: BUTTONS }, () => false),
};

function isNothing(held: Held): boolean {
  const { first, second, buttons } = held;
  return first.x === 0 && first.y === 0 && second.x === 0 && second.y === 0 && !buttons.includes(true);
}

export class Deadman {
  #isArmed = false;

  /** What is held counts again only when all of it was let go. */
  disarm(): void {
    this.#isArmed = false;
  }

  /** What counts of what is held now. */
  step(pad: Sticks | undefined): Held {
    if (!pad) {
      this.#isArmed = false;
      return NOTHING;
    }
    const [x = 0, y = 0, x2 = 0, y2 = 0] = pad.axes;
    const held = {
      // Sticks of a browser count downwards.
      first: stick(x, -y),
      second: stick(x2, -y2),
      buttons: Array.from({ length: BUTTONS }, (_, at) => pad.buttons[at]?.pressed ?? false),
    };
    if (isNothing(held)) this.#isArmed = true;
    return this.#isArmed ? held : NOTHING;
  }
}
