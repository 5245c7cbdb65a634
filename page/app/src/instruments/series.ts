// Numbers of several nodes at their own times, as one graph draws them.
//
// Owns the join of their times, and what is said about the part that is visible; knows no drawing.

import { DRAWN_MAX } from '../limits';

/** Samples of one number, the oldest first; NaN is a gap. */
export interface Samples {
  times: number[];
  values: number[];
}

/** All on one axis of times: null is a gap, undefined means that this one has no sample then, which is no gap. */
export interface Joined {
  times: number[];
  columns: (number | null | undefined)[][];
}

/** The least and greatest of each stretch of time, and each gap. */
export function thinned(samples: Samples, most = DRAWN_MAX): Samples {
  const { times, values } = samples;
  if (times.length <= most) return samples;
  const out: Samples = { times: [], values: [] };
  const stretch = Math.ceil((2 * times.length) / most);
  const put = (at: number) => {
    out.times.push(times[at] ?? 0);
    out.values.push(values[at] ?? NaN);
  };
  for (let begin = 0; begin < times.length; begin += stretch) {
    const end = Math.min(begin + stretch, times.length);
    const kept = new Set<number>();
    let least = -1;
    let greatest = -1;
    for (let at = begin; at < end; at++) {
      const value = values[at] ?? NaN;
      if (Number.isNaN(value)) {
        if (!Number.isNaN(values[at - 1] ?? 0)) kept.add(at);
        continue;
      }
      if (least < 0 || value < (values[least] ?? 0)) least = at;
      if (greatest < 0 || value > (values[greatest] ?? 0)) greatest = at;
    }
    if (least >= 0) kept.add(least).add(greatest);
    for (const at of [...kept].sort((one, other) => one - other)) put(at);
  }
  return out;
}

/** One axis of times for all of them. */
export function joined(all: readonly Samples[]): Joined {
  const times = [...new Set(all.flatMap((one) => one.times))].sort((one, other) => one - other);
  const places = new Map(times.map((time, at) => [time, at]));
  const columns = all.map((one) => {
    const column = new Array<number | null | undefined>(times.length).fill(undefined);
    for (const [at, time] of one.times.entries()) {
      const value = one.values[at] ?? NaN;
      column[places.get(time) ?? 0] = Number.isFinite(value) ? value : null;
    }
    // A gap lasts until the next value, at the times of the others too.
    let isGap = false;
    for (const [at, value] of column.entries()) {
      if (value === undefined && isGap) column[at] = null;
      else if (value !== undefined) isGap = value === null;
    }
    return column;
  });
  return { times, columns };
}

export interface Summary {
  min: number;
  max: number;
  mean: number;
}

/**
 * Of what was there from a time to a time: a value holds until the next one, so the mean is one over time. Undefined if nothing
 * was there.
 */
export function summary(samples: Samples, from: number, to: number): Summary | undefined {
  let held = 0;
  let sum = 0;
  let min = Infinity;
  let max = -Infinity;
  for (const [at, time] of samples.times.entries()) {
    const value = samples.values[at] ?? NaN;
    const begin = Math.max(time, from);
    const end = Math.min(samples.times[at + 1] ?? Infinity, to);
    if (!Number.isFinite(value) || time > to || end < from) continue;
    held += Math.max(end - begin, 0);
    sum += value * Math.max(end - begin, 0);
    min = Math.min(min, value);
    max = Math.max(max, value);
  }
  if (min > max) return undefined;
  return { min, max, mean: held > 0 ? sum / held : (min + max) / 2 };
}

/** The value that was there at a time: that of the last sample until then. NaN: none, or a gap. */
export function valueAt(samples: Samples, time: number): number {
  let value = NaN;
  for (const [at, when] of samples.times.entries()) {
    if (when > time) break;
    value = samples.values[at] ?? NaN;
  }
  return value;
}
