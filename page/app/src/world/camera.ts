// Which part of the world is seen, and how large: from metres to pixels of the picture and back.
//
// Owns the arithmetic of panning, zooming and pinching. Pure: knows no events and no canvas.

/** A place on the picture, in CSS pixels from its upper left corner. */
export interface Spot {
  x: number;
  y: number;
}

/** Left, bottom, right and top of something, in metres. */
export type Bounds = readonly [number, number, number, number];

/** Pixels in a metre, at least and at most. */
export const SCALES = [2, 4000] as const;
/** Room around what is fitted in, in pixels. */
const ROOM = 12;

export class Camera {
  /** Pixels in a metre. */
  scale = 200;
  /** What of the world is in the middle of the picture. */
  x = 0;
  y = 0;
  width = 1;
  height = 1;

  /** The picture has another size; its middle stays. */
  resize(width: number, height: number): void {
    this.width = Math.max(1, width);
    this.height = Math.max(1, height);
  }

  /** All of it is seen, as large as can be. */
  fit([left, bottom, right, top]: Bounds): void {
    const across = Math.max(right - left, 1e-3);
    const high = Math.max(top - bottom, 1e-3);
    const scale = Math.min((this.width - 2 * ROOM) / across, (this.height - 2 * ROOM) / high);
    this.scale = clamp(scale);
    this.x = (left + right) / 2;
    this.y = (bottom + top) / 2;
  }

  /** Where a place of the world is seen. */
  spot(x: number, y: number): Spot {
    return {
      x: this.width / 2 + (x - this.x) * this.scale,
      y: this.height / 2 - (y - this.y) * this.scale,
    };
  }

  /** Which place of the world is seen there. */
  place({ x, y }: Spot): [number, number] {
    return [this.x + (x - this.width / 2) / this.scale, this.y - (y - this.height / 2) / this.scale];
  }

  /** Everything moves by so many pixels. */
  pan(right: number, down: number): void {
    this.x -= right / this.scale;
    this.y += down / this.scale;
  }

  /** So many times as large; what is at the spot stays there. */
  zoom(factor: number, at: Spot = { x: this.width / 2, y: this.height / 2 }): void {
    const [x, y] = this.place(at);
    this.scale = clamp(this.scale * factor);
    const [nowX, nowY] = this.place(at);
    this.x += x - nowX;
    this.y += y - nowY;
  }

  /** Two fingers go from two spots to two others: what is between them stays between them. */
  pinch(from: readonly [Spot, Spot], to: readonly [Spot, Spot]): void {
    const before = middle(from);
    const after = middle(to);
    this.pan(after.x - before.x, after.y - before.y);
    const apart = distance(from);
    if (apart > 1) this.zoom(distance(to) / apart, after);
  }

  /** For a canvas with so many of its pixels in one of the page: metres become pixels, up becomes down. */
  matrix(ratio: number): [number, number, number, number, number, number] {
    const scale = this.scale * ratio;
    const { x, y } = this.spot(0, 0);
    return [scale, 0, 0, -scale, x * ratio, y * ratio];
  }

  /** Changes when another picture of what stands still is needed. */
  get key(): string {
    return [this.scale, this.x, this.y, this.width, this.height].join(' ');
  }
}

function clamp(scale: number): number {
  return Number.isFinite(scale) ? Math.min(SCALES[1], Math.max(SCALES[0], scale)) : SCALES[0];
}

function middle([a, b]: readonly [Spot, Spot]): Spot {
  return { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 };
}

function distance([a, b]: readonly [Spot, Spot]): number {
  return Math.hypot(a.x - b.x, a.y - b.y);
}
