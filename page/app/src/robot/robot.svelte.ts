// The robot as this page knows it: its nodes and their last minutes, its program, who is in control.
//
// Owns what was heard of it. Values come thousands of times in a second, so they are in plain objects, and `tick` says, once for
// each picture, that something has changed.

import { Inside } from '../inside/inside.svelte';
import { Link } from '../link/link';
import type { News, Playback } from '../link/words';
import type { Around } from '../world/around';
import { Ground, saysWhere } from '../world/ground.svelte';
import { ToldWorld } from '../world/told.svelte';
import type { Scene, WorldState } from '../world/types';
import { Clock } from './clock';
import { Configuration } from './configuration.svelte';
import { Debugger } from './debugger.svelte';
import { BARE, sceneOf, stateOf } from '../past/around.svelte';
import type { Past } from '../past/past.svelte';
import { History, type Timeline } from './history';
import { Programs } from './program.svelte';
import { type Fields, type Line, type Node, Recording } from './recording';
import { Wanted } from './wanted';
import { heard } from '../words';

/** A node and what it gave. */
export interface Known {
  readonly node: Node;
  /** Its newest sample; undefined before the first one. */
  fields: Fields | undefined;
  /** How many samples and failures there were. */
  count: number;
  /** When that was, in seconds since 1970 of the robot's clock. */
  time: number;
  /** Why it has no value; empty if it has one. */
  fault: string;
  /** The last minutes of each of its numbers. */
  readonly histories: ReadonlyMap<string, Timeline>;
}

/** A node of the robot as it is now. */
interface Live extends Known {
  readonly histories: Map<string, History>;
}

/** How many values in a second come to this page at most, of each node. */
const RATE_HZ = 60;
/** Facts of this name say where a recording is from. */
const ABOUT = 'trikfs';
/** Lines that are kept. */
const LINES = 500;
/** ESTALE: the node has left the tree. */
const LEFT = 116;
/** A line of the log is about the order that was refused so shortly before or after it. */
const MISTAKE_MS = 1000;
/** Nodes of which such a line is kept. */
const MISTAKES = 1000;

export class Robot {
  /** Something has changed since the last picture; only reading it makes a component look again. */
  tick = $state(0);
  /** The server of the page is there. */
  isConnected = $state(false);
  /** Why the robot's control port is not reached; empty if it is. */
  absence = $state('');
  name = $state('');
  version = $state('');
  hasWorld = $state(false);
  #ordersWorld = $state(false);
  /** The studio is there, at `/studio/`. */
  hasStudio = $state(false);
  mayDrive = $state(true);
  /** Why the last pairing code was refused. */
  unpaired = $state('');
  isInControl = $state(false);
  /** The address of the browser that is in control; empty if none is. */
  holder = $state('');
  /** The newest refusal, for a person. */
  refusal = $state('');
  /** What all views show while it is there: a moment of a recording. Then nothing but a stop goes to the robot. */
  past = $state.raw<Past | undefined>(undefined);
  /** Where the recording is that is played; undefined over a robot. */
  playback = $state.raw<Playback | undefined>(undefined);
  readonly #told = new ToldWorld();
  readonly #ground: Ground;
  /** A node says where the robot is. */
  #saysWhere = $state(false);
  /** Nodes that a connection has told of, until its first sample: then it has told of all. */
  #toldOf: Set<string> | undefined;

  readonly #nodes = new Map<string, Live>();
  #paths = $state.raw<string[]>([]);
  #lines = $state.raw<Line[]>([]);
  /** Refusals of values, by the path of their node. */
  readonly refused = new Map<string, string>();
  readonly #mistakes = new Map<string, { text: string; at_ms: number }>();
  readonly link: Link;
  readonly programs: Programs;
  readonly debugger: Debugger;
  readonly configuration: Configuration;
  readonly inside: Inside;
  readonly #wanted: Wanted;
  readonly #stops = new Set<() => void>();
  readonly #watchers = new Set<(path: string, fields: Fields) => void>();
  #recording = new Recording(this);
  #isDirty = false;
  readonly #decoder = new TextDecoder();
  readonly #clock = new Clock();

  constructor(readonly address: string) {
    this.link = new Link(address, this);
    this.programs = new Programs(this.link);
    this.debugger = new Debugger(this.link);
    this.configuration = new Configuration(this.link);
    this.inside = new Inside(this.link);
    this.#wanted = new Wanted(address, this);
    this.#ground = new Ground(
      () => this.#nodes,
      () => this.clock,
    );
    const show = () => {
      if (this.#isDirty) {
        this.#isDirty = false;
        this.tick++;
      }
      requestAnimationFrame(show);
    };
    requestAnimationFrame(show);
  }

  /** The robot's clock, in seconds since 1970. */
  get clock(): number {
    return this.#clock.at(Date.now() / 1000);
  }

  /** The moment that is shown. */
  get now(): number {
    return this.past?.now ?? this.clock;
  }

  /** Nodes by their paths, as they are at the moment that is shown. */
  get nodes(): ReadonlyMap<string, Known> {
    return this.past?.nodes ?? this.#nodes;
  }

  /** The paths of all nodes, in order. */
  get paths(): string[] {
    return this.past?.paths ?? this.#paths;
  }

  /** Lines of the log, of programs and their output; the newest last. */
  get lines(): Line[] {
    return this.past?.lines ?? this.#lines;
  }

  /** The world as the simulator tells it, at the moment of a recording, or what a real robot says of where it is. */
  get around(): Around | undefined {
    if (this.past) return this.past.around;
    if (this.hasWorld) return this.#told;
    return this.#saysWhere ? this.#ground : undefined;
  }

  /** What stands still in the world. */
  get scene(): Scene | undefined {
    return this.around?.scene;
  }

  /** What moves in it; drawn at each picture, so not a state of components. */
  get world(): WorldState | undefined {
    return this.around?.state;
  }

  /** The world takes orders. */
  get mayOrderWorld(): boolean {
    return this.#ordersWorld && !this.past;
  }

  /** The nodes of the robot as it is now, whatever is shown. */
  get present(): ReadonlyMap<string, Known> {
    return this.#nodes;
  }

  /** Another browser is in control. */
  get isOthers(): boolean {
    return !this.isInControl && this.holder !== '';
  }

  /** Something goes to the robot that needs control. */
  get mayAct(): boolean {
    const isThere = this.isConnected && !this.absence;
    return isThere && this.mayDrive && !this.isOthers && !this.past;
  }

  /** All views show this moment; undefined: the robot as it is now. */
  show(past: Past | undefined): void {
    this.past = past;
    this.changed();
  }

  /** The moment that is shown is another one. */
  changed(): void {
    this.#isDirty = true;
  }

  /** Calls back for each sample. Returns what ends that. */
  onSample(callback: (path: string, fields: Fields) => void): () => void {
    this.#watchers.add(callback);
    return () => this.#watchers.delete(callback);
  }

  /** Calls back at each stop, before it is sent: nothing older may follow it. Returns what ends that. */
  onStop(callback: () => void): () => void {
    this.#stops.add(callback);
    return () => this.#stops.delete(callback);
  }

  /** A node that is sampled only while somebody needs it, such as a picture: it is shown now. Returns what ends that. */
  want(path: string): () => void {
    return this.past ? () => undefined : this.#wanted.add(path);
  }

  /** Everything to rest, and the program to its end. */
  stop(): void {
    for (const callback of this.#stops) callback();
    this.link.order({ do: 'stop' });
  }

  write(path: string, value: string): void {
    if (this.past) return;
    this.link.order({ do: 'write', path, value });
  }

  /** Somebody has typed a pairing code. */
  pair(code: string): void {
    this.unpaired = '';
    this.link.order({ do: 'pair', code });
  }

  // What the link says.

  connected(is: boolean): void {
    this.isConnected = is;
    if (!is) {
      this.absence = '';
      this.configuration.forget();
    }
  }

  news(news: News): void {
    switch (news.is) {
      case 'hello':
        this.name = news.name;
        this.version = news.version;
        this.hasWorld = news.world;
        this.#ordersWorld = news.orders;
        this.hasStudio = news.studio;
        this.mayDrive = news.drives;
        this.configuration.mayReplace = news.configures;
        break;
      case 'control':
        this.isInControl = news.mine;
        this.holder = news.who ?? '';
        break;
      case 'robot':
        this.absence = news.there ? '' : (news.why ?? '?');
        if (news.there) this.#begin();
        break;
      case 'written':
        if (news.param !== null) {
          const why = news.why === null ? null : (this.#mistakeOf(news.path) ?? news.why);
          this.inside.written(news.path, news.param, why);
        } else if (news.why === null) this.refused.delete(news.path);
        else this.refused.set(news.path, this.#mistakeOf(news.path) ?? news.why);
        this.#isDirty = true;
        break;
      case 'stages':
        this.inside.heard(news.path, news.at_s, news.tuples);
        this.#isDirty = true;
        break;
      case 'programs':
        void this.programs.changed(news.name, news.to);
        break;
      case 'refused':
        this.refusal = heard(news.why);
        break;
      case 'paired':
        this.unpaired = news.why ?? '';
        this.mayDrive ||= news.why === null;
        break;
      case 'configured':
        this.configuration.configured(news.why);
        break;
      case 'scene':
        // What was recorded may be from anywhere.
        this.#told.scene = this.#ordersWorld ? news.scene : (sceneOf(news.scene) ?? BARE);
        break;
      case 'world':
        this.#told.state = this.#ordersWorld ? news.state : (stateOf(news.state) ?? this.#told.state);
        this.#isDirty = true;
        break;
      case 'playback':
        this.playback = news.state;
        break;
      case 'beat':
        break;
      default:
        news satisfies never;
    }
  }

  message(bytes: Uint8Array): void {
    // `stream:` and a piece of the recording.
    if (bytes.length >= 7 && bytes[6] === 0x3a && this.#decoder.decode(bytes.subarray(0, 6)) === 'stream') {
      this.#recording.put(bytes.subarray(7));
      return;
    }
    const message = this.#decoder.decode(bytes);
    this.programs.message(message);
    this.debugger.message(message);
  }

  /** The robot is there: everything is told from now on. */
  #begin(): void {
    this.#recording = new Recording(this);
    this.#toldOf = new Set();
    this.#clock.begin();
    this.link.request(`stream:;hz=${RATE_HZ}`);
    this.programs.begin();
    this.debugger.begin();
  }

  // What the recording says.

  node(node: Node): void {
    this.#toldOf?.add(node.path);
    const old = this.#nodes.get(node.path);
    if (old?.node.format === node.format) return;
    this.#nodes.set(node.path, {
      node,
      fields: undefined,
      count: 0,
      time: 0,
      fault: '',
      histories: new Map(),
    });
    this.#listed();
  }

  /** Other nodes are there than before. */
  #listed(): void {
    this.#paths = [...this.#nodes.keys()].sort();
    this.#saysWhere = saysWhere(this.#nodes);
  }

  /** Nodes that are not in the tree any more. */
  #part(paths: readonly string[]): void {
    for (const path of paths) this.#nodes.delete(path);
    if (paths.length > 0) this.#listed();
    this.#isDirty = true;
  }

  sample(path: string, time: number, fields: Fields): void {
    const told = this.#toldOf;
    if (told) {
      // The robot may have come back with another tree. What is wanted comes over a connection of its own.
      this.#toldOf = undefined;
      this.#part([...this.#nodes.keys()].filter((path) => !told.has(path) && !this.#wanted.has(path)));
    }
    const known = this.#nodes.get(path);
    if (!known) return;
    this.#hear(time);
    known.fields = fields;
    known.count++;
    known.time = time;
    known.fault = '';
    for (const callback of this.#watchers) callback(path, fields);
    for (const [name, value] of Object.entries(fields)) {
      if (typeof value === 'number' || typeof value === 'bigint' || typeof value === 'boolean') {
        let history = known.histories.get(name);
        if (!history) known.histories.set(name, (history = new History()));
        history.put(time, Number(value));
      }
    }
    this.#isDirty = true;
  }

  line(line: Line): void {
    this.#hear(line.time);
    if (line.topic === '/faults' && line.errno === LEFT) {
      this.#part([line.name.replace(/^\//, '')]);
    } else if (line.topic === '/faults') {
      const known = this.#nodes.get(line.name.replace(/^\//, ''));
      if (known) {
        known.fault = line.text;
        known.count++;
        known.time = line.time;
        for (const history of known.histories.values()) history.put(line.time, NaN);
      }
      this.#isDirty = true;
    } else {
      this.#explain(line);
      this.#lines = [...this.#lines.slice(1 - LINES), line];
    }
  }

  /** The log says in a sentence what the number of an error only hints at; it may come before or after that. */
  #explain({ text: line }: Line): void {
    const [, path = '', rest = ''] = /^\[ *[\d.]+\] (.+?): (.*)$/s.exec(line) ?? [];
    const [, caller, text = ''] = /^(caller: )?(.*)$/s.exec(rest) ?? [];
    const param = /^params\/(\S+)/.exec(text)?.[1];
    if (param !== undefined) this.inside.explain(path, param, text);
    if (caller === undefined) return;
    this.#mistakes.set(path, { text, at_ms: performance.now() });
    if (this.#mistakes.size > MISTAKES) this.#mistakes.clear();
    if (this.refused.has(path)) this.refused.set(path, text);
    this.#isDirty = true;
  }

  #mistakeOf(path: string): string | undefined {
    const mistake = this.#mistakes.get(path);
    return mistake && performance.now() - mistake.at_ms < MISTAKE_MS ? mistake.text : undefined;
  }

  facts(name: string, facts: ReadonlyMap<string, string>): void {
    // Nothing is shown of them.
    const offset_ns = name === ABOUT ? facts.get('realtime_offset_ns') : undefined;
    if (offset_ns !== undefined) this.#clock.told(Number(offset_ns) / 1e9, Date.now() / 1000);
  }

  #hear(time: number): void {
    this.#clock.hear(time, Date.now() / 1000);
  }
}
