// What keys do on the picture of the world.
//
// Owns which key does what. Carrying robots and things goes through orders, as with a finger.

import { carry, shift, turn } from './hold';
import type { Robot } from '../robot/robot.svelte';
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

/** Does what a key says; false: it says nothing here. */
export function press(
  event: KeyboardEvent,
  view: View,
  robot: Robot,
  order: (order: string) => void,
): boolean {
  if (event.ctrlKey || event.metaKey || event.altKey) return false;
  const arrow = ARROWS[event.key];
  if (arrow && event.shiftKey) return move(view, robot, arrow, order);
  if (arrow) view.camera.pan(-arrow[0] * PAN, arrow[1] * PAN);
  else if (event.key === '+' || event.key === '=') view.camera.zoom(ZOOM);
  else if (event.key === '-') view.camera.zoom(1 / ZOOM);
  else if (event.key === '0') view.fit();
  else if (event.key === '[' || event.key === ']') pick(view, robot, event.key === ']' ? 1 : -1);
  else if (event.key === ',' || event.key === '.') {
    const at = robot.world?.robots[0]?.at;
    if (at) order(turn(at, event.key === ',' ? TURN : -TURN));
  } else return false;
  view.touch();
  return true;
}

function pick(view: View, robot: Robot, by: number): void {
  const count = 1 + (robot.scene?.things.length ?? 0);
  view.picked = (view.picked + by + count) % count;
}

function move(
  view: View,
  robot: Robot,
  [right, up]: [number, number],
  order: (order: string) => void,
): boolean {
  const [x, y] = [right * STEP, up * STEP];
  if (view.picked === 0) {
    const at = robot.world?.robots[0]?.at;
    if (at) order(shift(at, x, y));
  } else {
    const at = robot.world?.things[view.picked - 1];
    const held = { is: 'thing' as const, number: view.picked - 1, degrees: 0 };
    if (at) order(carry({ ...held, offset: [x, y] }, [at[0], at[1]]));
  }
  return true;
}
