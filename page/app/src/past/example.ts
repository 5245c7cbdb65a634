// Recordings for tests: a real one, and ones that are made here, whole or wrong.

import { sumOf } from './sum';
import real from './example.mcap?inline';

/** What `trik record` wrote in a second: four nodes, and M3 gets 33 after half of it. */
export function example(): Uint8Array<ArrayBuffer> {
  const letters = atob(real.slice(real.indexOf(',') + 1));
  return Uint8Array.from(letters, (letter) => letter.charCodeAt(0));
}

const MAGIC = [0x89, 0x4d, 0x43, 0x41, 0x50, 0x30, 0x0d, 0x0a];
const encoder = new TextEncoder();

export function joined(...parts: (Uint8Array | number[])[]): Uint8Array<ArrayBuffer> {
  return Uint8Array.from(parts.flatMap((part) => [...part]));
}

export function u16(value: number): number[] {
  return [value & 255, value >> 8];
}

export function u32(value: number): number[] {
  return [...u16(value & 0xffff), ...u16(value >>> 16)];
}

export function u64(value: number): number[] {
  return [...u32(value % 2 ** 32), ...u32(Math.floor(value / 2 ** 32))];
}

export function text(words: string): Uint8Array {
  const bytes = encoder.encode(words);
  return joined(u32(bytes.length), bytes);
}

export function record(kind: number, ...parts: (Uint8Array | number[])[]): Uint8Array {
  const content = joined(...parts);
  return joined([kind], u64(content.length), content);
}

export function schema(id: number, fields: string): Uint8Array {
  const type = encoder.encode(
    `std_msgs/Header header\nuint32 sequence\n${fields}\n====\nMSG: std_msgs/Header\n`,
  );
  return record(3, u16(id), text('trik_msgs/msg/A'), text('ros2msg'), u32(type.length), type);
}

export function channel(id: number, of: number, topic: string, words: Record<string, string>): Uint8Array {
  const map = joined(...Object.entries(words).flatMap((pair) => pair.map(text)));
  return record(4, u16(id), u16(of), text(topic), text('cdr'), u32(map.length), map);
}

/** A message of a node; its fields begin four bytes after a multiple of eight. */
export function sample(id: number, time: number, fields: Uint8Array | number[]): Uint8Array {
  const head = [0, 1, 0, 0, ...u32(0), ...u32(0), ...u32(1), 0, 0, 0, 0, ...u32(1)];
  return record(5, u16(id), u32(1), u64(time * 1e9), u64(time * 1e9), head, fields);
}

/** A line of a log. */
export function line(id: number, time: number, name: string, words: string): Uint8Array {
  const out = [0, 1, 0, 0, ...u32(0), ...u32(0), 20];
  const aligned = () => {
    while (out.length % 4 !== 0) out.push(0);
  };
  for (const part of [name, words, '', '']) {
    aligned();
    const bytes = encoder.encode(`${part}\0`);
    out.push(...u32(bytes.length), ...bytes);
  }
  aligned();
  out.push(...u32(5));
  return record(5, u16(id), u32(1), u64(time * 1e9), u64(time * 1e9), out);
}

export function chunk(compression: string, packed: Uint8Array, size: number, sum: number): Uint8Array {
  return record(6, u64(0), u64(0), u64(size), u32(sum), text(compression), u64(packed.length), packed);
}

/** Bytes as a frame of lz4 that is compressed by nothing. */
export function plainFrame(bytes: Uint8Array): Uint8Array {
  return frame(joined(u32(bytes.length + 2 ** 31), bytes));
}

export function frame(...blocks: Uint8Array[]): Uint8Array {
  return joined([0x04, 0x22, 0x4d, 0x18, 0x40, 0x40, 0xc0], ...blocks, u32(0));
}

/** A whole file of these records. */
export function file(...records: Uint8Array[]): Uint8Array<ArrayBuffer> {
  const begin = joined(MAGIC, record(1, text('ros2'), text('test')), ...records);
  return joined(begin, record(15, u32(sumOf(begin))), record(2, u64(0), u64(0), u32(0)), MAGIC);
}
