// The way of each robot, and what its marker has left since the scene was told.
//
// Owns how much is kept. Knows no canvas; poses come from outside.

import type { WorldState } from './types';

/** Points of one way that are drawn; of a longer one the newest. */
export const POINTS = 20_000;
/** Nearer points are one, in metres. */
const NEAR = 0.002;
/** A jump of that many metres is a hand's work. */
const JUMP = 0.2;

/** Points, x and y in turn; NaN where the way has a gap. */
export interface Stroke {
  points: number[];
  colour: string;
}

export class Trail {
  /** The ways of robots, by their numbers. */
  ways: Stroke[] = [];
  /** What markers have left. */
  marks: Stroke[] = [];
  readonly #drawing = new Map<number, Stroke>();

  /** The next moment. */
  put(state: WorldState): void {
    state.robots.forEach((robot, number) => {
      const [x, y] = robot.at;
      this.step(number, x, y);
      this.#mark(number, robot.marker, x, y);
    });
  }

  /** A robot is there now. */
  step(number: number, x: number, y: number): void {
    extend((this.ways[number] ??= { points: [], colour: '' }), x, y);
  }

  /** Forgets the ways of robots; what markers have left is of the world. */
  clear(): void {
    this.ways = [];
  }

  /** The scene was told anew, with everything that markers have left. */
  told(): void {
    this.marks = [];
    this.#drawing.clear();
  }

  #mark(number: number, colour: string, x: number, y: number): void {
    let drawing = this.#drawing.get(number);
    if (colour === '') {
      this.#drawing.delete(number);
      return;
    }
    if (drawing?.colour !== colour) {
      drawing = { points: [], colour };
      this.#drawing.set(number, drawing);
      this.marks.push(drawing);
    }
    extend(drawing, x, y);
  }
}

function extend({ points }: Stroke, x: number, y: number): void {
  lengthen(points, x, y);
  if (points.length > 2 * POINTS) points.splice(0, POINTS);
}

/** The next point of a way, if it is another one; after a jump the way has a gap. */
export function lengthen(points: number[], x: number, y: number): void {
  const beforeX = points[points.length - 2];
  const beforeY = points[points.length - 1];
  if (beforeX !== undefined && beforeY !== undefined) {
    const far = Math.hypot(x - beforeX, y - beforeY);
    if (far < NEAR) return;
    if (far > JUMP) points.push(NaN, NaN);
  }
  points.push(x, y);
}
