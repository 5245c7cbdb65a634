// Where a pad is touched, as what actuators do.
//
// Owns the mixing of two motors; knows no robot. What is no number rests.

import type { Range } from './format';

/** A place on a pad: x to the right, y ahead, both -1 to 1. */
export interface Place {
  x: number;
  y: number;
}

/** Left and right, -1 to 1. */
export interface Sides {
  left: number;
  right: number;
}

function part(value: number): number {
  return Number.isFinite(value) ? Math.max(-1, Math.min(1, value)) : 0;
}

/** A stick beside the middle by less than this is in the middle. */
export const DEAD = 0.12;

/** A place of a stick without the dead zone, which begins at 0 beyond it. */
export function stick(x: number, y: number): Place {
  const place = { x: part(x), y: part(y) };
  const size = Math.hypot(place.x, place.y);
  if (size <= DEAD) return { x: 0, y: 0 };
  const factor = (Math.min(1, size) - DEAD) / (1 - DEAD) / size;
  return { x: place.x * factor, y: place.y * factor };
}

/** Ahead is both, to the right is left more than right; neither is more than 1, and their relation is kept. */
export function mixed(place: Place): Sides {
  const left = part(place.y) + part(place.x);
  const right = part(place.y) - part(place.x);
  const over = Math.max(1, Math.abs(left), Math.abs(right));
  return { left: left / over, right: right / over };
}

/** -1 to 1 over a range whose middle is 0 if both signs are in it, and from its least to its greatest otherwise. */
export function scaled(value: number, range: Range): number {
  const at = part(value);
  if (range.min < 0 && range.max > 0) return at >= 0 ? at * range.max : -at * range.min;
  return range.min + ((at + 1) / 2) * (range.max - range.min);
}
