// Which link a place of the sheet is on, and where a block has room in a link.
//
// Owns how near that is. A link is taken for the straight pieces between its blocks and corners.

import type { DrawnBlock, DrawnLink, DrawnSheet } from '../engine/facts';

type Spot = [number, number];

/** A block that is dropped so near to a link goes into it, in px. */
const NEAR_PX = 20;
/** Between two blocks there is room for a third one from here on. */
const ROOM_PX = 150;
/** Else it stands so far below. */
const BELOW_PX = 100;

const middle = ({ at, size }: DrawnBlock): Spot => [at[0] + (size[0] || 50) / 2, at[1] + (size[1] || 50) / 2];

/** From the beginning of a link to its end; undefined if one hangs loose. */
function corners(sheet: DrawnSheet, link: DrawnLink): Spot[] | undefined {
  const [from, to] = [link.from, link.to].map((end) => sheet.blocks.find(({ id }) => id === end));
  return from && to ? [middle(from), ...link.path.slice(1, -1), middle(to)] : undefined;
}

/** How far a place is from a piece of a link. */
function distance([x, y]: Spot, [fromX, fromY]: Spot, [toX, toY]: Spot): number {
  const [right, down] = [toX - fromX, toY - fromY];
  const length = right * right + down * down;
  const share = length === 0 ? 0 : ((x - fromX) * right + (y - fromY) * down) / length;
  const part = Math.min(Math.max(share, 0), 1);
  return Math.hypot(x - fromX - part * right, y - fromY - part * down);
}

/** The id of the link at a place; undefined: there is none. */
export function linkAt(sheet: DrawnSheet, place: Spot): string | undefined {
  let [found, least]: [string | undefined, number] = [undefined, NEAR_PX];
  for (const link of sheet.links) {
    const all = corners(sheet, link) ?? [];
    for (let at = 0; at + 1 < all.length; at++) {
      const far = distance(place, all[at] ?? [0, 0], all[at + 1] ?? [0, 0]);
      if (far < least) [found, least] = [link.id, far];
    }
  }
  return found;
}

/** The upper left corner of a block in a link. */
export function roomIn(sheet: DrawnSheet, link: DrawnLink): Spot | undefined {
  const all = corners(sheet, link);
  const [from, to] = [all?.[0], all?.at(-1)];
  if (!from || !to) return undefined;
  const below = Math.hypot(to[0] - from[0], to[1] - from[1]) < ROOM_PX ? BELOW_PX : 0;
  return [Math.round((from[0] + to[0]) / 2 - 25), Math.round((from[1] + to[1]) / 2 - 25 + below)];
}
