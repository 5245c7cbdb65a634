// Gets a recording from where it is, and reads it.
//
// Owns what a person is told if that does not work. This is loaded when the first recording is opened.

import { FILE_BYTES_MAX } from '../limits';
import { words } from '../words';
import { lastMinutes, Refused } from './box';
import { read, type Read } from './read';
import { Wrong } from './wrong';

export { recordingBeside, robotBeside } from './beside.svelte';
export { Past } from './past.svelte';

/** A recording, and its bytes. */
export interface Opened extends Read {
  bytes: Uint8Array<ArrayBuffer>;
}

/** Whether to go on; the part that is done is from 0 to 1, and undefined while nobody knows. */
export type ReadProgress = (part: number | undefined) => boolean;

export async function fromFile(file: File, told: ReadProgress): Promise<Opened | undefined> {
  if (file.size > FILE_BYTES_MAX) throw new Wrong('large', FILE_BYTES_MAX);
  return opened(new Uint8Array(await file.arrayBuffer()), told);
}

export async function fromRobot(address: string, told: ReadProgress): Promise<Opened | undefined> {
  const bytes = await lastMinutes(address, () => told(undefined));
  return bytes && opened(bytes, told);
}

async function opened(bytes: Uint8Array<ArrayBuffer>, told: ReadProgress): Promise<Opened | undefined> {
  const done = await read(bytes, told);
  return done && { ...done, bytes };
}

/** What is wrong, for a person. */
export function explained(error: unknown): string {
  if (error instanceof Wrong) return words.past.wrong[error.what](String(error.at), error.detail);
  if (error instanceof Refused) return words.past.refused(error.message || words.past.silent);
  return String(error);
}
