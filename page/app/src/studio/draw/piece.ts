// Blocks on the clipboard, as text: what one page copies, another one pastes.
//
// Owns what of a strange text is taken for blocks. Whether they are any is checked by the draft.

import type { Piece } from '../engine/facts';

/** Blocks of a text; undefined if it has none. */
export function pieceOf(text: string): Piece | undefined {
  try {
    const found: unknown = JSON.parse(text);
    return isPiece(found) ? found : undefined;
  } catch {
    return undefined;
  }
}

function isPiece(found: unknown): found is Piece {
  if (typeof found !== 'object' || found === null) return false;
  const { blocks, links } = found as Partial<Record<string, unknown>>;
  return Array.isArray(blocks) && Array.isArray(links) && blocks.length > 0 && blocks.every(hasPlace);
}

function hasPlace(block: unknown): boolean {
  if (typeof block !== 'object' || block === null) return false;
  const { at } = block as Partial<Record<string, unknown>>;
  return Array.isArray(at) && at.length === 2 && at.every(Number.isFinite);
}
