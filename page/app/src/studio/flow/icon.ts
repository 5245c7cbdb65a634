// The picture of a block of data flow that has none: its outline with its ports.
//
// Owns that drawing, in the square of 50 in which all pictures are.

import type { PaletteBlock } from '../engine/facts';

const HALF = 15;

/** Pieces of SVG, as the table of blocks has them. */
export function iconOf({ icon, ports, size }: PaletteBlock): string {
  if (icon || !ports || !size) return icon;
  const spot = (at: number, length: number): string => ((at / length) * 2 * HALF - HALF).toFixed(1);
  const dots = ports.map(
    ({ at }) => `<circle class="f" cx="${spot(at[0], size[0])}" cy="${spot(at[1], size[1])}" r="4"/>`,
  );
  return `<rect class="i" x="${-HALF}" y="${-HALF}" width="${2 * HALF}" height="${2 * HALF}" rx="4"/>${dots.join('')}`;
}
