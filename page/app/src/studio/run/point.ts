// Where a run stops: at a block, perhaps under a condition, and after a change of a variable.
//
// Owns the orders for it, in the words of docs/protocol.md.

export interface Point {
  /** An expression; empty: always. */
  condition: string;
  /** It stops from this hit on. */
  from: number;
  /** What is written, and then it does not stop; empty: it stops. */
  log: string;
}

export const PLAIN: Point = { condition: '', from: 1, log: '' };

/** The order that sets a breakpoint. */
export function orderOf(id: string, { condition, from, log }: Point): string {
  const hits = from > 1 ? ` from ${Math.floor(from)}` : '';
  const lines = [`break ${id}${hits}`];
  if (condition.trim() !== '') lines.push(`if ${line(condition)}`);
  if (log.trim() !== '') lines.push(`log ${line(log)}`);
  return lines.join('\n');
}

/** All orders by which a run stops. */
export function orders(points: ReadonlyMap<string, Point>, watches: ReadonlySet<string>): string[] {
  const at = [...points].map(([id, point]) => orderOf(id, point));
  return [...at, ...[...watches].map((name) => `watch ${name}`)];
}

/** An order is read line by line. */
function line(text: string): string {
  return text.trim().replaceAll(/\s*[\r\n]+\s*/g, ' ');
}
