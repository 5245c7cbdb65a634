// A moment of a recording that all views show, and its clock.
//
// Owns where that clock is. What a recording has is known to `memory`; how it looks, to the views.

import type { Timeline } from '../robot/history';
import type { OutputLine } from '../robot/program.svelte';
import type { Fields, Line, Node } from '../robot/recording';
import type { Known } from '../robot/robot.svelte';
import type { DebuggerState } from '../robot/told';
import type { Around } from '../world/around';
import { aroundOf } from './around.svelte';
import type { Beside } from './beside.svelte';
import type { Memory } from './memory';
import { countUntil, runningAt, Steps } from './steps';
import type { Track } from './track';

/** Where a recording is from. */
export interface Source {
  is: 'box' | 'file';
  /** The name of the file, or of the robot. */
  name: string;
  /** All of it, to be saved; only of a box. */
  bytes: Uint8Array<ArrayBuffer> | undefined;
  /** Why not all of it is there, for a person; empty if it is. */
  complaint: string;
}

/** Lines that are shown at once, as many as of a robot. */
const LINES = 500;
const SAID = ['/output', '/programs', '/mail'];

export class Past {
  readonly begin: number;
  readonly length_s: number;
  readonly paths: string[];
  readonly nodes: ReadonlyMap<string, Known>;
  /** Seconds since its beginning, for what shows the clock. */
  at = $state(0);
  runs = $state(false);
  speed = $state(1);
  /** Another recording, or the robot as it is now, that graphs show as well. */
  beside = $state.raw<Beside | undefined>(undefined);
  /** The same moment since 1970; that it is another one is told by `tick` of the robot. */
  #now: number;
  /** The newest lines that were there by then. */
  lines = $state.raw<Line[]>([]);
  /** The program that ran; empty if none did. */
  running = $state('');
  /** Where a diagram was. */
  told = $state.raw<DebuggerState | undefined>(undefined);
  /** Blocks of data flow at which something had happened lately. */
  lit = $state.raw<ReadonlySet<string>>(new Set());
  /** The world; undefined if the recording has nothing of it. */
  readonly around: Around | undefined;
  #lineCount = 0;
  #stepCount = 0;
  readonly #steps: Steps;

  constructor(
    readonly memory: Memory,
    readonly source: Source,
    private readonly changed: () => void,
  ) {
    this.begin = memory.begin;
    // Up to the next tenth, so that the last step of a slider is the end.
    this.length_s = Math.ceil((memory.end - memory.begin) * 10) / 10;
    this.paths = [...memory.tracks.keys()].sort();
    this.#now = this.begin;
    this.#steps = new Steps(memory.steps);
    const now = () => this.#now;
    this.nodes = nodesAt(memory, now);
    this.around = aroundOf(memory, this.nodes, now);
  }

  /** The moment that is shown, in seconds since 1970. */
  get now(): number {
    return this.#now;
  }

  /** Goes to a moment, in seconds since the beginning. */
  seek(at: number): void {
    this.at = Math.max(0, Math.min(at, this.length_s));
    this.#now = this.begin + this.at;
    const count = countUntil(this.memory.lines, this.#now);
    if (count !== this.#lineCount) {
      this.#lineCount = count;
      this.lines = this.memory.lines.slice(Math.max(0, count - LINES), count);
    }
    const running = runningAt(this.memory.lines, this.#now);
    this.running = running?.name ?? '';
    const stepCount = countUntil(this.memory.steps, this.#now);
    if (stepCount !== this.#stepCount || !running) {
      // What is not asked for now is asked for when something runs again.
      this.#stepCount = running ? stepCount : -1;
      this.told = running && this.#steps.at(this.#now, running.since);
    }
    const lit = running ? this.#steps.litAt(this.#now) : new Set<string>();
    // Views are made anew only for something else.
    if (lit.size !== this.lit.size || [...lit].some((id) => !this.lit.has(id))) this.lit = lit;
    this.changed();
  }

  /** Its clock runs for so long. */
  forward(seconds: number): void {
    this.seek(this.at + seconds * this.speed);
    if (this.at >= this.length_s) this.runs = false;
  }

  /** At the end it begins anew. */
  play(): void {
    if (this.at >= this.length_s) this.seek(0);
    this.runs = true;
  }

  /** What programs had said by then. */
  get said(): OutputLine[] {
    return this.lines
      .filter(({ topic }) => SAID.includes(topic))
      .map(({ topic, text, level }, number) => {
        const kind =
          topic === '/mail' ? 'mail' : topic === '/programs' ? 'info' : level >= ERROR ? 'error' : 'print';
        // Output says what it is, as the control port does.
        const words = topic === '/output' ? text.replace(/^(print|error): /, '') : text;
        return { kind, text: words.replace(/\n+$/, ''), number };
      });
  }
}

/** The severity of rcl_interfaces/msg/Log. */
const ERROR = 40;

/** A recorder finds out what all nodes have one after the other; at the beginning that is what they have. */
const BEGINNING_S = 0.1;

/** The nodes of a recording at a moment, which may become another one. */
export function nodesAt(memory: Memory, now: () => number): ReadonlyMap<string, Known> {
  const early = memory.begin + BEGINNING_S;
  return new Map([...memory.tracks].map(([path, track]) => [path, new Then(track, now, early)]));
}

/** A node at the moment that is shown. */
class Then implements Known {
  readonly histories: ReadonlyMap<string, Timeline>;
  #looked = { now: NaN, place: -1 };
  #fields: { place: number; fields: Fields | undefined } = { place: -2, fields: undefined };

  constructor(
    private readonly track: Track,
    private readonly now: () => number,
    /** Until when a node has what it gives first. */
    private readonly early: number,
  ) {
    this.histories = new Map(
      [...track.numbers.keys()].map((field) => [
        field,
        { since: (time: number) => track.samples(field, time, now()) },
      ]),
    );
  }

  get #place(): number {
    const now = this.now();
    if (this.#looked.now !== now) {
      const place = this.track.placeAt(now);
      const isFirst = place < 0 && now <= this.early && this.track.placeAt(this.early) >= 0;
      this.#looked = { now, place: isFirst ? 0 : place };
    }
    return this.#looked.place;
  }

  get node(): Node {
    return this.track.node;
  }

  get fields(): Fields | undefined {
    const place = this.#place;
    if (this.#fields.place !== place) this.#fields = { place, fields: this.track.fieldsAt(place) };
    return this.#fields.fields;
  }

  get count(): number {
    return this.#place + 1;
  }

  get time(): number {
    return this.#place < 0 ? 0 : this.track.times.at(this.#place);
  }

  get fault(): string {
    return this.track.faults.get(this.#place) ?? '';
  }
}
