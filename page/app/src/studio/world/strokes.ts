// What is drawn by hand: strokes, which are tags in the thing, and the path that they are together.
//
// Owns how a path becomes strokes and how strokes move. Knows no other thing of a world.

import { type Spot, Values } from './units';
import { type Splice, type Tag, encoded, set } from './xml';

/** The path of the strokes among the attributes of the thing, where the model puts it: it is written in no tag. */
export const PIECES = 'pieces';

/** Strokes move along with the first of them. */
export function movedPieces({ values }: { values: Values }, tag: Tag, path: string): Splice[] {
  const [[x, y], [fromX, fromY]] = [beginOf(path), beginOf(values.text(PIECES))];
  const right = x - fromX;
  const down = y - fromY;
  return pieces(tag).flatMap((piece) => {
    const own = new Values(
      Object.fromEntries(piece.attributes.map(({ name, value }) => [name, value])),
      values.scale,
    );
    const places = ['begin', 'end'].map((name) => {
      const [atX, atY] = own.point(name);
      return [name, own.writePoint(atX + right, atY + down)];
    });
    return set(piece, Object.fromEntries(places));
  });
}

export const pieces = (tag: Tag): Tag[] => tag.children.filter(({ name }) => name === 'stylusLine');

/** Pieces of a wave. */
const WAVE = 12;

/** Where a hand goes that nobody has moved: a wave from one place to the other. */
export function wave([x, y]: Spot, [toX, toY]: Spot): Spot[] {
  return Array.from({ length: WAVE + 1 }, (_, at): Spot => {
    const part = at / WAVE;
    const side = Math.sin(part * 2 * Math.PI) / 6;
    return [x + (toX - x) * part - (toY - y) * side, y + (toY - y) * part + (toX - x) * side];
  });
}

/** The path of a hand from place to place. */
export const pathOf = (way: readonly Spot[]): string =>
  way.map(([x, y], at) => `${at === 0 ? 'M' : 'L'}${x} ${y}`).join('');

/** Where a path of strokes begins. */
export function beginOf(path: string): Spot {
  const [, x = '0', y = '0'] = /^M(\S+) ([^\sLM]+)/.exec(path) ?? [];
  return [Number(x), Number(y)];
}

/** A path of strokes that begins elsewhere. */
export const carriedTo = (path: string, right: number, down: number): string =>
  path.replace(
    /([ML])(\S+) ([^\sLM]+)/g,
    (_, letter: string, x: string, y: string) => `${letter}${Number(x) + right} ${Number(y) + down}`,
  );

/** Strokes from place to place, as TRIK Studio keeps them: each one has a pen of its own, too. */
export function strokes(values: Values, way: readonly Spot[]): string {
  const names = ['stroke', 'stroke-width'].filter((name) => values.has(name));
  const pen = names.map((name) => ` ${name}="${encoded(values.text(name))}"`).join('');
  return way
    .slice(1)
    .map(([x, y], at) => {
      const [fromX, fromY] = way[at] ?? [x, y];
      return `\n    <stylusLine begin="${values.writePoint(fromX, fromY)}" end="${values.writePoint(x, y)}"${pen}/>`;
    })
    .join('');
}
