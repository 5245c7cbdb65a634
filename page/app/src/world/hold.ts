// What a pointer takes hold of in the world, and the order that carries it.
//
// Owns which thing is under a finger and the words of orders with places. Pure.

import type { Place, Scene, WorldState } from './types';

/** What is held: a robot, or a thing by its number. */
export interface Held {
  is: 'robot' | 'thing';
  number: number;
  /** From the finger to its centre, in metres. */
  offset: [number, number];
  degrees: number;
}

/** How far beside a thing a finger still takes it, in metres, for so many pixels in a metre. */
function grace(scale: number): number {
  return 10 / scale;
}

/** What can be taken hold of at a place of the world; undefined: nothing, or it is locked. */
export function holdAt(
  scene: Scene,
  state: WorldState,
  [x, y]: readonly [number, number],
  scale: number,
): Held | undefined {
  let best: Held | undefined;
  let nearest = Infinity;
  const see = (is: Held['is'], number: number, at: Place | undefined, size: number) => {
    if (!at) return;
    const far = Math.hypot(at[0] - x, at[1] - y);
    if (far > size / 2 + grace(scale) || far - size / 2 >= nearest) return;
    nearest = far - size / 2;
    best = { is, number, offset: [at[0] - x, at[1] - y], degrees: at[2] };
  };
  if (!scene.locked.robot) {
    // Only the first robot is that of the board.
    see('robot', 0, state.robots[0]?.at, Math.max(...(scene.robots[0]?.size ?? [0, 0])));
  }
  if (!scene.locked.world) {
    scene.things.forEach((thing, number) => see('thing', number, state.things[number], thing.size));
  }
  return best;
}

/** Four digits after the point are a tenth of a millimetre. */
function digits(value: number): string {
  return String(Number(value.toFixed(4)));
}

/** The order that puts the robot somewhere. */
export function putRobot([x, y, degrees]: Place): string {
  // Within half a turn: a robot that has turned often has great angles.
  return `robot ${digits(x)} ${digits(y)} ${digits(within(degrees))}`;
}

/** The order that puts a thing somewhere. */
export function putThing(number: number, [x, y]: Place): string {
  return `thing ${number} ${digits(x)} ${digits(y)}`;
}

/** The order that carries what is held to a finger. */
export function carry(held: Held, [x, y]: readonly [number, number]): string {
  const at: Place = [x + held.offset[0], y + held.offset[1], held.degrees];
  return held.is === 'robot' ? putRobot(at) : putThing(held.number, at);
}

/** A heading within half a turn to each side. */
export function within(degrees: number): number {
  return ((((degrees + 180) % 360) + 360) % 360) - 180;
}
