// What a format says: the fields of a node, and which values each of them takes.
//
// Owns ranges, and the sense of a slider; knows no robot. A value that does not fit is never made into text.

import { FORMAT_FIELDS_MAX } from '../limits';

/** `i32 power`: what a field is. */
export interface Field {
  name: string;
  /** `i8` to `u64`, `f32`, `f64`, or something without numbers. */
  kind: string;
}

/** From where to where; both ends are meant. */
export interface Range {
  min: number;
  max: number;
}

const INTEGER = /^([iu])(8|16|32|64)$/;
const FLOAT = /^f(32|64)$/;
const FLOAT32_MAX = 3.4028234663852886e38;

/** The fields of a format. Bytes without names and texts are one field, as in a recording. */
export function fieldsOf(format: string): Field[] {
  const whole = format.trim();
  if (/^text\b/.test(whole)) return [{ name: 'data', kind: 'text' }];
  if (/^\S+\s+x\s+\d+$/.test(whole)) return [{ name: 'data', kind: 'bytes' }];
  return whole.split(',', FORMAT_FIELDS_MAX).map((part) => {
    const [kind = '', name = ''] = part.trim().split(/\s+/);
    return { name: name.toLowerCase(), kind: kind.replace(/^[<>]/, '') };
  });
}

/** The same fields with the names that samples have for them. */
export function named(fields: readonly Field[], names: readonly string[]): Field[] {
  if (names.length !== fields.length) return [...fields];
  return fields.map((field, at) => ({ ...field, name: names[at] ?? field.name }));
}

/** Whether a field is one number. */
export function isNumber(field: Field): boolean {
  return INTEGER.test(field.kind) || FLOAT.test(field.kind);
}

export function isInteger(field: Field): boolean {
  return INTEGER.test(field.kind);
}

/** Which numbers a field can have; undefined if it has none. Integers are those that a script knows exactly. */
export function rangeOf(field: Field): Range | undefined {
  const integer = INTEGER.exec(field.kind);
  if (integer) {
    const isSigned = integer[1] === 'i';
    const bits = Number(integer[2]);
    const max = Math.min(2 ** (isSigned ? bits - 1 : bits) - 1, Number.MAX_SAFE_INTEGER);
    return { min: isSigned ? -Math.min(2 ** (bits - 1), Number.MAX_SAFE_INTEGER) : 0, max };
  }
  if (!FLOAT.test(field.kind)) return undefined;
  const max = field.kind === 'f32' ? FLOAT32_MAX : Number.MAX_VALUE;
  return { min: -max, max };
}

/** What a slider goes over, by the unit; the format bounds it. */
const BY_UNIT: Record<string, Range> = {
  '%': { min: -100, max: 100 },
  deg: { min: -90, max: 90 },
  rad: { min: -Math.PI / 2, max: Math.PI / 2 },
  'deg/s': { min: -1000, max: 1000 },
  'rad/s': { min: -20, max: 20 },
  mdeg: { min: -180_000, max: 180_000 },
  'm/s': { min: -1, max: 1 },
  'mm/s': { min: -1000, max: 1000 },
  V: { min: 0, max: 12 },
  Hz: { min: 0, max: 1000 },
};
const WITHOUT_UNIT: Range = { min: -100, max: 100 };

/** Whether a slider can go over all of it. */
export function isSmall(range: Range): boolean {
  return range.max - range.min <= 65535;
}

/** What a slider for a field goes over; undefined if it is no number. */
export function sliderOf(field: Field, unit: string): Range | undefined {
  const range = rangeOf(field);
  if (!range) return undefined;
  const byUnit = Object.hasOwn(BY_UNIT, unit) ? BY_UNIT[unit] : undefined;
  const { min, max } = byUnit ?? (isSmall(range) ? range : WITHOUT_UNIT);
  return { min: Math.max(min, range.min), max: Math.min(max, range.max) };
}

/** The unit of each field: one for all, or one for each after commas. */
export function unitsOf(units: string, count: number): string[] {
  const each = units.split(',').map((unit) => unit.trim());
  return Array.from({ length: count }, (_, at) => (each.length > 1 ? (each[at] ?? '') : (each[0] ?? '')));
}

/** A number as the text of a field; undefined if it is none that the field can have. */
export function textOf(field: Field, value: number): string | undefined {
  const range = rangeOf(field);
  if (!range || !Number.isFinite(value)) return undefined;
  const fitting = isInteger(field) ? Math.round(value) : value;
  if (fitting < range.min || fitting > range.max) return undefined;
  // Not -0.
  return String(fitting === 0 ? 0 : fitting);
}

/** A tuple as the text of a node: all or nothing. */
export function tupleText(fields: readonly Field[], values: readonly number[]): string | undefined {
  if (fields.length === 0 || fields.length !== values.length) return undefined;
  const texts: string[] = [];
  for (const [at, field] of fields.entries()) {
    const text = textOf(field, values[at] ?? NaN);
    if (text === undefined) return undefined;
    texts.push(text);
  }
  return texts.join(' ');
}

/** What a person typed as a number for a field; undefined if it is none. A comma is a point. */
export function typed(field: Field, text: string): number | undefined {
  const plain = text.trim().replace(',', '.');
  if (!/^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d{1,3})?$/i.test(plain)) return undefined;
  const value = Number(plain);
  if (isInteger(field) && !Number.isInteger(value)) return undefined;
  return textOf(field, value) === undefined ? undefined : value;
}
