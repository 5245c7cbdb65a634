// The inside of one node: the tuples of its samples on their way through its converters, and the numbers of these.
//
// Owns which node is looked into, what came of it in the last time, and which numbers a person has turned, to take that back.
// Knows no converter and no drawing.

import type { Link } from '../link/link';
import { CHAIN_MAX, TURNS_MAX } from '../limits';

/** A number of a node's converters; a side of its range without a limit is null. */
export interface Param {
  name: string;
  value: number;
  min: number | null;
  max: number | null;
}

/** A node with converters or numbers for them. */
export interface Inner {
  path: string;
  format: string;
  units: string;
  stages: boolean;
  params: Param[];
}

/** The tuples of one sample, in hexadecimal: that of the source first. */
export interface Passage {
  at_s: number;
  tuples: string[];
}

/** A number that was turned. */
interface Turn {
  path: string;
  name: string;
  before: number;
  at_ms: number;
  /** It was written, not slid to. */
  isTyped: boolean;
}

/** Samples that are kept: half a minute of them, sixty times a second. */
const PASSAGES = 1800;
/** Turns of one number that follow each other so soon are one. */
const ONE_TURN_MS = 1000;

export class Inside {
  nodes = $state.raw<Inner[]>([]);
  /** The node that is looked into; empty: none. */
  path = $state('');
  /** Why a number was not taken, by its name. */
  wrong = $state.raw<Record<string, string>>({});
  /** How often something was turned that can be taken back. */
  turned = $state(0);
  /** The samples of the last time, the oldest first: many in a second, so no state of components. */
  passages: Passage[] = [];
  readonly #turns: Turn[] = [];

  constructor(private readonly link: Link) {}

  /** Reads which nodes there are. */
  async read(): Promise<void> {
    try {
      const answer = await fetch('/converters');
      if (!answer.ok) return;
      this.nodes = (await answer.json()) as Inner[];
    } catch {
      // The server is gone; the link says so.
    }
  }

  /** The node that is looked into; undefined: it is not there. */
  get node(): Inner | undefined {
    return this.nodes.find(({ path }) => path === this.path);
  }

  /** Looks into a node from now on, or into none. */
  choose(path: string): void {
    if (path !== this.path) {
      this.path = path;
      this.passages = [];
      this.wrong = {};
    }
    this.link.order({ do: 'inspect', path: path === '' ? null : path });
  }

  /** What was chosen stays so, and nothing comes of it meanwhile. */
  rest(): void {
    this.link.order({ do: 'inspect', path: null });
  }

  /** The server tells of a sample. */
  heard(path: string, at_s: number, tuples: string[]): void {
    if (path !== this.path || tuples.length === 0) return;
    // A clock that was set back: what is older makes no sense any more.
    if (at_s < (this.passages.at(-1)?.at_s ?? 0)) this.passages = [];
    this.passages.push({ at_s, tuples: tuples.slice(0, CHAIN_MAX + 1) });
    if (this.passages.length > PASSAGES) this.passages.splice(0, this.passages.length - PASSAGES);
  }

  /** Gives a number of the node another value; what is slid to in one go is one turn. */
  turn(name: string, value: number, isTyped = false): void {
    const param = this.node?.params.find((one) => one.name === name);
    if (!param || !Number.isFinite(value) || value === param.value) return;
    const { path } = this;
    const last = this.#turns.at(-1);
    const now = performance.now();
    const isSame = !isTyped && !last?.isTyped && last?.path === path && last.name === name;
    if (last && isSame && now - last.at_ms < ONE_TURN_MS) last.at_ms = now;
    else this.#turns.push({ path, name, before: param.value, at_ms: now, isTyped });
    if (this.#turns.length > TURNS_MAX) this.#turns.shift();
    this.turned = this.#turns.length;
    this.#set(path, name, value);
  }

  /** Takes the last turn back. */
  undo(): void {
    const turn = this.#turns.pop();
    this.turned = this.#turns.length;
    if (!turn) return;
    this.choose(turn.path);
    this.#set(turn.path, turn.name, turn.before);
  }

  #set(path: string, name: string, value: number): void {
    this.#show(path, name, value);
    this.link.order({ do: 'write', path, param: name, value: String(value) });
  }

  #show(path: string, name: string, value: number): void {
    const changed = (param: Param) => (param.name === name ? { ...param, value } : param);
    this.nodes = this.nodes.map((node) =>
      node.path === path ? { ...node, params: node.params.map(changed) } : node,
    );
  }

  /** The filesystem has taken a number, or not. */
  written(path: string, name: string, why: string | null): void {
    if (path !== this.path) return;
    const others = Object.fromEntries(Object.entries(this.wrong).filter(([other]) => other !== name));
    this.wrong = why === null ? others : { ...others, [name]: why };
    if (why === null) return;
    // It goes on with the one before, and there is nothing to take back.
    const last = this.#turns.at(-1);
    if (last?.isTyped && last.path === path && last.name === name) this.#turns.pop();
    this.turned = this.#turns.length;
    void this.read();
  }

  /** The log says in a sentence why. */
  explain(path: string, name: string, why: string): void {
    if (path === this.path && name in this.wrong) this.wrong = { ...this.wrong, [name]: why };
  }
}
