// A recording as it comes: bytes in pieces, nodes, samples, failures and lines out.
//
// Owns the live form, and the words of a channel, which files have too: MCAP with messages in CDR. What is made of it is known
// to `robot`; whole files are read in `past`.

import { parse } from '@foxglove/rosmsg';
import { MessageReader } from '@foxglove/rosmsg2-serialization';
import { McapStreamReader } from '@mcap/core';

/** What is known of a node. */
export interface Node {
  path: string;
  /** As the tree has it: `i8 power` and the like. */
  format: string;
  units: string;
  about: string;
  /** Its other paths, such as the name of what is plugged in. */
  aliases: string[];
  isWritten: boolean;
  /** What brings it to rest; empty if it needs nothing. */
  rest: string;
}

/** A number, a word, or bytes of one sample, by its name. */
export type Fields = Record<string, number | bigint | boolean | string | Uint8Array>;

/** A line about something: of the log, of a program, of a failure. */
export interface Line {
  topic: string;
  time: number;
  level: number;
  name: string;
  text: string;
  errno: number;
}

/** Who takes what is in a recording. Times are seconds since 1970. */
export interface Taker {
  node(node: Node): void;
  sample(path: string, time: number, fields: Fields): void;
  line(line: Line): void;
  facts(name: string, facts: ReadonlyMap<string, string>): void;
}

interface Log {
  level: number;
  name: string;
  msg: string;
  line: number;
}

interface Channel {
  topic: string;
  node: Node | undefined;
  reader: MessageReader;
}

/** Fields of a message that are not of the sample. */
const BESIDE = new Set(['header', 'sequence']);
const LINES = new Set(['/log', '/faults', '/programs', '/output', '/mail', '/diagram']);

/** Whether a topic has lines. */
export function isLines(topic: string): boolean {
  return LINES.has(topic);
}

/** The node of a channel, by the words beside it; undefined if it is none. */
export function nodeOf(topic: string, words: ReadonlyMap<string, string>): Node | undefined {
  const format = words.get('format');
  if (format === undefined) return undefined;
  return {
    // A node with a name of something else has a topic apart from it.
    path: words.get('path') ?? topic.slice(1),
    format,
    units: words.get('units') ?? '',
    about: words.get('about') ?? '',
    aliases: (words.get('aliases') ?? '').split('\n').filter((alias) => alias !== ''),
    isWritten: (words.get('access') ?? '').includes('w'),
    rest: words.get('rest') ?? '',
  };
}

export class Recording {
  #reader = new McapStreamReader();
  readonly #schemas = new Map<number, string>();
  readonly #channels = new Map<number, Channel>();
  /** Paths of nodes by the names that failures have. */
  readonly #paths = new Map<string, string>();

  constructor(private readonly taker: Taker) {}

  /** The next piece. An error: it is no recording, and nothing more comes out of it. */
  put(bytes: Uint8Array): void {
    this.#reader.append(bytes);
    for (let record = this.#reader.nextRecord(); record; record = this.#reader.nextRecord()) {
      switch (record.type) {
        case 'Schema':
          this.#schemas.set(record.id, new TextDecoder().decode(record.data));
          break;
        case 'Channel':
          this.#open(record.id, record.schemaId, record.topic, record.metadata);
          break;
        case 'Message':
          this.#message(record.channelId, Number(record.publishTime) / 1e9, record.data);
          break;
        case 'Metadata':
          this.taker.facts(record.name, record.metadata);
          break;
        default:
      }
    }
  }

  #open(id: number, schema: number, topic: string, words: ReadonlyMap<string, string>): void {
    const text = this.#schemas.get(schema);
    if (text === undefined || this.#channels.has(id)) return;
    const node = nodeOf(topic, words);
    if (!node && !isLines(topic)) return;
    this.#channels.set(id, { topic, node, reader: new MessageReader(parse(text, { ros2: true })) });
    if (!node) return;
    this.#paths.set(topic.slice(1), node.path);
    this.taker.node(node);
  }

  #message(id: number, time: number, data: Uint8Array): void {
    const channel = this.#channels.get(id);
    if (!channel) return;
    if (channel.node) {
      const message = channel.reader.readMessage<Fields>(data);
      const fields = Object.entries(message).filter(([name]) => !BESIDE.has(name));
      this.taker.sample(channel.node.path, time, Object.fromEntries(fields));
    } else {
      const log = channel.reader.readMessage<Log>(data);
      const { level, msg: text, line: errno } = log;
      const name = (channel.topic === '/faults' ? this.#paths.get(log.name) : undefined) ?? log.name;
      this.taker.line({ topic: channel.topic, time, level, name, text, errno });
    }
  }
}
