// Where a new block has room on the sheet.
//
// Owns the distance between two blocks.

import type { DrawnSheet } from '../engine/facts';

const APART_PX = 50;
const STEP_PX = 50;

/** What of the sheet is seen. */
export interface Seen {
  left: number;
  top: number;
  right: number;
  bottom: number;
}

/** The place nearest to the middle of what is seen where a block of this size has room; undefined: there is none. */
export function roomFor(
  sheet: DrawnSheet,
  [width, height]: readonly [number, number],
  seen: Seen,
): [number, number] | undefined {
  const isFree = ([x, y]: [number, number]): boolean =>
    sheet.blocks.every(
      ({ at, size }) =>
        x + width + APART_PX <= at[0] ||
        at[0] + size[0] + APART_PX <= x ||
        y + height + APART_PX <= at[1] ||
        at[1] + size[1] + APART_PX <= y,
    );
  const middle = [(seen.left + seen.right - width) / 2, (seen.top + seen.bottom - height) / 2] as const;
  const far = ([x, y]: [number, number]): number => Math.hypot(x - middle[0], y - middle[1]);
  const places: [number, number][] = [];
  const first = (length: number): number => Math.ceil((length + STEP_PX / 2) / STEP_PX) * STEP_PX;
  for (let x = first(seen.left); x + width < seen.right; x += STEP_PX)
    for (let y = first(seen.top); y + height < seen.bottom; y += STEP_PX) places.push([x, y]);
  return places.filter(isFree).toSorted((one, other) => far(one) - far(other))[0];
}
