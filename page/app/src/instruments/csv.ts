// Numbers of a graph as a table, as `trik export` writes it.
//
// Owns the quotes. A text that a spreadsheet program would take for a formula begins with an apostrophe.

/** What formulas begin with, in narrow and in wide letters. */
const FORMULA = /^ *[=+\-@\t\r\uff1d\uff0b\uff0d\uff20]/;

/** A text as a cell. */
export function cell(text: string): string {
  const isFormula = FORMULA.test(text);
  if (!isFormula && !/[,;"\t\r\n]/.test(text)) return text;
  return `"${isFormula ? "'" : ''}${text.replaceAll('"', '""')}"`;
}

/** A column: null is a gap, undefined is no sample at that time. */
export type Column = readonly (number | null | undefined)[];

/** The table; a number is a number for each program, so it has no apostrophe. */
export function table(
  names: readonly string[],
  times: readonly number[],
  columns: readonly Column[],
): string {
  const rows = [['time_s', ...names].map(cell).join(',')];
  for (const [at, time] of times.entries()) {
    const cells = columns.map((column) => {
      const value = column[at];
      return value === null || value === undefined || !Number.isFinite(value) ? '' : String(value);
    });
    rows.push([time.toFixed(6), ...cells].join(','));
  }
  return rows.join('\n') + '\n';
}
