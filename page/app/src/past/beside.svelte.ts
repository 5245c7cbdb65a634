// What is compared with the recording that is shown: another one, or the robot as it is now.
//
// Owns how their times meet: both begin together, apart from an offset that a person gives.

import { samplesOf } from '../instruments/reading';
import type { Samples } from '../instruments/series';
import type { Known } from '../robot/robot.svelte';
import type { Row, Side } from './differ';
import type { Memory } from './memory';
import { nodesAt, type Past } from './past.svelte';

export class Beside {
  /** By how much the other one is shown later than it would be. */
  offset_s = $state(0);

  constructor(
    readonly title: string,
    private readonly past: Past,
    /** Its nodes, at the moment that is shown or later. */
    readonly nodes: ReadonlyMap<string, Known>,
    readonly begin: number,
    /** For the table of differences, as it is now. */
    readonly side: () => Side,
    /** More comes of it. */
    readonly isLive: boolean,
  ) {}

  /** A time of the recording that is shown, less the same time of this one. */
  get shift(): number {
    return this.past.begin - this.begin + this.offset_s;
  }

  has(path: string, field: string): boolean {
    return this.nodes.get(path)?.histories.has(field) ?? false;
  }

  /** The samples of a number until a time; times are those of the recording that is shown. */
  samples(path: string, field: string, since: number, to: number): Samples {
    const { shift } = this;
    const { times, values } = samplesOf(this.nodes.get(path), field, since - shift);
    const shifted = times.map((time) => time + shift);
    let count = shifted.length;
    while (count > 0 && (shifted[count - 1] ?? 0) > to) count--;
    return { times: shifted.slice(0, count), values: values.slice(0, count) };
  }
}

/** Another recording. */
export function recordingBeside(past: Past, memory: Memory, title: string): Beside {
  const beside: Beside = new Beside(
    title,
    past,
    nodesAt(memory, () => past.now - beside.shift),
    memory.begin,
    () => sideOf(memory),
    false,
  );
  return beside;
}

/** The robot from now on. */
export function robotBeside(
  past: Past,
  robot: { readonly present: ReadonlyMap<string, Known>; readonly clock: number },
  title: string,
): Beside {
  const begin = robot.clock;
  const side = () => ({
    begin,
    end: robot.clock,
    paths: [...robot.present.keys()],
    rows: (path: string) =>
      new Map(
        [...(robot.present.get(path)?.histories ?? [])].map(([field, line]) => [field, line.since(begin)]),
      ),
  });
  return new Beside(title, past, robot.present, begin, side, true);
}

/** A recording as one side of the table. */
export function sideOf(memory: Memory): Side {
  return {
    begin: memory.begin,
    end: memory.end,
    paths: [...memory.tracks.keys()],
    rows: (path) => {
      const rows = new Map<string, Row>();
      const track = memory.tracks.get(path);
      if (!track) return rows;
      for (const field of track.numbers.keys()) rows.set(field, track.samples(field, -Infinity, Infinity));
      for (const [field, kept] of track.others) {
        const texts = [...kept].flatMap(([place, value]) =>
          typeof value === 'string' ? [{ place, value }] : [],
        );
        rows.set(field, {
          times: texts.map(({ place }) => track.times.at(place)),
          values: texts.map(({ value }) => value),
        });
      }
      return rows;
    },
  };
}
