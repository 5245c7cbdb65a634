// What a node says now, ready to be shown.
//
// Owns how a sample meets its format; knows no drawing.

import type { Known } from '../robot/robot.svelte';
import { type Field, fieldsOf, isInteger, isNumber, named, unitsOf } from './format';
import { bytesText, valueText } from './numbers';

export interface Reading {
  field: Field;
  unit: string;
  /** Undefined without a sample. */
  value: number | bigint | boolean | string | Uint8Array | undefined;
  text: string;
  isNumber: boolean;
}

/** What is shown where there is no value. */
export const NONE = '–';

/** Each field of a node, with or without a value. */
export function readings(known: Known): Reading[] {
  const sample = known.fields ?? {};
  const fields = named(fieldsOf(known.node.format), Object.keys(sample));
  const units = unitsOf(known.node.units, fields.length);
  return fields.map((field, at) => {
    const value = sample[field.name];
    const text =
      value === undefined
        ? NONE
        : value instanceof Uint8Array
          ? bytesText(value.length)
          : valueText(value, isInteger(field));
    return { field, unit: units[at] ?? '', value, text, isNumber: isNumber(field) };
  });
}

/** A reading as a number that a script can compute with; NaN if it is none. */
export function numberOf(reading: Reading): number {
  const { value } = reading;
  return typeof value === 'number' || typeof value === 'bigint' ? Number(value) : NaN;
}

/** Whether an actuator has what brings it to rest, and that is no place on its scale, such as a servo that is off. */
export function isOff(known: Known, all: readonly Reading[]): boolean {
  const rests = known.node.rest.trim().split(/\s+/).map(Number);
  const isAtRest = all.length === rests.length && all.every((one, at) => numberOf(one) === rests[at]);
  return isAtRest && rests.some((rest) => Math.abs(rest) >= 2 ** 31);
}
