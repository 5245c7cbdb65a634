// What a run has come through: the world and all numbers at moments of model time.
//
// Owns how much is kept: when that is too much, every second moment goes, so that the whole run stays, with larger steps.

import { RUN_MOMENTS_MAX, RUN_NUMBERS_MAX } from '../../limits';
import type { Samples } from '../../instruments/series';
import type { Place, Placed } from '../../world/types';
import type { State } from '../engine/facts';

export interface Moment {
  ms: number;
  robots: Placed[];
  things: Place[];
  /** By the name of a variable, or the port of a motor or sensor. */
  numbers: Record<string, number>;
}

/** What moves, at a time. */
export type Moving = Pick<Moment, 'robots' | 'things'>;

export class Moments {
  #all: Moment[] = [];
  /** Between two moments that are kept, at least. */
  #step_ms = 0;
  /** It has changed, in whatever. */
  version = 0;

  get all(): readonly Moment[] {
    return this.#all;
  }

  clear(): void {
    this.#all = [];
    this.#step_ms = 0;
    this.version += 1;
  }

  put(state: State): void {
    const last = this.#all.at(-1);
    // What is not later is what a person has changed meanwhile.
    if (last && state.ms <= last.ms) this.#all.pop();
    const before = this.#all.at(-1);
    this.#all.push(momentOf(state));
    this.version += 1;
    // The newest one is always there; the one before it only if it is far enough from its own.
    const earlier = this.#all.at(-3);
    if (before && earlier && before.ms - earlier.ms < this.#step_ms) this.#all.splice(-2, 1);
    if (this.#all.length > RUN_MOMENTS_MAX) this.#thin();
  }

  #thin(): void {
    this.#all = this.#all.filter((_, at) => at % 2 === 0 || at === this.#all.length - 1);
    const [first, last] = [this.#all[0], this.#all.at(-1)];
    if (first && last) this.#step_ms = (last.ms - first.ms) / (RUN_MOMENTS_MAX / 2);
  }

  /** Names that have had a number, in their order. */
  get names(): string[] {
    const names = new Set<string>();
    for (const { numbers } of this.#all)
      for (const name of Object.keys(numbers)) if (names.size < RUN_NUMBERS_MAX) names.add(name);
    return [...names];
  }

  /** A number over seconds of model time; a gap where it was not there. */
  samples(name: string): Samples {
    const times: number[] = [];
    const values: number[] = [];
    for (const { ms, numbers } of this.#all) {
      const value = numbers[name];
      if (value === undefined && values.length === 0) continue;
      times.push(ms / 1000);
      values.push(value ?? NaN);
    }
    return { times, values };
  }

  /** What moves at a time, between two moments as if it moved straight; undefined: nothing is kept. */
  at(ms: number): Moving | undefined {
    const next = this.#after(ms);
    const [before, after] = [this.#all[next - 1], this.#all[next]];
    if (!before || !after) return before ?? after;
    const share = (ms - before.ms) / (after.ms - before.ms);
    const robots = before.robots.map((robot, at) => {
      const to = after.robots[at];
      return to ? { ...robot, at: between(robot.at, to.at, share) } : robot;
    });
    const things = before.things.map((thing, at) => {
      const to = after.things[at];
      return to ? between(thing, to, share) : thing;
    });
    return { robots, things };
  }

  /** The numbers that were there at a time. */
  numbersAt(ms: number): Record<string, number> {
    return this.#all[this.#after(ms) - 1]?.numbers ?? {};
  }

  /** The place of the first moment after a time. */
  #after(ms: number): number {
    let [from, to] = [0, this.#all.length];
    while (from < to) {
      const middle = (from + to) >> 1;
      if ((this.#all[middle]?.ms ?? 0) <= ms) from = middle + 1;
      else to = middle;
    }
    return from;
  }
}

function momentOf({ ms, world, variables, motors, sensors }: State): Moment {
  const numbers: Record<string, number> = {};
  let count = 0;
  for (const [name, value] of [
    ...Object.entries(sensors),
    ...Object.entries(motors),
    ...Object.entries(variables),
  ]) {
    const number = numberOf(value);
    if (number === undefined || count >= RUN_NUMBERS_MAX) continue;
    numbers[name] = number;
    count += 1;
  }
  // Rays are many, and only of the present.
  const robots = world.robots.map((robot) => ({ ...robot, rays: [] }));
  return { ms, robots, things: world.things, numbers };
}

function numberOf(value: number | string): number | undefined {
  if (value === 'true') return 1;
  if (value === 'false') return 0;
  const number = typeof value === 'number' ? value : value.trim() === '' ? NaN : Number(value);
  return Number.isFinite(number) ? number : undefined;
}

function between(from: Place, to: Place, share: number): Place {
  const turn = ((((to[2] - from[2]) % 360) + 540) % 360) - 180;
  return [from[0] + (to[0] - from[0]) * share, from[1] + (to[1] - from[1]) * share, from[2] + turn * share];
}
