// A recording as this page keeps it: its nodes with all that they gave, and its lines.
//
// Owns which topics count, and how much is kept. Knows no files and no moment that is shown.

import {
  CHANNELS_MAX,
  NUMBERS_MAX,
  SCENES_MAX,
  SCHEMA_BYTES_MAX,
  TEXT_BYTES_MAX,
  TEXT_COST,
} from '../limits';
import { isLines, type Line, nodeOf } from '../robot/recording';
import { Message, type Part, partsOf } from './cdr';
import type { Sink } from './records';
import { Track } from './track';
import { Wrong } from './wrong';

const FAULTS = '/faults';
const DIAGRAM = '/diagram';
/** Where things are; it is no line for a person. */
const WORLD = '/world';
/** What stands still, as a file beside the recording. */
const SCENE = 'world.json';

export class Memory implements Sink {
  /** By their paths. */
  readonly tracks = new Map<string, Track>();
  /** Without failures and diagrams, in the order of their times. */
  readonly lines: Line[] = [];
  /** Where diagrams were. */
  readonly steps: Line[] = [];
  /** Where the robots and the things of a virtual world were. */
  readonly places: Line[] = [];
  /** What stood still in it. */
  readonly scenes: { time: number; text: string }[] = [];
  /** Messages that are not as their type says. */
  strange = 0;
  readonly #room = { numbers: NUMBERS_MAX, textBytes: TEXT_BYTES_MAX };
  readonly #schemas = new Map<number, readonly Part[] | 'none'>();
  /** Paths of nodes by the names that failures have. */
  readonly #paths = new Map<string, string>();
  readonly #channels = new Map<number, Track | string>();
  #first = Infinity;
  #last = -Infinity;

  /** When it begins, in seconds since 1970. */
  get begin(): number {
    const begin = Math.min(this.#first, this.lines[0]?.time ?? Infinity);
    return Number.isFinite(begin) ? begin : 0;
  }

  get end(): number {
    return Number.isFinite(this.#last) ? this.#last : (this.lines.at(-1)?.time ?? 0);
  }

  get isEmpty(): boolean {
    return !Number.isFinite(this.#first) && this.lines.length === 0;
  }

  schema(id: number, text: Uint8Array): void {
    if (this.#schemas.has(id) || this.#schemas.size >= CHANNELS_MAX) return;
    const isShort = text.length <= SCHEMA_BYTES_MAX;
    this.#schemas.set(id, (isShort && partsOf(new TextDecoder().decode(text))) || 'none');
  }

  channel(id: number, schema: number, topic: string, words: ReadonlyMap<string, string>): void {
    if (this.#channels.has(id) || this.#channels.size >= CHANNELS_MAX) return;
    const node = nodeOf(topic, words);
    const parts = this.#schemas.get(schema);
    if (node && parts && parts !== 'none') {
      // A later format is another node of the same path, which is the one that is shown.
      const track = new Track(node, parts, this.#room);
      this.#spend([topic, ...words.values()].join('').length);
      this.tracks.set(node.path, track);
      this.#paths.set(topic.slice(1), node.path);
      this.#channels.set(id, track);
    } else if (!node && (isLines(topic) || topic === WORLD)) {
      this.#channels.set(id, topic);
    }
  }

  message(id: number, time: number, data: Uint8Array): void {
    const channel = this.#channels.get(id);
    if (channel === undefined) return;
    if (typeof channel === 'string') {
      this.#line(channel, time, data);
    } else if (channel.sample(time, data)) {
      this.#count(time);
    } else {
      this.strange++;
    }
    this.#spend(0);
  }

  attachment(name: string, time: number, data: Uint8Array): void {
    if (name !== SCENE || this.scenes.length >= SCENES_MAX) return;
    const text = new TextDecoder().decode(data);
    this.scenes.push({ time, text });
    this.#spend(text.length + TEXT_COST);
  }

  /** Lines come in their order, apart from some that waited for each other. */
  sort(): void {
    this.scenes.sort((one, other) => one.time - other.time);
    for (const lines of [this.lines, this.steps, this.places])
      lines.sort((one, other) => one.time - other.time);
  }

  #count(time: number): void {
    this.#first = Math.min(this.#first, time);
    this.#last = Math.max(this.#last, time);
  }

  #spend(letters: number): void {
    this.#room.textBytes -= letters * 2;
    if (this.#room.numbers < 0 || this.#room.textBytes < 0) throw new Wrong('much', 0);
  }

  #line(topic: string, time: number, data: Uint8Array): void {
    const message = new Message(data);
    message.number('int32');
    message.number('uint32');
    const level = message.number('uint8');
    const [name, text] = [message.text(), message.text()];
    message.text();
    message.text();
    const errno = message.number('uint32');
    if (level === undefined || name === undefined || text === undefined || errno === undefined) {
      this.strange++;
    } else if (topic === FAULTS) {
      const said = name.replace(/^\//, '');
      this.tracks.get(this.#paths.get(said) ?? said)?.fault(time, text);
      this.#count(time);
    } else {
      const lines = topic === DIAGRAM ? this.steps : topic === WORLD ? this.places : this.lines;
      lines.push({ topic, time, level, name, text, errno });
      this.#spend(name.length + text.length + TEXT_COST);
    }
  }
}
