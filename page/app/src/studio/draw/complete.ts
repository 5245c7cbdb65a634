// Names that a person may mean while typing an expression.
//
// Owns which part of a text is the name that is typed.

import type { NameFacts } from '../engine/facts';

export interface Completion {
  name: string;
  /** What of the text it takes the place of. */
  from: number;
  to: number;
}

const OFFERED = 12;

/** Variables stand before what every robot has. */
const ORDER: Record<NameFacts['is'], number> = { variable: 0, sensor: 1, function: 2, constant: 3 };

/** What the name before this place may become; nothing if it is there already. */
export function completed(text: string, at: number, names: readonly NameFacts[]): Completion[] {
  const typed = /[\p{L}_][\p{L}\p{N}_]*$/u.exec(text.slice(0, at))?.[0] ?? '';
  if (typed === '' || isQuoted(text.slice(0, at))) return [];
  const low = typed.toLowerCase();
  return names
    .filter(({ name }) => name.toLowerCase().startsWith(low) && name !== typed)
    .toSorted((one, other) => ORDER[one.is] - ORDER[other.is] || one.name.localeCompare(other.name))
    .slice(0, OFFERED)
    .map(({ name, is }) => ({
      name: is === 'function' ? `${name}(` : name,
      from: at - typed.length,
      to: at,
    }));
}

/** Whether a text ends within quotes. */
function isQuoted(text: string): boolean {
  let quote = '';
  for (let at = 0; at < text.length; at++) {
    const letter = text[at] ?? '';
    if (quote && letter === '\\') at += 1;
    else if (quote) quote = letter === quote ? '' : quote;
    else if (letter === '"' || letter === "'") quote = letter;
  }
  return quote !== '';
}
