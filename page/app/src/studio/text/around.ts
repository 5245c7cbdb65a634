// What is around a block of a sheet: its links, its neighbours, how many links it may have.
//
// Owns how many links leave each type of block.

import type { DrawnBlock, DrawnLink, DrawnSheet } from '../engine/facts';

/** How many links leave a block at least and at most; one, of most. */
const LEAVE: Record<string, [least: number, most: number]> = {
  FinalNode: [0, 0],
  CommentBlock: [0, 0],
  IfBlock: [2, 2],
  Loop: [2, 2],
  PreconditionalLoop: [2, 2],
  SwitchBlock: [2, Infinity],
  Fork: [2, Infinity],
  // A person may cancel it.
  Input: [1, 2],
};

export const leavesLeast = ({ kind }: DrawnBlock): number => LEAVE[kind]?.[0] ?? 1;
export const leavesMost = ({ kind }: DrawnBlock): number => LEAVE[kind]?.[1] ?? 1;

/** Links that leave a block, and end somewhere. */
export function leaving(sheet: DrawnSheet, { id }: DrawnBlock): DrawnLink[] {
  return sheet.links.filter(({ from, to }) => from === id && to !== null);
}

/** Links that lead to a block. */
export function leading(sheet: DrawnSheet, { id }: DrawnBlock): DrawnLink[] {
  return sheet.links.filter(({ from, to }) => to === id && from !== null);
}

/** Whether a link may lead to a block. */
export function mayLeadTo({ kind }: DrawnBlock): boolean {
  return kind !== 'InitialNode' && kind !== 'CommentBlock';
}

const far = (one: DrawnBlock, [x, y]: readonly [number, number]): number =>
  Math.hypot(one.at[0] - x, one.at[1] - y);

export function nearest(to: DrawnBlock, blocks: readonly DrawnBlock[]): DrawnBlock | undefined {
  return blocks.toSorted((one, other) => far(one, to.at) - far(other, to.at))[0];
}

/** Two blocks with their texts stand so far from each other, in px. */
const APART_PX = 120;
/** Nearer than that one would cover the other. */
const NEAR_PX = 90;

/** A place beside a block where nothing is: to the right, below, or farther below. */
export function beside(sheet: DrawnSheet, { at: [x, y] }: DrawnBlock): [number, number] {
  const places: [number, number][] = [];
  for (let down = 0; down < 6; down++)
    places.push([x + APART_PX, y + down * APART_PX], [x, y + (down + 1) * APART_PX]);
  const isFree = (place: [number, number]): boolean =>
    sheet.blocks.every((one) => far(one, place) >= NEAR_PX);
  return places.find(isFree) ?? [x + APART_PX, y];
}
