// Blocks of data flow in order: columns as tokens go, each as wide as its widest block.
//
// Owns the places. What leads back counts for nothing.

import type { DrawnBlock, DrawnSheet } from '../engine/facts';

const BESIDE_PX = 100;
const BENEATH_PX = 75;
const GRID_PX = 25;

/** Where each block stands then. */
export function arranged(sheet: DrawnSheet): { id: string; at: [number, number] }[] {
  const columns = columnsOf(sheet);
  const places: { id: string; at: [number, number] }[] = [];
  let left = BESIDE_PX;
  for (let column = 0; places.length < sheet.blocks.length; column++) {
    const inside = sheet.blocks.filter(({ id }) => columns.get(id) === column);
    let top = BESIDE_PX;
    for (const block of inside) {
      places.push({ id: block.id, at: [left, top] });
      top += up(height(block) + BENEATH_PX);
    }
    left += up(Math.max(0, ...inside.map(({ size }) => size[0])) + BESIDE_PX);
  }
  return places;
}

const height = ({ size }: DrawnBlock): number => size[1];
const up = (length: number): number => Math.ceil(length / GRID_PX) * GRID_PX;

/** How many links each block is from one into which none leads. */
function columnsOf({ blocks, links }: DrawnSheet): Map<string, number> {
  const entered = new Set(links.filter(({ from, to }) => from !== to).map(({ to }) => to));
  const starts = blocks.filter(({ id }) => !entered.has(id));
  const columns = new Map<string, number>();
  // A ring into which none leads begins at its first block.
  for (const block of [...starts, ...blocks]) {
    if (columns.has(block.id)) continue;
    let front = starts.includes(block) ? starts.map(({ id }) => id) : [block.id];
    for (let column = 0; front.length > 0; column++) {
      for (const id of front) columns.set(id, column);
      const all = links.filter(({ from }) => from && front.includes(from)).map(({ to }) => to ?? '');
      front = [...new Set(all)].filter((id) => id && !columns.has(id));
    }
  }
  return columns;
}
