// Frames of lz4, as chunks of recordings have them.
//
// Owns the format: https://github.com/lz4/lz4/blob/dev/doc/lz4_Frame_format.md. Believes nothing: how much comes out is given
// by the caller, and what does not fit into that is refused. Checksums are left to the recording, which has one of what comes
// out.

import { Wrong } from './wrong';

const MAGIC = 0x184d2204;
const VERSION = 1;
const HAS_BLOCK_SUMS = 0x10;
const HAS_SIZE = 0x08;
const HAS_SUM = 0x04;
const HAS_DICTIONARY = 0x01;
const IS_PLAIN = 0x80000000;
/** Of one block, by the frame's own table. */
const BLOCK_BYTES_MAX = 4 << 20;
const MATCH_MIN = 4;
/** A length that goes on in the bytes after it. */
const LONG = 15;

/** A place in the bytes of a frame, which never goes beyond its end. */
interface Place {
  readonly bytes: Uint8Array;
  readonly end: number;
  at: number;
}

/** What is in a frame; it is exactly so many bytes. */
export function unpacked(bytes: Uint8Array, size: number): Uint8Array {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  let at = 0;
  const take = (count: number): number => {
    if (bytes.length - at < count) throw new Wrong('packed', at, 'ends too early');
    at += count;
    return at - count;
  };
  if (view.getUint32(take(4), true) !== MAGIC) throw new Wrong('packed', 0, 'is no frame of lz4');
  const flags = view.getUint8(take(1));
  if (flags >> 6 !== VERSION) throw new Wrong('packed', 4, 'is of another version');
  if (flags & HAS_DICTIONARY) throw new Wrong('packed', 4, 'needs a dictionary');
  // How large blocks are, how much comes out, and the sum of that.
  take(1 + (flags & HAS_SIZE ? 8 : 0) + 1);
  const out = new Uint8Array(size);
  let done = 0;
  for (;;) {
    const head = view.getUint32(take(4), true);
    if (head === 0) break;
    const length = head & ~IS_PLAIN;
    if (length > BLOCK_BYTES_MAX) throw new Wrong('packed', at, 'has a block that is too long');
    const begin = take(length);
    if (head & IS_PLAIN) {
      if (length > size - done) throw new Wrong('packed', begin, 'has more than it should');
      out.set(bytes.subarray(begin, begin + length), done);
      done += length;
    } else {
      done = block({ bytes, at: begin, end: begin + length }, out, done);
    }
    if (flags & HAS_BLOCK_SUMS) take(4);
  }
  if (flags & HAS_SUM) take(4);
  if (done !== size || at !== bytes.length) throw new Wrong('packed', at, 'has another size than it should');
  return out;
}

function byte(from: Place): number {
  if (from.at >= from.end) throw new Wrong('packed', from.at, 'ends within a block');
  return from.bytes[from.at++] ?? 0;
}

function lengthOf(from: Place, first: number): number {
  let length = first;
  if (first === LONG) {
    let more: number;
    do {
      more = byte(from);
      length += more;
    } while (more === 255);
  }
  return length;
}

/** Fills `out` from `done` on; returns how far. */
function block(from: Place, out: Uint8Array, done: number): number {
  while (from.at < from.end) {
    const token = byte(from);
    const plain = lengthOf(from, token >> 4);
    if (plain > from.end - from.at || plain > out.length - done)
      throw new Wrong('packed', from.at, 'has more than it should');
    out.set(from.bytes.subarray(from.at, from.at + plain), done);
    from.at += plain;
    done += plain;
    if (from.at === from.end) break;
    const back = byte(from) | (byte(from) << 8);
    const length = lengthOf(from, token & LONG) + MATCH_MIN;
    if (back === 0 || back > done || length > out.length - done)
      throw new Wrong('packed', from.at, 'repeats what is not there');
    if (back >= length) out.copyWithin(done, done - back, done - back + length);
    // A repetition of what it makes itself.
    else for (let at = done; at < done + length; at++) out[at] = out[at - back] ?? 0;
    done += length;
  }
  return done;
}
