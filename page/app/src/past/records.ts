// The records of a recording that is a whole file: MCAP, https://mcap.dev/spec.
//
// Owns their frames, chunks and checksums, and where something is wrong. What messages mean is known to who takes them. The
// live form is read elsewhere, because it comes in pieces and has no chunks.

import {
  INFLATED_BYTES_MAX,
  INFLATION_MAX,
  RECORD_BYTES_MAX,
  SCENE_BYTES_MAX,
  ATTACHED_WORDS_BYTES,
} from '../limits';
import { unpacked } from './lz4';
import { sumOf } from './sum';
import { type RecordingFault, Wrong } from './wrong';

/** Takes what is in a recording. Times are seconds since 1970. */
export interface Sink {
  schema(id: number, text: Uint8Array): void;
  channel(id: number, schema: number, topic: string, words: ReadonlyMap<string, string>): void;
  message(channel: number, time: number, data: Uint8Array): void;
  /** Something that goes with the recording. */
  attachment(name: string, time: number, data: Uint8Array): void;
}

const MAGIC = [0x89, 0x4d, 0x43, 0x41, 0x50, 0x30, 0x0d, 0x0a];
const FOOTER = 0x02;
const SCHEMA = 0x03;
const CHANNEL = 0x04;
const MESSAGE = 0x05;
const CHUNK = 0x06;
const ATTACHMENT = 0x09;
const DATA_END = 0x0f;
/** A kind and a length. */
const HEAD_BYTES = 9;

const text = new TextDecoder();

/** Values one after the other, of which there are so many bytes. */
class Reader {
  at = 0;
  readonly #view: DataView;

  constructor(
    readonly bytes: Uint8Array,
    /** The byte of the file that a person is told. */
    private readonly place: number,
  ) {
    this.#view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  }

  get left(): number {
    return this.bytes.length - this.at;
  }

  #take(count: number): number {
    if (count > this.left) throw new Wrong('record', this.place);
    this.at += count;
    return this.at - count;
  }

  u8(): number {
    return this.#view.getUint8(this.#take(1));
  }

  u16(): number {
    return this.#view.getUint16(this.#take(2), true);
  }

  u32(): number {
    return this.#view.getUint32(this.#take(4), true);
  }

  /** As near as a number comes; lengths that it cannot express are too long anyway. */
  u64(): number {
    const low = this.u32();
    return this.u32() * 2 ** 32 + low;
  }

  take(count: number): Uint8Array {
    const begin = this.#take(count);
    return this.bytes.subarray(begin, begin + count);
  }

  text(): string {
    return text.decode(this.take(this.u32()));
  }

  map(): Map<string, string> {
    const inside = new Reader(this.take(this.u32()), this.place);
    const map = new Map<string, string>();
    while (inside.left > 0) map.set(inside.text(), inside.text());
    return map;
  }
}

/** Goes through a recording, a record at each step. */
export class Walk {
  #at = 0;
  #isEnded = false;
  #sum = 0;
  #inflated = 0;

  constructor(
    private readonly bytes: Uint8Array,
    private readonly sink: Sink,
  ) {}

  /** The bytes that were read. */
  get at(): number {
    return this.#at;
  }

  /** The next record. False: there is none, and the recording is whole. */
  step(): boolean {
    if (this.#at === 0) {
      this.#magic(0, 'magic');
      return true;
    }
    const begin = this.#at;
    const left = this.bytes.length - begin;
    if (left < HEAD_BYTES) throw new Wrong('cut', begin);
    const head = new Reader(this.bytes.subarray(begin, begin + HEAD_BYTES), begin);
    const kind = head.u8();
    const length = head.u64();
    if (kind === 0) throw new Wrong('record', begin);
    if (length > left - HEAD_BYTES) throw new Wrong('cut', begin);
    // What is attached is passed over, however large.
    if (length > RECORD_BYTES_MAX && kind !== ATTACHMENT) throw new Wrong('giant', begin);
    const whole = this.bytes.subarray(begin, begin + HEAD_BYTES + length);
    this.#at += whole.length;
    if (!this.#isEnded) this.#record(kind, whole, begin);
    if (kind !== FOOTER) return true;
    this.#magic(this.#at, this.bytes.length - this.#at < MAGIC.length ? 'cut' : 'record');
    if (this.#at !== this.bytes.length || !this.#isEnded) throw new Wrong('record', begin);
    return false;
  }

  #magic(at: number, what: RecordingFault): void {
    if (MAGIC.some((byte, nth) => this.bytes[at + nth] !== byte)) throw new Wrong(what, at);
    this.#at = at + MAGIC.length;
    this.#sum = sumOf(this.bytes.subarray(at, this.#at), this.#sum);
  }

  #record(kind: number, whole: Uint8Array, begin: number): void {
    const content = new Reader(whole.subarray(HEAD_BYTES), begin);
    if (kind === DATA_END) {
      const sum = content.u32();
      if (sum !== 0 && sum !== this.#sum) throw new Wrong('checksum', begin);
      // What follows says once more what was said.
      this.#isEnded = true;
      return;
    }
    this.#sum = sumOf(whole, this.#sum);
    if (kind === CHUNK) this.#chunk(content, begin);
    else if (kind === ATTACHMENT) this.#attachment(content);
    else this.#message(kind, content);
  }

  #attachment(content: Reader): void {
    // What is longer is nothing that the page knows.
    if (content.left > SCENE_BYTES_MAX + ATTACHED_WORDS_BYTES) return;
    const time = content.u64() / 1e9;
    // When it was made.
    content.take(8);
    const name = content.text();
    // Its type.
    content.text();
    this.sink.attachment(name, time, content.take(content.u64()));
  }

  #chunk(content: Reader, begin: number): void {
    // The first and the last time.
    content.take(16);
    const size = content.u64();
    const sum = content.u32();
    const compression = content.text();
    const length = content.u64();
    const packed = content.take(length);
    if (size > RECORD_BYTES_MAX || size > length * INFLATION_MAX + 1024) throw new Wrong('giant', begin);
    this.#inflated += size;
    if (this.#inflated > INFLATED_BYTES_MAX) throw new Wrong('much', begin);
    const data = this.#unpacked(compression, packed, size, begin);
    if (sum !== 0 && sum !== sumOf(data)) throw new Wrong('checksum', begin);
    const inside = new Reader(data, begin);
    while (inside.left > 0) {
      const kind = inside.u8();
      this.#message(kind, new Reader(inside.take(inside.u64()), begin));
    }
  }

  #unpacked(compression: string, packed: Uint8Array, size: number, begin: number): Uint8Array {
    if (compression === '' && packed.length === size) return packed;
    if (compression === '') throw new Wrong('record', begin);
    if (compression !== 'lz4') throw new Wrong('compression', begin, compression.slice(0, 20));
    try {
      return unpacked(packed, size);
    } catch (error) {
      throw error instanceof Wrong ? new Wrong('packed', begin, error.detail) : error;
    }
  }

  #message(kind: number, content: Reader): void {
    switch (kind) {
      case SCHEMA: {
        const id = content.u16();
        content.text();
        content.text();
        this.sink.schema(id, content.take(content.u32()));
        break;
      }
      case CHANNEL: {
        const id = content.u16();
        const schema = content.u16();
        const topic = content.text();
        content.text();
        this.sink.channel(id, schema, topic, content.map());
        break;
      }
      case MESSAGE: {
        const channel = content.u16();
        // Its number.
        content.u32();
        const time = content.u64() / 1e9;
        // When it was published.
        content.take(8);
        this.sink.message(channel, time, content.take(content.left));
        break;
      }
      default:
      // Unknown ones are passed over, as the format demands.
    }
  }
}
