// What can be wrong with a recording, and where.
//
// Owns the kinds of it; what a person is told of each is in `words`.

export type RecordingFault =
  /** It does not begin as a recording does. */
  | 'magic'
  /** It ends within a record, or says that more comes than there is. */
  | 'cut'
  /** A record is not as the format has it. */
  | 'record'
  /** A record is larger than any that the page takes. */
  | 'giant'
  /** A compression that the page does not know. */
  | 'compression'
  /** Compressed bytes that cannot be. */
  | 'packed'
  /** Bytes are not those that were written. */
  | 'checksum'
  /** The file is larger than any that the page takes. */
  | 'large'
  /** There are more values than the page keeps. */
  | 'much'
  /** There is nothing to show. */
  | 'empty';

export class Wrong extends Error {
  constructor(
    readonly what: RecordingFault,
    /** The byte of the file where that is. */
    readonly at: number,
    /** What was found there. */
    readonly detail = '',
  ) {
    super(`${what} at byte ${at} ${detail}`);
  }
}
