// Ports of blocks of data flow: which ones a link can lead between, and which a person most likely means.
//
// Owns that guess. Whether a link is made is decided by the draft, which says why not.

import type { PaletteBlock, PortFacts } from '../engine/facts';

export interface Port extends PortFacts {
  /** Its place among the ports of its block. */
  index: number;
}

/** Ports of a block that go one way. */
export function portsOf(facts: PaletteBlock | undefined, way: PortFacts['way']): Port[] {
  const all = (facts?.ports ?? []).map((port, index) => ({ ...port, index }));
  return all.filter((port) => port.way === way);
}

/** Where a port is on its block, from 0 at the left and top to 1. */
function side(
  { at }: PortFacts,
  [width, height]: readonly [number, number],
): 'left' | 'top' | 'right' | 'bottom' {
  const gaps = { left: at[0], right: width - at[0], top: at[1], bottom: height - at[1] };
  const sides = Object.keys(gaps) as (keyof typeof gaps)[];
  return sides.reduce((best, one) => (gaps[one] < gaps[best] ? one : best), 'left' as keyof typeof gaps);
}

/** The side of a block at which a port is. */
export function sideOf(
  port: PortFacts,
  size: readonly [number, number],
): 'left' | 'top' | 'right' | 'bottom' {
  return side(port, size);
}

/** Whether tokens of an output fit an input, by what both are of; a signal starts, and is no value. */
function fits(gives: PortFacts, takes: PortFacts): number {
  if (gives.of === takes.of) return 3;
  if (gives.of === 'unit' || takes.of === 'unit') return 0;
  return gives.of === 'any' || takes.of === 'any' ? 2 : 1;
}

/**
 * The input that a link from this output most likely means: one that fits best, and to which nothing leads yet. Undefined: the
 * block has no input.
 */
export function inputFor(
  gives: PortFacts,
  facts: PaletteBlock | undefined,
  taken: ReadonlySet<number>,
): Port | undefined {
  const worth = (port: Port): number => fits(gives, port) * 2 + (taken.has(port.index) ? 0 : 1);
  return best(portsOf(facts, 'in'), worth);
}

/** Where a link ends at a block that is put into it, and where the new one begins; undefined: it has no such ports. */
export function through(
  gives: PortFacts,
  takes: PortFacts,
  facts: PaletteBlock | undefined,
): [number, number] | undefined {
  const into = inputFor(gives, facts, new Set());
  const out = best(portsOf(facts, 'out'), (port) => fits(port, takes));
  return into && out ? [into.index, out.index] : undefined;
}

function best(all: Port[], worth: (port: Port) => number): Port | undefined {
  return all.reduce<Port | undefined>(
    (found, one) => (found && worth(found) >= worth(one) ? found : one),
    undefined,
  );
}
