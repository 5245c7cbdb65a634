// What a node says now, ready to be shown.
//
// Owns how a sample meets its format; knows no drawing.

import type { Known } from '../robot/robot.svelte';
import { type Field, fieldsOf, isInteger, isNumber, named, unitsOf } from './format';
import type { Samples } from './series';
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
export const NONE = '\u2013';

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

/** A rest that is no place on the scale of an actuator, such as a servo that is off; undefined if its rest is an ordinary value. */
export function offValue(rest: string): number | undefined {
  return rest
    .trim()
    .split(/\s+/)
    .map(Number)
    .find((one) => Math.abs(one) >= 2 ** 31);
}

/** Whether an actuator is off. */
export function isOff(known: Known, all: readonly Reading[]): boolean {
  const off = offValue(known.node.rest);
  return off !== undefined && all.some((one) => numberOf(one) === off);
}

/** The samples of a number since a time; it has no value while it is off. */
export function samplesOf(known: Known | undefined, field: string, since: number): Samples {
  const samples = known?.histories.get(field)?.since(since) ?? { times: [], values: [] };
  const off = offValue(known?.node.rest ?? '');
  if (off === undefined) return samples;
  return { ...samples, values: samples.values.map((value) => (value === off ? NaN : value)) };
}
