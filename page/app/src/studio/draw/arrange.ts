// Blocks of a diagram in order: from left to right as the program goes, and what goes in parallel one below the other.
//
// Owns the places. A block stands one column after the first way that leads to it; loops lead back and count for nothing.

import type { DrawnSheet } from '../engine/facts';

const COLUMN_PX = 125;
const ROW_PX = 125;
const LEFT_PX = 100;
const TOP_PX = 100;

/** Where each block stands then. */
export function arranged(sheet: DrawnSheet): { id: string; at: [number, number] }[] {
  const next = new Map<string, string[]>();
  const entered = new Set<string>();
  for (const { from, to } of sheet.links) {
    if (!from || !to || from === to) continue;
    next.set(from, [...(next.get(from) ?? []), to]);
    entered.add(to);
  }
  const columns = new Map<string, number>();
  const starts = sheet.blocks.filter(({ kind, id }) => kind === 'InitialNode' || !entered.has(id));
  const rest = sheet.blocks.filter((block) => !starts.includes(block));
  // The ways from all beginnings side by side; what none leads to is a ring, and begins at its first block.
  for (const block of [...starts, ...rest]) {
    if (columns.has(block.id)) continue;
    let front = [block.id];
    for (let column = 0; front.length > 0; column++) {
      for (const id of front) columns.set(id, column);
      const all = front.flatMap((id) => next.get(id) ?? []);
      front = [...new Set(all)].filter((id) => !columns.has(id));
    }
  }
  const rows = new Map<number, number>();
  return sheet.blocks
    .toSorted((one, other) => (columns.get(one.id) ?? 0) - (columns.get(other.id) ?? 0))
    .map(({ id }) => {
      const column = columns.get(id) ?? 0;
      const row = rows.get(column) ?? 0;
      rows.set(column, row + 1);
      return { id, at: [LEFT_PX + column * COLUMN_PX, TOP_PX + row * ROW_PX] };
    });
}
