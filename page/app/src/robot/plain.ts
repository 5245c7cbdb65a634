// What comes from elsewhere as JSON and is believed no further than it was looked at.

/** Whether a value has members that can be asked for. */
export function isObject(value: unknown): value is Record<string, unknown> {
  return typeof value === 'object' && value !== null && !Array.isArray(value);
}
