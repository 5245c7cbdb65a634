import { describe, expect, it } from 'vitest';
import {
  channel,
  chunk,
  example,
  file,
  frame,
  joined,
  line,
  plainFrame,
  record,
  sample,
  schema,
  u32,
  u64,
} from './example';
import { FILE_BYTES_MAX } from '../limits';
import { nodesAt } from './past.svelte';
import { unpacked } from './lz4';
import { read, readNow } from './read';
import { sumOf } from './sum';
import { type RecordingFault, Wrong } from './wrong';

function wrongOf(bytes: Uint8Array): Wrong | undefined {
  try {
    return readNow(bytes).wrong;
  } catch (error) {
    if (error instanceof Wrong) return error;
    throw error;
  }
}

const words = { format: 'u8 a', units: '%', access: 'rw', rest: '0' };
const begin = [schema(1, 'uint8 a'), channel(1, 1, '/m', words)];

describe('a recording of trik record', () => {
  it('has its nodes, their words, and what they gave when', () => {
    const { memory, wrong } = readNow(example());
    expect(wrong).toBeUndefined();
    expect(memory.strange).toBe(0);
    expect([...memory.tracks.keys()].sort()).toEqual(['accelerometer', 'battery', 'motors/M3', 'sensors/A1']);
    const motor = memory.tracks.get('motors/M3');
    expect(motor?.node).toMatchObject({ units: '%', isWritten: true, rest: '0' });
    const { times, values } = motor?.samples('duty_cycle', 0, Infinity) ?? { times: [], values: [] };
    expect(values).toEqual([0, 33]);
    const at = (times[1] ?? 0) - memory.begin;
    expect(at).toBeGreaterThan(0.2);
    expect(at).toBeLessThan(1);
    expect(memory.end - memory.begin).toBeGreaterThan(0.8);
    expect(memory.tracks.get('accelerometer')?.fieldsAt(0)).toHaveProperty('z');
    expect(memory.tracks.get('battery')?.fieldsAt(0)?.voltage).toBeGreaterThan(5);
    expect(memory.lines.every(({ topic }) => topic === '/log')).toBe(true);
  });

  it('that is cut at any byte says where, and what stands before that is there', () => {
    const whole = example();
    const all = readNow(whole).memory.tracks.get('sensors/A1')?.times.length ?? 0;
    let last = 0;
    for (let length = 0; length < whole.length; length++) {
      const cut = whole.subarray(0, length);
      const wrong = wrongOf(cut);
      expect(wrong?.what, `${length} bytes`).toBe(length < 8 ? 'magic' : 'cut');
      expect(wrong?.at).toBeLessThanOrEqual(length);
      if (wrong && length % 500 === 0) {
        try {
          const count = readNow(cut).memory.tracks.get('sensors/A1')?.times.length ?? 0;
          expect(count).toBeGreaterThanOrEqual(last);
          last = count;
        } catch {
          expect(last).toBe(0);
        }
      }
    }
    expect(last).toBeGreaterThan(all / 2);
  }, 60_000);

  it('with a damaged byte is never read as another one', () => {
    const whole = example();
    let summary = whole.length;
    // Where the data end: a record of that kind with a checksum of four bytes.
    const end = [15, 4, 0, 0, 0, 0, 0, 0, 0];
    while (summary > 0 && !end.every((byte, nth) => whole[summary + nth] === byte)) summary--;
    expect(summary).toBeGreaterThan(whole.length / 2);
    for (let place = 0; place < whole.length; place++) {
      const damaged = whole.slice();
      damaged[place] = (damaged[place] ?? 0) ^ (1 << (place % 8));
      const wrong = wrongOf(damaged);
      // What follows the data says it once more, for readers that seek.
      if (!wrong) expect(place).toBeGreaterThan(summary);
      else expect(wrong.at).toBeLessThanOrEqual(whole.length);
    }
  }, 60_000);
});

describe('a recording that is made by hand', () => {
  it('has samples, failures and lines', () => {
    const log = [schema(2, 'x'), channel(2, 2, '/log', {}), channel(3, 2, '/faults', {})];
    const records = [
      sample(1, 10, [7]),
      line(3, 11, '/m', 'gone'),
      line(2, 11.5, 'p', 'says'),
      sample(1, 12, [8]),
    ];
    const { memory } = readNow(file(...begin, ...log, ...records));
    const track = memory.tracks.get('m');
    expect(track?.samples('a', 0, 99)).toEqual({ times: [10, 11, 12], values: [7, NaN, 8] });
    expect(track?.samples('a', 10.5, 11.5)).toEqual({ times: [10, 11], values: [7, NaN] });
    expect(track?.faults.get(1)).toBe('gone');
    expect(track?.fieldsAt(track.placeAt(11.5))).toEqual({ a: 7 });
    expect(memory.lines).toMatchObject([{ topic: '/log', time: 11.5, name: 'p', text: 'says', errno: 5 }]);
  });

  it('begins with the first that happens', () => {
    const other = [channel(2, 1, '/n', words), sample(2, 500, [1])];
    const { memory } = readNow(file(...begin, ...other, sample(1, 501, [1]), line(1, 499.5, 'p', 'says')));
    expect([memory.begin, memory.end]).toEqual([499.5, 501]);
    expect(readNow(file(...begin, ...other)).memory.begin).toBe(500);
  });

  it('has at its beginning what each node gives first, if that comes at once', () => {
    const others = [channel(2, 1, '/n', words), sample(2, 10.0625, [2]), channel(3, 1, '/late', words)];
    const { memory } = readNow(file(...begin, sample(1, 10, [1]), ...others, sample(3, 10.25, [3])));
    let now = 10;
    const nodes = nodesAt(memory, () => now);
    const all = () => ['m', 'n', 'late'].map((path) => nodes.get(path)?.fields?.['a']);
    expect(all()).toEqual([1, 2, undefined]);
    now = 10.3;
    expect(all()).toEqual([1, 2, 3]);
    now = 9;
    expect(nodes.get('late')?.fields).toBeUndefined();
  });

  it('has numbers of all sizes, texts and bytes', () => {
    const type = 'int64 big\nfloat32 half\nuint8[3] raw\nstring word\nbool yes';
    const fields = joined(
      [0, 0, 0, 0],
      [1, 0, 0, 0, 0, 0, 0, 0],
      [0, 0, 0, 63],
      [1, 2, 3, 0],
      u32(3),
      [104, 105, 0],
      [1],
    );
    const named = channel(1, 1, '/n', { format: 'x' });
    const { memory } = readNow(file(schema(1, type), named, sample(1, 1, fields)));
    expect(memory.strange).toBe(0);
    expect(memory.tracks.get('n')?.fieldsAt(0)).toEqual({
      big: 1,
      half: 0.5,
      raw: Uint8Array.of(1, 2, 3),
      word: 'hi',
      yes: 1,
    });
  });

  it('with messages that are too short, or of unknown types, leaves them out', () => {
    const strange = [schema(2, 'Other[] x'), channel(2, 2, '/o', words), sample(2, 1, [1, 2])];
    const { memory } = readNow(
      file(...begin, ...strange, sample(1, 1, []), sample(1, 2, [5]), sample(9, 3, [5])),
    );
    expect([...memory.tracks.keys()]).toEqual(['m']);
    expect(memory.strange).toBe(1);
    expect(memory.tracks.get('m')?.times.length).toBe(1);
  });
});

describe('what is refused', () => {
  const data = joined(...begin, sample(1, 1, [5]));
  const sum = sumOf(data);
  const whole = plainFrame(data);
  const cases: [string, Uint8Array, RecordingFault | undefined][] = [
    ['nothing', new Uint8Array(), 'magic'],
    ['another file', new Uint8Array(100).fill(65), 'magic'],
    ['a chunk as it should be', file(chunk('lz4', whole, data.length, sum)), undefined],
    ['a chunk without compression', file(chunk('', data, data.length, sum)), undefined],
    ['zstd', file(chunk('zstd', whole, data.length, sum)), 'compression'],
    ['a wrong checksum', file(chunk('lz4', whole, data.length, sum ^ 1)), 'checksum'],
    ['a chunk of 4 GiB', file(chunk('lz4', whole, 2 ** 32, sum)), 'giant'],
    ['a chunk of 2^63 bytes', file(chunk('lz4', whole, 2 ** 63, sum)), 'giant'],
    ['a chunk that grows too much', file(chunk('lz4', whole, 15 << 20, sum)), 'giant'],
    ['a chunk that is shorter than it says', file(chunk('lz4', whole, data.length + 1, 0)), 'packed'],
    ['a chunk that is longer than it says', file(chunk('lz4', whole, data.length - 1, 0)), 'packed'],
    ['no frame', file(chunk('lz4', data, data.length, sum)), 'packed'],
    ['a record that is longer than the file', joined(file(data).subarray(0, 8), [5], u64(2 ** 60)), 'cut'],
    ['a record of no kind', file(record(0)), 'record'],
    ['a channel without its words', file(record(4, [1, 0])), 'record'],
    ['bytes after the end', joined(file(data), [1]), 'record'],
    ['no values', file(), 'empty'],
  ];
  it.each(cases)('%s', (_, bytes, what) => {
    expect(wrongOf(bytes)?.what).toBe(what);
  });

  it('a file that is too large, before it is read', async () => {
    await expect(read({ length: FILE_BYTES_MAX + 1 } as Uint8Array, () => true)).rejects.toMatchObject({
      what: 'large',
    });
  });

  it('more values than there is room for', () => {
    // Each is nine MiB of one letter.
    const big = (letter: number) =>
      long(glued(Uint8Array.from(u32(9 << 20)), new Uint8Array(9 << 20).fill(letter)));
    const before = file(schema(1, 'string word'), channel(1, 1, '/n', { format: 'text 9' }));
    const bytes = glued(before.subarray(0, -END_BYTES), big(65), big(66), big(67), big(68));
    const wrong = wrongOf(bytes);
    expect(wrong?.what).toBe('much');
    expect(wrong?.at).toBeGreaterThan(0);
  }, 60_000);

  it('reading is given up when nobody wants it', async () => {
    expect(await read(example(), () => false)).toBeUndefined();
    expect((await read(example(), () => true))?.wrong).toBeUndefined();
  });
});

/** What follows the data. */
const END_BYTES = 13 + 29 + 8;

/** The same as `sample`, for many bytes. */
function long(fields: Uint8Array): Uint8Array {
  const small = sample(1, 1, []);
  const bytes = new Uint8Array(small.length + fields.length);
  bytes.set(small);
  bytes.set(fields, small.length);
  bytes.set(u64(bytes.length - 9), 1);
  return bytes;
}

function glued(...parts: Uint8Array[]): Uint8Array {
  const bytes = new Uint8Array(parts.reduce((sum, part) => sum + part.length, 0));
  let at = 0;
  for (const part of parts) {
    bytes.set(part, at);
    at += part.length;
  }
  return bytes;
}

describe('frames of lz4', () => {
  it('repeat what was there, also what they make themselves', () => {
    // "ab", then 8 bytes from 2 back, then "c".
    const block = [0x24, 97, 98, 2, 0, 0x10, 99];
    const bytes = frame(joined(u32(block.length), block));
    expect(new TextDecoder().decode(unpacked(bytes, 11))).toBe('ababababab' + 'c');
  });

  it('are refused if they repeat what is not there, or end anywhere', () => {
    const block = [0x24, 97, 98, 3, 0, 0x10, 99];
    expect(() => unpacked(frame(joined(u32(block.length), block)), 11)).toThrow(Wrong);
    const good = frame(joined(u32(7), [0x24, 97, 98, 2, 0, 0x10, 99]));
    for (let length = 0; length < good.length; length++)
      expect(() => unpacked(good.subarray(0, length), 11), `${length}`).toThrow(Wrong);
    for (const size of [0, 10, 12]) expect(() => unpacked(good, size)).toThrow(Wrong);
  });

  it('of random bytes end', () => {
    let seed = 1;
    const random = () => (seed = (seed * 48271) % 2147483647) & 255;
    for (let at = 0; at < 2000; at++) {
      const block = Array.from({ length: 40 }, random);
      try {
        unpacked(frame(joined(u32(block.length), block)), 200);
      } catch (error) {
        expect(error).toBeInstanceOf(Wrong);
      }
    }
  });
});
