// Where a new picture comes to be, and how large.
//
// Owns that it does not hide another one, and that its size is a number that a person can read.

import { isPicture } from './kinds';
import { type Item, anchorOf } from './model';
import type { Spot, UNITS } from './units';

/** How much of what is seen a new picture takes, at most. */
const SHARE = 0.6;

/** The width and height of a picture that is seen whole where `across` by `down` pixels of the world are seen. */
export function fitted(
  { width, height }: { width: number; height: number },
  across: number,
  down: number,
  unit: (typeof UNITS)['cm'],
): Spot {
  const scale = Math.min(1, (SHARE * across) / width, (SHARE * down) / height);
  return [rounded(width * scale, unit), rounded(height * scale, unit)];
}

/** A length in pixels of whole tenths of the small step of a unit, at least one. */
function rounded(length: number, { step, pixels }: (typeof UNITS)['cm']): number {
  const tenth = (step * pixels) / 10;
  return Math.max(1, Math.round(length / tenth)) * tenth;
}

/** A place, or one further down and to the right by whole steps, at which no picture begins. */
export function beside(items: readonly Item[], place: Spot, step_px: number): Spot {
  const name = (spot: Spot): string => spot.map((one) => Math.round(one)).join();
  const taken = new Set(items.filter(isPicture).map((item) => name(anchorOf(item))));
  let [x, y] = place;
  while (taken.has(name([x, y]))) [x, y] = [x + step_px, y + step_px];
  return [x, y];
}
