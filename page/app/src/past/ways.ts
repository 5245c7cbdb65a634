// The ways of robots through a recording, and what their markers have left: found once, and cut at any moment.
//
// Owns the points with their times. What a state is, and which scene is there when, is known to `around`.

import { PAST_POINTS_MAX } from '../limits';
import { lengthen, POINTS, type Stroke, type Trail } from '../world/trail';
import type { WorldState } from '../world/types';

/** A stroke with the time of each of its points, which has two numbers. */
interface Timed extends Stroke {
  times: number[];
}

/** What a marker has left since a scene was told. */
interface Mark extends Timed {
  era: number;
}

export class Ways {
  readonly #ways: Timed[] = [];
  readonly #marks: Mark[] = [];
  readonly #drawing = new Map<number, Mark>();
  /** When each scene began; what markers have left goes with it. */
  readonly #eras: number[] = [];
  #points = 0;

  /** A scene begins: the first one, or another. */
  tell(time: number): void {
    this.#eras.push(time);
    this.#drawing.clear();
  }

  /** The next moment. */
  put(time: number, state: WorldState): void {
    for (const [number, robot] of state.robots.entries()) {
      const [x, y] = robot.at;
      this.#extend((this.#ways[number] ??= { points: [], times: [], colour: '' }), time, x, y);
      this.#mark(number, time, robot.marker, x, y);
    }
  }

  #mark(number: number, time: number, colour: string, x: number, y: number): void {
    let drawing = this.#drawing.get(number);
    if (colour === '') {
      this.#drawing.delete(number);
      return;
    }
    if (drawing?.colour !== colour) {
      drawing = { points: [], times: [], colour, era: this.#eras.length };
      this.#drawing.set(number, drawing);
      this.#marks.push(drawing);
    }
    this.#extend(drawing, time, x, y);
  }

  #extend(stroke: Timed, time: number, x: number, y: number): void {
    if (this.#points >= PAST_POINTS_MAX) return;
    lengthen(stroke.points, x, y);
    for (; 2 * stroke.times.length < stroke.points.length; this.#points++) stroke.times.push(time);
  }

  /** What was there at a moment, as far as it was found. */
  cut(time: number, trail: Trail): void {
    trail.ways = this.#ways.map((way) => until(way, time));
    const era = count(this.#eras, time);
    const marks = this.#marks.filter((mark) => mark.era === era && (mark.times[0] ?? Infinity) <= time);
    trail.marks = marks.map((mark) => until(mark, time));
  }
}

/** How many times are not after this one. */
export function count(times: readonly number[], time: number): number {
  let low = 0;
  let high = times.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((times[middle] ?? Infinity) <= time) low = middle + 1;
    else high = middle;
  }
  return low;
}

function until({ points, times, colour }: Timed, time: number): Stroke {
  const end = count(times, time);
  return { points: points.slice(2 * Math.max(0, end - POINTS), 2 * end), colour };
}
