// Lengths of a world: units of the file, pixels of TRIK Studio, and numbers as they are written.
//
// Owns the arithmetic of units. Knows no tag.

export type Unit = 'px' | 'cm' | 'mm' | 'm';
export type Spot = readonly [x: number, y: number];

/** 16 pixels are 5.6 cm. */
const CM_PX = 16 / 5.6;

/** Pixels in one of each unit, the grid that things snap to and the small step of keys, both in the unit. */
export const UNITS: Record<Unit, { pixels: number; grid: number; step: number }> = {
  px: { pixels: 1, grid: 10, step: 1 },
  cm: { pixels: CM_PX, grid: 5, step: 1 },
  mm: { pixels: CM_PX / 10, grid: 50, step: 10 },
  m: { pixels: CM_PX * 100, grid: 0.05, step: 0.01 },
};
/** Pixels in a metre. */
export const METRE_PX = CM_PX * 100;
/** A greater number is refused by the reader of worlds. */
const NUMBER_MAX = 1e6;
/** Digits behind the point that are written: of a metre the tenth of a millimetre. */
const DIGITS = 4;

/** A number of a text: 0 where there is none. */
export function number(text: string): number {
  const trimmed = text.trim();
  const found = trimmed === '' ? NaN : Number(trimmed);
  return Number.isFinite(found) ? Math.min(Math.max(found, -NUMBER_MAX), NUMBER_MAX) : 0;
}

/** A number as it is written. */
export function written(found: number): string {
  const most = Math.min(Math.max(found, -NUMBER_MAX), NUMBER_MAX);
  const rounded = Math.round(most * 10 ** DIGITS) / 10 ** DIGITS;
  return String(rounded === 0 ? 0 : rounded);
}

/** The attributes of a thing, with lengths in pixels. */
export class Values {
  constructor(
    readonly texts: Readonly<Record<string, string>>,
    /** Pixels in a unit of the text. */
    readonly scale: number,
  ) {}

  has(name: string): boolean {
    return this.texts[name] !== undefined;
  }

  text(name: string, byDefault = ''): string {
    return this.texts[name] ?? byDefault;
  }

  /** A number that is no length. */
  plain(name: string, byDefault = 0): number {
    const text = this.texts[name];
    return text === undefined ? byDefault : number(text);
  }

  length(name: string, byDefault = 0): number {
    const text = this.texts[name];
    return text === undefined ? byDefault : number(text) * this.scale;
  }

  /** Lengths with colons between them; all 0 if they are not as many. */
  lengths(name: string, count: number): number[] {
    const parts = this.text(name).split(':');
    return parts.length === count
      ? parts.map((part) => number(part) * this.scale)
      : Array.from({ length: count }, () => 0);
  }

  point(name: string): Spot {
    const [x = 0, y = 0] = this.lengths(name, 2);
    return [x, y];
  }

  pair([x, y]: readonly [string, string], byDefault = 0): Spot {
    return [this.length(x, byDefault), this.length(y, byDefault)];
  }

  /** A length in pixels as it is written. */
  write(pixels: number): string {
    return written(pixels / this.scale);
  }

  writePoint(...pixels: number[]): string {
    return pixels.map((one) => this.write(one)).join(':');
  }
}

/** A colour of a world for a picture: `#aarrggbb` has its transparency first. */
export function colour(text: string, byDefault = '#000000'): string {
  const long = /^#([0-9a-f]{2})([0-9a-f]{6})$/i.exec(text);
  if (long) return `#${long[2]}${long[1]}`;
  return /^(#[0-9a-f]{6}|#[0-9a-f]{3}|[a-z]+)$/i.test(text) ? text : byDefault;
}
