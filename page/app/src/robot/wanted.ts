// Nodes that are sampled only while this page shows them.
//
// Owns a second connection, which is there while something is wanted: over one connection one recording comes at a time. What
// comes of these nodes is known to `robot`.

import { WANTED_PATHS_MAX } from '../limits';
import { Link } from '../link/link';
import { type Fields, type Line, type Node, Recording } from './recording';

/** How many pictures in a second come at most. */
const RATE_HZ = 10;
const STREAM = 'stream:';

/** Who takes what was wanted. */
interface Taker {
  node(node: Node): void;
  sample(path: string, time: number, fields: Fields): void;
  line(line: Line): void;
}

/** The request for some nodes; a path with a sign that a request gives a meaning to cannot be asked for. */
export function request(paths: Iterable<string>): string {
  const plain = [...paths].filter((path) => !/[,;*]/.test(path)).slice(0, WANTED_PATHS_MAX);
  return plain.length === 0 ? '' : `${STREAM}${plain.join(',')};hz=${RATE_HZ}`;
}

export class Wanted {
  /** How many show each path. */
  readonly #paths = new Map<string, number>();
  #link: Link | undefined;
  #asked = '';
  #isDue = false;

  constructor(
    private readonly address: string,
    private readonly taker: Taker,
  ) {}

  has(path: string): boolean {
    return this.#paths.has(path);
  }

  /** Returns what ends it. */
  add(path: string): () => void {
    this.#paths.set(path, (this.#paths.get(path) ?? 0) + 1);
    this.#change();
    let isOver = false;
    return () => {
      if (isOver) return;
      isOver = true;
      const left = (this.#paths.get(path) ?? 1) - 1;
      if (left > 0) this.#paths.set(path, left);
      else this.#paths.delete(path);
      this.#change();
    };
  }

  /** Several that come and go at once make one new connection. */
  #change(): void {
    if (this.#isDue) return;
    this.#isDue = true;
    queueMicrotask(() => {
      this.#isDue = false;
      const asked = request(this.#paths.keys());
      if (asked === this.#asked) return;
      this.#asked = asked;
      this.#link?.close();
      this.#link = asked === '' ? undefined : this.#open(asked);
    });
  }

  #open(asked: string): Link {
    const paths = new Set(this.#paths.keys());
    const { taker } = this;
    const heard = {
      node: (node: Node) => taker.node(node),
      sample: (path: string, time: number, fields: Fields) => taker.sample(path, time, fields),
      // Of failures alone, as all other lines come over the first connection as well.
      line: (line: Line) => {
        if (line.topic === '/faults' && paths.has(line.name.replace(/^\//, ''))) taker.line(line);
      },
      facts: () => undefined,
    };
    let recording = new Recording(heard);
    const decoder = new TextDecoder();
    const link: Link = new Link(this.address, {
      connected: () => undefined,
      news: (news) => {
        if (news.is !== 'robot' || !news.there) return;
        recording = new Recording(heard);
        link.request(asked);
      },
      message: (bytes) => {
        if (decoder.decode(bytes.subarray(0, STREAM.length)) === STREAM)
          recording.put(bytes.subarray(STREAM.length));
      },
    });
    return link;
  }
}
