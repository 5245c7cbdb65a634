// The way of a link between two blocks on the sheet.
//
// Owns where it leaves a box, its bend, and the place of its guard. Corners that a person drew in TRIK Studio stay.

export interface Box {
  x: number;
  y: number;
  width: number;
  height: number;
}

export type Spot = [number, number];

export interface Route {
  d: string;
  /** Where it begins and ends. */
  ends: [Spot, Spot];
  /** Where the guard stands. */
  label: Spot;
}

/** How far two links in both directions are apart, in px. */
const APART_PX = 14;

export function middle({ x, y, width, height }: Box): Spot {
  return [x + width / 2, y + height / 2];
}

/** Where the way from the middle of a box to another place leaves it. */
function edge(box: Box, to: Spot): Spot {
  const [x, y] = middle(box);
  const [right, down] = [to[0] - x, to[1] - y];
  const share = Math.max(Math.abs(right) / (box.width / 2), Math.abs(down) / (box.height / 2));
  return share <= 1 ? [x, y] : [x + right / share, y + down / share];
}

/** `corners` are those between both ends; `both`: there is a link back. */
export function wayOf(from: Box, to: Box, corners: readonly Spot[], both: boolean): Route {
  if (from === to || (from.x === to.x && from.y === to.y)) return ring(from);
  const inner: Spot[] = [...corners];
  if (inner.length === 0 && both) inner.push(beside(middle(from), middle(to)));
  const first = inner[0] ?? middle(to);
  const last = inner.at(-1) ?? middle(from);
  const all = [edge(from, first), ...inner, edge(to, last)];
  const half = Math.floor((all.length - 1) / 2);
  const one: Spot = all[half] ?? [0, 0];
  const other: Spot = all[half + 1] ?? [0, 0];
  const label: Spot =
    all.length % 2 === 1 && inner.length > 0
      ? (all[(all.length - 1) / 2] ?? [0, 0])
      : [(one[0] + other[0]) / 2, (one[1] + other[1]) / 2];
  const d = `M${all.map(([x, y]) => `${round(x)} ${round(y)}`).join('L')}`;
  return { d, label, ends: [all[0] ?? [0, 0], all.at(-1) ?? [0, 0]] };
}

/** A place to the right of the middle of the way, as traffic drives. */
function beside(from: Spot, to: Spot): Spot {
  const [right, down] = [to[0] - from[0], to[1] - from[1]];
  const far = Math.hypot(right, down) || 1;
  return [(from[0] + to[0]) / 2 - (down / far) * APART_PX, (from[1] + to[1]) / 2 + (right / far) * APART_PX];
}

/** From the right side over the corner to the top of the same block. */
function ring({ x, y, width, height }: Box): Route {
  const [right, top] = [x + width, y];
  const far = 30;
  const corners: Spot[] = [
    [right, y + height / 2],
    [right + far, y + height / 2],
    [right + far, top - far],
    [x + width / 2, top - far],
    [x + width / 2, top],
  ];
  return {
    d: `M${corners.map((corner) => corner.join(' ')).join('L')}`,
    label: [right + far, top - far],
    ends: [corners[0] ?? [0, 0], corners.at(-1) ?? [0, 0]],
  };
}

function round(length: number): number {
  return Math.round(length * 10) / 10;
}
