// Blocks of a diagram in order: from left to right as the program goes, and what goes in parallel one below the other.
//
// Owns the places. A block stands one column after the first way that leads to it; loops lead back and count for nothing.

import type { DrawnSheet } from '../engine/facts';

const COLUMN_PX = 125;
const ROW_PX = 125;
/** Columns before a program goes on below. */
const BAND_COLUMNS = 20;
/** Blocks of a column before they stand beside each other. */
const COLUMN_ROWS = 40;
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
  const places = sheet.blocks
    .toSorted((one, other) => (columns.get(one.id) ?? 0) - (columns.get(other.id) ?? 0))
    .map(({ id }) => {
      const column = columns.get(id) ?? 0;
      const row = rows.get(column) ?? 0;
      rows.set(column, row + 1);
      return { id, column, row };
    });
  return places.map(({ id, column, row }) => ({ id, at: placed(column, row, rows) }));
}

/** A long program goes on below, as lines of a text do; many blocks of one column stand side by side. */
function placed(column: number, row: number, rows: ReadonlyMap<number, number>): [number, number] {
  const band = Math.floor(column / BAND_COLUMNS);
  let above = 0;
  for (let one = 0; one < band; one++) above += tallest(one * BAND_COLUMNS, rows);
  const right = (column % BAND_COLUMNS) + Math.floor(row / COLUMN_ROWS) * BAND_COLUMNS;
  return [LEFT_PX + right * COLUMN_PX, TOP_PX + (above + (row % COLUMN_ROWS)) * ROW_PX];
}

/** Rows of the band that begins with a column. */
function tallest(begin: number, rows: ReadonlyMap<number, number>): number {
  const all = Array.from({ length: BAND_COLUMNS }, (_, at) => rows.get(begin + at) ?? 0);
  return Math.min(COLUMN_ROWS, Math.max(1, ...all));
}
