// What keys do on the picture of the world.
//
// Owns which key does what. Carrying robots and things goes through orders, as with a finger.

import type { Robot } from '../robot/robot.svelte';
import { putRobot, putThing } from './hold';
import type { Place } from './types';
import type { View } from './view';

/** Pixels of one step over the picture. */
const PAN = 60;
const ZOOM = 1.25;
/** Metres and degrees of one step of what is carried. */
const STEP = 0.05;
const TURN = 15;

const ARROWS: Record<string, [right: number, up: number]> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
};

/** How long a key goes on from where the one before has put something: its order may still be on the way. */
const FRESH_MS = 400;

/** Carries the robot and things by keys. */
export class Keys {
  /** Where the last key has put what is picked. */
  #put: { picked: number; at: Place; when: number } | undefined;

  constructor(
    private readonly view: View,
    private readonly robot: Robot,
    private readonly order: (order: string) => void,
  ) {}

  /** Does what a key says; false: it says nothing here. */
  press(event: KeyboardEvent): boolean {
    if (event.ctrlKey || event.metaKey || event.altKey) return false;
    const { camera } = this.view;
    const arrow = ARROWS[event.key];
    if (arrow && event.shiftKey) this.#move(arrow[0] * STEP, arrow[1] * STEP, 0);
    else if (arrow) camera.pan(-arrow[0] * PAN, arrow[1] * PAN);
    else if (event.key === '+' || event.key === '=') camera.zoom(ZOOM);
    else if (event.key === '-') camera.zoom(1 / ZOOM);
    else if (event.key === '0') this.view.fit();
    else if (event.key === '[') this.#pick(-1);
    else if (event.key === ']') this.#pick(1);
    else if (event.key === ',') this.#move(0, 0, TURN);
    else if (event.key === '.') this.#move(0, 0, -TURN);
    else return false;
    this.view.touch();
    return true;
  }

  #pick(by: number): void {
    const count = 1 + (this.robot.scene?.things.length ?? 0);
    this.view.picked = (this.view.picked + by + count) % count;
  }

  #move(right: number, up: number, degrees: number): void {
    if (!this.robot.mayOrderWorld) return;
    const { picked } = this.view;
    const world = this.robot.world;
    const now = performance.now();
    const isFresh = this.#put?.picked === picked && now - this.#put.when < FRESH_MS;
    const told = picked === 0 ? world?.robots[0]?.at : world?.things[picked - 1];
    const from = isFresh ? this.#put?.at : told;
    if (!from) return;
    const at: Place = [from[0] + right, from[1] + up, from[2] + degrees];
    this.#put = { picked, at, when: now };
    this.order(picked === 0 ? putRobot(at) : putThing(picked - 1, at));
  }
}
