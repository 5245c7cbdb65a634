// How often each place of a world was come to, by many robots, as a layer of colours.
//
// Owns the grid and its colours. Ways come from outside; knows no runs.

import { HEAT_CELLS_MAX } from '../limits';

/** A side of a cell in metres, unless the world is too large for it. */
const CELL = 0.02;
/** What is so near to a way is on it, in metres: a point of it could not be seen. */
const WIDE = 0.04;

/** From few to many: colours that differ in lightness too, red, green, blue and how much they cover. */
const COLOURS: [number, number, number, number][] = [
  [49, 104, 142, 90],
  [53, 183, 121, 115],
  [253, 231, 37, 145],
  [215, 48, 39, 165],
];

export class Heat {
  readonly columns: number;
  readonly rows: number;
  /** How many ways have been there, from the lowest row on, each from the left. */
  readonly counts: Uint16Array<ArrayBuffer>;
  /** The greatest count. */
  most = 0;
  readonly #cell: number;
  /** The last way that was in a cell: each counts once. */
  readonly #last: Uint16Array<ArrayBuffer>;
  #way = 0;
  #picture: HTMLCanvasElement | undefined;
  #isPainted = false;

  /** For a world between left, bottom, right and top. */
  constructor(private readonly bounds: readonly [number, number, number, number]) {
    const [left, bottom, right, top] = bounds;
    const [width, height] = [Math.max(right - left, CELL), Math.max(top - bottom, CELL)];
    this.#cell = Math.max(CELL, Math.max(width, height) / HEAT_CELLS_MAX);
    this.columns = Math.ceil(width / this.#cell);
    this.rows = Math.ceil(height / this.#cell);
    this.counts = new Uint16Array(this.columns * this.rows);
    this.#last = new Uint16Array(this.columns * this.rows);
  }

  /** Adds a way: x and y of each point in turn. */
  put(way: Float64Array): void {
    this.#way += 1;
    const [left, bottom] = this.bounds;
    const reach = Math.max(1, Math.round(WIDE / this.#cell));
    for (let at = 0; at + 1 < way.length; at += 2) {
      const column = Math.floor(((way[at] ?? NaN) - left) / this.#cell);
      const row = Math.floor(((way[at + 1] ?? NaN) - bottom) / this.#cell);
      for (let up = -reach; up <= reach; up++)
        for (let aside = -reach; aside <= reach; aside++)
          if (up * up + aside * aside <= reach * reach) this.#count(column + aside, row + up);
    }
    this.#isPainted = false;
  }

  #count(column: number, row: number): void {
    if (!(column >= 0 && column < this.columns && row >= 0 && row < this.rows)) return;
    const cell = row * this.columns + column;
    if (this.#last[cell] === this.#way) return;
    this.#last[cell] = this.#way;
    const count = (this.counts[cell] ?? 0) + 1;
    this.counts[cell] = count;
    this.most = Math.max(this.most, count);
  }

  /** Draws it; the context has metres, with y up. */
  draw(context: CanvasRenderingContext2D): void {
    if (this.most === 0) return;
    this.#picture ??= document.createElement('canvas');
    if (!this.#isPainted) this.#paint(this.#picture);
    const [left, bottom] = this.bounds;
    context.imageSmoothingEnabled = true;
    context.drawImage(this.#picture, left, bottom, this.columns * this.#cell, this.rows * this.#cell);
  }

  #paint(picture: HTMLCanvasElement): void {
    picture.width = this.columns;
    picture.height = this.rows;
    const pen = picture.getContext('2d');
    if (!pen) return;
    const image = pen.createImageData(this.columns, this.rows);
    for (const [cell, count] of this.counts.entries())
      if (count > 0) image.data.set(colourOf(count, this.most), 4 * cell);
    pen.putImageData(image, 0, 0);
    this.#isPainted = true;
  }
}

/** The colour of a count, of which the greatest one is `most`. */
export function colourOf(count: number, most: number): [number, number, number, number] {
  const share = most <= 1 ? 1 : (count - 1) / (most - 1);
  const at = Math.min(share, 1) * (COLOURS.length - 1);
  const [from, to] = [COLOURS[Math.floor(at)] ?? COLOURS[0], COLOURS[Math.ceil(at)]];
  if (!from || !to) return [0, 0, 0, 0];
  const mixed = from.map((part, nth) => Math.round(part + ((to[nth] ?? part) - part) * (at % 1)));
  return mixed as [number, number, number, number];
}
