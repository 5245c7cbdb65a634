// Every limit of a recording that this page reads.
//
// Owns the numbers only; the code that enforces each one names it from here.

/** Bytes of a file, and of the last minutes of a robot, which are 16 MiB unless its `trikd` is told otherwise. */
export const FILE_BYTES_MAX = 64 << 20;
/** Bytes of one record, and of what comes out of a chunk. */
export const RECORD_BYTES_MAX = 16 << 20;
/** Bytes that come out of one compressed byte: lz4 reaches 255. */
export const INFLATION_MAX = 256;
/** Bytes that come out of all chunks. */
export const INFLATED_BYTES_MAX = 1 << 30;
/** Channels that are looked at, as the recorder makes them at most. */
export const CHANNELS_MAX = 8192;
/** Bytes of the text of a message type. */
export const SCHEMA_BYTES_MAX = 256 << 10;
/** Numbers that are kept, of eight bytes each. */
export const NUMBERS_MAX = 16 << 20;
/** Bytes of texts, lines and pictures that are kept. */
export const TEXT_BYTES_MAX = 32 << 20;
/** What a text costs besides its letters. */
export const TEXT_COST = 64;
/** The page does something else after so much reading. */
export const SLICE_MS = 30;
/** A robot that sends nothing for so long will not. */
export const SILENCE_MS = 15_000;
