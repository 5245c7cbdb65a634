// Ways around blocks: a link that nobody has bent would lead through what stands between its ends.
//
// Owns the corners of such links on the sheet of this page. A project keeps none of them: TRIK Studio draws as it likes.

import { DETOUR_BLOCKS_MAX } from '../../limits';
import type { DrawnSheet } from '../engine/facts';
import { type Box, type Spot, middle } from './way';

/** From a block to a way beside it. */
const NEAR_PX = 20;
/** The words below a block. */
const TITLE_PX = 36;
/** From one way to another one beside it, and how many are side by side. */
const LANE_PX = 10;
const LANES = 4;

/** A stretch of a way that runs along a side of the sheet. */
interface Lane {
  isAcross: boolean;
  at: number;
  from: number;
  to: number;
}

/** The corners of each link that goes around something, by its id. */
export function detours({
  blocks,
  links,
}: Pick<DrawnSheet, 'blocks' | 'links'>): ReadonlyMap<string, readonly Spot[]> {
  const found = new Map<string, readonly Spot[]>();
  if (blocks.length > DETOUR_BLOCKS_MAX) return found;
  const boxes = new Map<string, Box>();
  for (const { id, at, size } of blocks)
    boxes.set(id, { x: at[0], y: at[1], width: size[0] || 50, height: size[1] || 50 });
  const lanes: Lane[] = [];
  for (const { id, from, to, path } of links) {
    const [begin, end] = [boxes.get(from ?? ''), boxes.get(to ?? '')];
    if (!begin || !end || begin === end || path.length > 2) continue;
    const others = [...boxes.values()].filter((box) => box !== begin && box !== end);
    const hit = others.filter((box) => crosses(middle(begin), middle(end), box));
    if (hit.length === 0) continue;
    const corners = around([begin, end, ...hit], others, lanes);
    if (corners) found.set(id, corners);
  }
  return found;
}

/** Corners above, below, left or right of boxes, of which the first two are the ends; the first side on which nothing stands. */
function around(near: readonly Box[], others: readonly Box[], lanes: Lane[]): readonly Spot[] | undefined {
  const [begin, end] = near;
  if (!begin || !end) return undefined;
  const [[x, y], [toX, toY]] = [middle(begin), middle(end)];
  const isWide = Math.abs(toX - x) >= Math.abs(toY - y);
  const above = Math.min(...near.map((box) => box.y)) - NEAR_PX;
  const below = Math.max(...near.map((box) => box.y + box.height)) + TITLE_PX + NEAR_PX;
  const left = Math.min(...near.map((box) => box.x)) - NEAR_PX;
  const right = Math.max(...near.map((box) => box.x + box.width)) + NEAR_PX;
  const sides: [isAcross: boolean, at: number, away: number][] = [
    [true, above, -LANE_PX],
    [true, below, LANE_PX],
    [false, left, -LANE_PX],
    [false, right, LANE_PX],
  ];
  for (const [isAcross, first, away] of isWide ? sides : [...sides.slice(2), ...sides.slice(0, 2)]) {
    const [from, to] = (isAcross ? [x, toX] : [y, toY]).toSorted((one, other) => one - other) as Spot;
    const taken = lanes.filter(
      (lane) => lane.isAcross === isAcross && lane.from < to && from < lane.to && isNear(lane.at, first),
    );
    const at = first + away * Math.min(taken.length, LANES);
    const corners: Spot[] = isAcross
      ? [
          [x, at],
          [toX, at],
        ]
      : [
          [at, y],
          [at, toY],
        ];
    const way: Spot[] = [[x, y], ...corners, [toX, toY]];
    if (
      others.some((box) => way.some((spot, index) => index > 0 && crosses(way[index - 1] ?? spot, spot, box)))
    )
      continue;
    lanes.push({ isAcross, at, from, to });
    return corners;
  }
  return undefined;
}

const isNear = (one: number, other: number): boolean => Math.abs(one - other) <= LANE_PX * LANES;

/** Whether a straight line goes through a box (Liang and Barsky: the stretch of the line within all four sides). */
export function crosses([x, y]: Spot, [toX, toY]: Spot, box: Box): boolean {
  const [right, down] = [toX - x, toY - y];
  let [first, last] = [0, 1];
  for (const [way, room] of [
    [-right, x - box.x],
    [right, box.x + box.width - x],
    [-down, y - box.y],
    [down, box.y + box.height - y],
  ] as const) {
    if (way === 0) {
      if (room < 0) return false;
    } else if (way < 0) first = Math.max(first, room / way);
    else last = Math.min(last, room / way);
  }
  return first < last;
}
