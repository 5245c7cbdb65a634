// Values of programs as people write them.

/** Numbers as people write them: 262.9, not 262.90000000000003. */
export function shown(type: string, value: string): string {
  return type === 'float' && Number.isFinite(Number(value))
    ? String(Number(Number(value).toPrecision(9)))
    : value;
}
