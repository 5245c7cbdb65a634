// Numbers, ages and bytes as a person reads them.
//
// Owns digits; knows no words of a language but those that it is given.

/** About so many digits of a float say something. */
const DIGITS = 4;

/** A number with sensible digits; the minus is as wide as a digit, so that columns are steady. */
export function numberText(value: number | bigint, isWhole = Number.isInteger(value)): string {
  if (typeof value === 'bigint') return signed(String(value));
  if (Number.isNaN(value)) return 'NaN';
  if (!Number.isFinite(value)) return value > 0 ? '\u221e' : '\u2212\u221e';
  if (isWhole && Number.isInteger(value) && Math.abs(value) < 1e15) return signed(String(value));
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-4 || size >= 1e7)) return signed(value.toExponential(DIGITS - 1));
  const before = size < 1 ? 1 : Math.floor(Math.log10(size)) + 1;
  const after = size < 1 ? DIGITS : Math.max(0, Math.min(3, DIGITS + 1 - before));
  const text = value.toFixed(after);
  return signed(Number(text) === 0 ? text.replace('-', '') : text);
}

/** A number beside an axis: as short as it can be. */
export function axisText(value: number): string {
  const isLong = Math.abs(value) >= 1e6;
  return signed(isLong ? value.toExponential(2) : String(Number(value.toPrecision(6))));
}

function signed(text: string): string {
  return text.replaceAll('-', '\u2212');
}

/** Steps of size of bytes. */
const SIZES = ['B', 'KiB', 'MiB'];

/** So many bytes. */
export function bytesText(count: number): string {
  let size = count;
  let at = 0;
  while (size >= 1024 && at < SIZES.length - 1) {
    size /= 1024;
    at++;
  }
  return `${Number(size.toPrecision(3))} ${SIZES[at] ?? ''}`;
}

/** What a value of a sample says, except bytes. */
export function valueText(value: number | bigint | boolean | string, isWhole: boolean): string {
  if (typeof value === 'string') return value;
  if (typeof value === 'boolean') return value ? '1' : '0';
  return numberText(value, isWhole);
}

/** An age in whole seconds, minutes or hours; undefined while it is younger than is worth a word. */
export function age(seconds: number): { count: number; unit: 's' | 'min' | 'h' } | undefined {
  if (!Number.isFinite(seconds) || seconds <= 1) return undefined;
  if (seconds < 120) return { count: Math.floor(seconds), unit: 's' };
  if (seconds < 7200) return { count: Math.floor(seconds / 60), unit: 'min' };
  return { count: Math.floor(seconds / 3600), unit: 'h' };
}
