// Names in expressions: which one stands at a place, which ones have a value, and which ones are nearly the same.
//
// Owns how near is near.

import type { DrawnSheet, NameFacts, PaletteBlock } from '../engine/facts';

const OFFERED = 2;

/** The name at a line and column of a text, both from 1; undefined: there is none. */
export function nameAt(
  text: string,
  line: number,
  column: number,
): { name: string; isCall: boolean } | undefined {
  const rest = [...(text.split('\n')[line - 1] ?? '')].slice(column - 1).join('');
  const found = /^([\p{L}_][\p{L}\p{N}_]*)\s*(\(?)/u.exec(rest);
  return found?.[1] ? { name: found[1], isCall: found[2] === '(' } : undefined;
}

/** The text with another name at this place, and at no other. */
export function replaced(text: string, line: number, column: number, name: string, other: string): string {
  const lines = text.split('\n');
  const letters = [...(lines[line - 1] ?? '')];
  letters.splice(column - 1, [...name].length, ...other);
  lines[line - 1] = letters.join('');
  return lines.join('\n');
}

/** Names that may be meant, the nearest first. */
export function nearNames(name: string, names: readonly NameFacts[]): string[] {
  const most = name.length <= 3 ? 1 : 2;
  return names
    .map((one) => ({ name: one.name, far: distance(name.toLowerCase(), one.name.toLowerCase(), most) }))
    .filter(({ far }) => far <= most)
    .toSorted((one, other) => one.far - other.far || one.name.localeCompare(other.name))
    .slice(0, OFFERED)
    .map((one) => one.name);
}

/** How many letters are to be changed, added, left out, or exchanged with the next one; more than `most` is not counted out. */
export function distance(from: string, to: string, most: number): number {
  if (Math.abs(from.length - to.length) > most) return most + 1;
  let before: number[] = [];
  let last = Array.from({ length: to.length + 1 }, (_, at) => at);
  for (let row = 1; row <= from.length; row++) {
    const next = [row];
    for (let at = 1; at <= to.length; at++) {
      const isSame = from[row - 1] === to[at - 1];
      let least = Math.min(
        (last[at] ?? 0) + 1,
        (next[at - 1] ?? 0) + 1,
        (last[at - 1] ?? 0) + (isSame ? 0 : 1),
      );
      if (row > 1 && at > 1 && from[row - 1] === to[at - 2] && from[row - 2] === to[at - 1])
        least = Math.min(least, (before[at - 2] ?? 0) + 1);
      next.push(least);
    }
    before = last;
    last = next;
  }
  return last[to.length] ?? most + 1;
}

/** What a block gives a value. */
const ASSIGNED = /([\p{L}_][\p{L}\p{N}_]*)\s*(?:\[[^\]]*\]\s*)?[-+*/]?=(?!=)/gu;

/** Variables that a sheet gives a value. The names of a project have those too that are only read. */
export function given(sheet: DrawnSheet, facts: (kind: string) => PaletteBlock | undefined): Set<string> {
  const names = new Set<string>();
  for (const { kind, properties } of sheet.blocks) {
    for (const { name, takes, default: byDefault } of facts(kind)?.properties ?? []) {
      const value = properties[name] ?? byDefault;
      if (takes === 'variable') names.add(value.trim());
      if (takes === 'statements')
        for (const [, assigned = ''] of value.matchAll(ASSIGNED)) names.add(assigned);
    }
  }
  return names;
}
