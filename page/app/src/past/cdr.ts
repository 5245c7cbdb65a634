// Messages of nodes and lines: CDR, little endian, without names; the text of their type says what is in them.
//
// Owns the few shapes that recordings of a tree have: numbers, one text, or bytes of a known number. Other types have no shape
// here, and are not shown. Reading believes nothing.

import { SCHEMA_FIELDS_MAX } from '../limits';

/** One field of a message. */
export interface Part {
  name: string;
  kind: 'text' | 'bytes' | Kind;
  /** How many bytes, if it is bytes. */
  size: number;
}

type Kind = keyof typeof NUMBERS;

const NUMBERS = {
  bool: [1, (view: DataView, at: number) => view.getUint8(at)],
  int8: [1, (view: DataView, at: number) => view.getInt8(at)],
  uint8: [1, (view: DataView, at: number) => view.getUint8(at)],
  int16: [2, (view: DataView, at: number) => view.getInt16(at, true)],
  uint16: [2, (view: DataView, at: number) => view.getUint16(at, true)],
  int32: [4, (view: DataView, at: number) => view.getInt32(at, true)],
  uint32: [4, (view: DataView, at: number) => view.getUint32(at, true)],
  // A number of a script: beyond 2^53 the nearest that it can express.
  int64: [8, (view: DataView, at: number) => Number(view.getBigInt64(at, true))],
  uint64: [8, (view: DataView, at: number) => Number(view.getBigUint64(at, true))],
  float32: [4, (view: DataView, at: number) => view.getFloat32(at, true)],
  float64: [8, (view: DataView, at: number) => view.getFloat64(at, true)],
} as const satisfies Record<string, readonly [number, (view: DataView, at: number) => number]>;

/** Of a type that is made from a format, before the fields of the format. */
const BEFORE = ['std_msgs/Header header', 'uint32 sequence'];
const HEAD_BYTES = 4;

/** What a message of a node has; undefined if that is no type of a node. */
export function partsOf(schema: string): Part[] | undefined {
  const [type = ''] = schema.split(/^=+$/m, 1);
  const lines = type.split('\n', SCHEMA_FIELDS_MAX + BEFORE.length + 1).filter((line) => line.trim() !== '');
  if (BEFORE.some((line, at) => lines[at] !== line) || lines.length > SCHEMA_FIELDS_MAX + BEFORE.length)
    return undefined;
  const parts: Part[] = [];
  for (const line of lines.slice(BEFORE.length)) {
    const [, kind = '', size, name = ''] =
      /^([a-z0-9]+)(?:\[(\d{1,8})\])? ([a-z][a-z0-9_]*)$/.exec(line) ?? [];
    if (kind === 'uint8' && size !== undefined) parts.push({ name, kind: 'bytes', size: Number(size) });
    else if (size !== undefined) return undefined;
    else if (kind === 'string') parts.push({ name, kind: 'text', size: 0 });
    else if (Object.hasOwn(NUMBERS, kind)) parts.push({ name, kind: kind as Kind, size: 0 });
    else return undefined;
  }
  return parts;
}

/** Goes through a message; undefined is what a message gives that is too short. */
export class Message {
  #at = HEAD_BYTES;
  readonly #view: DataView;

  constructor(private readonly bytes: Uint8Array) {
    this.#view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  }

  /** A message of a node begins so. */
  skipBefore(): boolean {
    return (
      this.number('int32') !== undefined &&
      this.number('uint32') !== undefined &&
      this.text() !== undefined &&
      this.number('uint32') !== undefined
    );
  }

  number(kind: Kind): number | undefined {
    const [size, read] = NUMBERS[kind];
    const at = HEAD_BYTES + Math.ceil((this.#at - HEAD_BYTES) / size) * size;
    if (at + size > this.bytes.length) return undefined;
    this.#at = at + size;
    return read(this.#view, at);
  }

  take(count: number): Uint8Array | undefined {
    if (count > this.bytes.length - this.#at) return undefined;
    this.#at += count;
    return this.bytes.subarray(this.#at - count, this.#at);
  }

  text(): string | undefined {
    const length = this.number('uint32');
    const bytes = length === undefined ? undefined : this.take(length);
    // With the zero that ends it.
    return bytes && decoder.decode(bytes.at(-1) === 0 ? bytes.subarray(0, -1) : bytes);
  }
}

const decoder = new TextDecoder();
