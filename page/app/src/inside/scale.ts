// What the slider of a converter's number goes over.
//
// Owns the guess where the configuration gives no range. Pure.

import type { Param } from './inside.svelte';

export interface Scale {
  min: number;
  max: number;
  step: number;
}

const STEPS = 200;
/** From so wide a scale on a number that is whole stays whole. */
const WHOLE_FROM = 8;

/** By the range of the number, else around what it is now. */
export function scaleOf({ value, min, max }: Param): Scale {
  const size = Math.max(Math.abs(value), 0.5);
  const least = min ?? Math.min(value < 0 ? 2 * value : 0, max === null ? 0 : max - 2 * size);
  const most = max ?? Math.max(value > 0 ? 2 * value : 0, least + 2 * size);
  const width = most - least;
  const isWhole = [value, least, most].every(Number.isInteger) && width >= WHOLE_FROM;
  return { min: least, max: most, step: isWhole ? Math.max(1, Math.round(width / STEPS)) : width / STEPS };
}
