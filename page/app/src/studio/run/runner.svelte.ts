// A run of the project in its world: begun, held, stepped and taken back, as fast as a person wants, to its verdict.
//
// Owns the clock of the page, and which moment is seen. The run itself is in a Worker, which is ended and begun anew when it
// does not answer.

import { GRAPH_NUMBERS_MAX, SAID_LINES_MAX } from '../../limits';
import { language } from '../../words';
import type { Around } from '../../world/around';
import type { Heat } from '../../world/heat';
import { Trail } from '../../world/trail';
import type { Scene as WorldScene, WorldState } from '../../world/types';
import type { Judged, Message, Scene, State } from '../engine/facts';
import { Remote } from '../engine/remote';
import type { RunCalls, Seen } from '../engine/runs.worker';
import { Flow } from '../flow/tokens.svelte';
import type { Studio } from '../studio.svelte';
import { words } from '../words';
import { Moments } from './moments';
import { orderOf, orders, type Point } from './point';
import type { Answered, HeldState } from './told';
import { words as own } from './words';

/** Model time of one tick. */
const TICK_MS = 10;
/** Ticks of one call at the greatest speed: about a picture's time. */
const FASTEST_TICKS = 500;
export const FASTEST = Infinity;
export const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 5, 10, 50, FASTEST];

export class Runner {
  scene = $state.raw<WorldScene | undefined>(undefined);
  world = $state.raw<WorldState | undefined>(undefined);
  state = $state.raw<State | undefined>(undefined);
  outcome = $state.raw<Judged | undefined>(undefined);
  /** Lines of rules and program, the newest last. */
  said = $state.raw<Message[]>([]);
  isRunning = $state(false);
  /** A person has ended the last run. */
  isEnded = $state(false);
  /** The program is held before a block. */
  isHeld = $state(false);
  /** Where the program was when it was held last, or when it ended. */
  told = $state.raw<HeldState | undefined>(undefined);
  /** A time that is to be looked at, in milliseconds, until it is seen. */
  wanted_ms = $state<number | undefined>(undefined);
  /** Variables after a change of which it stops. */
  watches = $state.raw<ReadonlySet<string>>(new Set());
  /** Names of the numbers of which there are graphs. */
  graphed = $state.raw<readonly string[]>([]);
  /** The changed program is not in force, and why. */
  lag = $state('');
  /** Breakpoints that are not set, and why. */
  unset = $state('');
  refusal = $state('');
  speed = $state(1);
  seed = $state(1);
  readonly trail = new Trail();
  /** Of many runs; shown until another run begins. */
  heat = $state.raw<Heat | undefined>(undefined);
  /** What it has come through. */
  readonly moments = new Moments();
  /** Another number after each look, for what shows `moments`. */
  beat = $state(0);
  /** What a program of data flow tells of its blocks and ports. */
  readonly flow = new Flow();
  #remote: Remote<RunCalls> | undefined;
  #frame = 0;
  #last = 0;
  #owed = 0;
  #isAsked = false;
  /** Of the run: another one follows. */
  #number = 0;

  constructor(private readonly studio: Studio) {}

  /** For the view: the way has all ticks, not only those that it was drawn at. */
  get around(): Around {
    const { scene, world: state, trail } = this;
    return { scene, state, trail, isGround: false, look: () => undefined };
  }

  /** A moment before the newest one is seen. */
  get isPast(): boolean {
    return this.hasPast && this.told?.state === 'past';
  }

  /** There is a past to look at. */
  get hasPast(): boolean {
    return this.told !== undefined && (this.isHeld || this.outcome !== undefined);
  }

  get isSearching(): boolean {
    return this.hasPast && this.told?.state === 'searching';
  }

  /** Model time of what is seen, in milliseconds. */
  get seen_ms(): number {
    return (this.isPast ? this.told?.ms : undefined) ?? this.state?.ms ?? 0;
  }

  /** Names and values of variables at the moment that is seen. */
  get variables(): [name: string, value: string][] {
    if (this.isPast) return (this.told?.variables ?? []).map(({ name, value }) => [name, value]);
    return Object.entries(this.state?.variables ?? {});
  }

  /** Motors and sensors at the moment that is seen. */
  get ports(): [name: string, value: number][] {
    const { motors = {}, sensors = {} } = this.state ?? {};
    const now = Object.entries({ ...motors, ...sensors });
    if (!this.isPast) return now;
    const then = this.moments.numbersAt(this.seen_ms);
    return now.flatMap(([name]) => {
      const value = then[name];
      return value === undefined ? [] : [[name, value]];
    });
  }

  /** Blocks in which threads are, with their diagrams. */
  get #places(): { diagram: string; id: string }[] {
    if (this.isPast) return (this.told?.threads ?? []).flatMap(({ at }) => (at ? [at] : []));
    return this.isRunning ? (this.state?.threads ?? []) : [];
  }

  /** Names of the diagrams in which threads are. */
  get diagrams(): ReadonlySet<string> {
    return new Set(this.#places.map(({ diagram }) => diagram));
  }

  /** Blocks in which threads are. */
  get lit(): ReadonlySet<string> {
    const reacting = this.isRunning ? this.flow.lit : [];
    return new Set([...this.#places.map(({ id }) => id), ...reacting]);
  }

  /** The world with the robot at its start; whatever ran is over. */
  async stand(): Promise<void> {
    this.outcome = undefined;
    this.said = [];
    const seen = await this.#begin();
    if (seen) this.#take(seen);
  }

  async run(): Promise<void> {
    const seen = await this.#begin();
    if (!seen) return;
    this.said = [];
    this.outcome = undefined;
    this.isEnded = false;
    this.#take(seen);
    this.isRunning = seen.progress !== 'over';
    this.#last = performance.now();
    this.#owed = 0;
    this.#next();
  }

  /** Holds the program before its next block; the world stands still meanwhile. */
  async pause(): Promise<void> {
    await this.#order('pause');
  }

  async goOn(): Promise<void> {
    await this.#order('continue');
  }

  /** To another block or moment, in the words of docs/protocol.md; why not, and what it has come to. */
  async order(order: string): Promise<Answered> {
    // A key may come again before a step is over.
    return this.hasPast ? this.#order(order) : { why: '', value: '' };
  }

  /** The same for what only looks: what is refused is told by the answer alone. */
  async look(order: string): Promise<Answered> {
    const answered = await this.#order(order);
    if (answered.why) this.refusal = '';
    return answered;
  }

  /** Looks at a time of the past, or at the present; while one is looked for, the last that was asked for counts. */
  async goTo(ms: number): Promise<void> {
    const isGoing = this.wanted_ms !== undefined;
    this.wanted_ms = ms;
    if (isGoing) return;
    for (let seen_ms: number | undefined; this.wanted_ms !== seen_ms && this.hasPast;) {
      seen_ms = this.wanted_ms;
      const isPresent = seen_ms >= (this.state?.ms ?? 0);
      if (!isPresent) await this.#order(`back to ${Math.round(seen_ms)}`);
      else if (this.isPast) await this.#order('present');
    }
    this.wanted_ms = undefined;
  }

  /** What is wrong with a breakpoint; empty: nothing that is known before the program runs. */
  async wrongWith(id: string, point: Point): Promise<string> {
    const bytes = await this.studio.bytes();
    if (!bytes) return '';
    try {
      return await this.#worker().call('wrongWith', this.studio.name, bytes, orderOf(id, point), language);
    } catch (error) {
      this.#fail(error);
      return '';
    }
  }

  /** Another project has other variables. */
  forget(): void {
    this.watches = new Set();
    this.graphed = [];
  }

  /** There is a graph of this number, or no longer. */
  toggleGraph(name: string): void {
    const others = this.graphed.filter((one) => one !== name);
    if (others.length < this.graphed.length) this.graphed = others;
    else if (others.length < GRAPH_NUMBERS_MAX) this.graphed = [...others, name];
    else this.refusal = own.mostNumbers(GRAPH_NUMBERS_MAX);
  }

  /** It stops after each change of this variable, or does so no longer. */
  toggleWatch(name: string): void {
    const all = new Set(this.watches);
    if (!all.delete(name)) all.add(name);
    this.watches = all;
  }

  /** Puts the program as it is drawn now into the run. */
  async change(): Promise<void> {
    if (!this.#remote || !this.isRunning) return;
    // Compressed it would be in force later.
    const bytes = await this.studio.stored();
    if (!bytes || !this.isRunning) return;
    try {
      const why = await this.#remote.call('patch', this.studio.name, bytes, language);
      this.lag = why ? words.notInForce(why) : '';
      // A new version is put into the present.
      if (this.isPast) await this.#order('look');
    } catch (error) {
      this.#fail(error);
    }
  }

  /** It stops there from now on, and nowhere else. */
  async stopAt(points: ReadonlyMap<string, Point>, watches: ReadonlySet<string>): Promise<void> {
    if (!this.#remote || !(this.isRunning || this.hasPast)) return;
    const unset = await this.#remote.call('stopAt', orders(points, watches));
    this.unset = unset.join('\n');
  }

  async #order(order: string): Promise<Answered> {
    const nothing = { why: '', value: '' };
    if (!this.#remote || !(this.isRunning || this.hasPast)) return nothing;
    let answered: Answered = nothing;
    const number = this.#number;
    try {
      const { seen, ...answer } = await this.#remote.call('order', order);
      if (number !== this.#number) return nothing;
      answered = answer;
      this.refusal = answer.why;
      this.#take(seen);
    } catch (error) {
      this.#fail(error);
    }
    await this.#search(number);
    this.#last = performance.now();
    this.#next();
    return answered;
  }

  /** A way back may be long: it is gone in pieces, so that it can be given up between them. */
  async #search(number: number): Promise<void> {
    while (this.#remote && this.isSearching && number === this.#number) {
      try {
        const seen = await this.#remote.call('tick', 1);
        if (number === this.#number) this.#take(seen);
      } catch (error) {
        this.#fail(error);
      }
    }
  }

  async end(): Promise<void> {
    this.isEnded = true;
    if (this.#remote && this.isRunning) this.#take(await this.#remote.call('end'));
  }

  /** Ends everything. */
  close(): void {
    cancelAnimationFrame(this.#frame);
    this.#remote?.end();
    this.#remote = undefined;
  }

  async #begin(): Promise<Seen | undefined> {
    cancelAnimationFrame(this.#frame);
    this.isRunning = this.isHeld = false;
    this.told = undefined;
    this.refusal = this.lag = this.unset = '';
    this.#number += 1;
    const bytes = await this.studio.bytes();
    if (!bytes) return undefined;
    const stops = orders(this.studio.breakpoints, this.watches);
    try {
      const begun = await this.#worker().call('begin', this.studio.name, bytes, this.seed, language, stops);
      this.trail.clear();
      this.flow.clear();
      this.heat = undefined;
      this.moments.clear();
      if (typeof begun !== 'string') {
        this.unset = begun.unset.join('\n');
        return begun.seen;
      }
      this.refusal = words.notRun(begun);
    } catch (error) {
      this.#fail(error);
    }
    return undefined;
  }

  #worker(): Remote<RunCalls> {
    this.#remote ??= new Remote<RunCalls>(
      new Worker(new URL('../engine/runs.worker.ts', import.meta.url), { type: 'module' }),
    );
    return this.#remote;
  }

  #next(): void {
    cancelAnimationFrame(this.#frame);
    if (!this.isRunning || this.isHeld) return;
    this.#frame = requestAnimationFrame((now) => {
      // A page that was hidden does not make up for it.
      const passed = Math.min(now - this.#last, 100);
      this.#last = now;
      this.#owed = this.speed === FASTEST ? FASTEST_TICKS : this.#owed + (passed * this.speed) / TICK_MS;
      const ticks = Math.floor(this.#owed);
      this.#owed -= ticks;
      if (ticks > 0 && !this.#isAsked) void this.#tick(ticks);
      this.#next();
    });
  }

  async #tick(ticks: number): Promise<void> {
    if (!this.#remote || !this.isRunning) return;
    this.#isAsked = true;
    const number = this.#number;
    try {
      const seen = await this.#remote.call('tick', ticks);
      // Of a run that another one has followed nothing is shown.
      if (number === this.#number) this.#take(seen);
    } catch (error) {
      this.#fail(error);
    }
    this.#isAsked = false;
  }

  #take(seen: Seen): void {
    const { progress, state, messages, printed, log, way, scene, moments, told, flow } = seen;
    for (let at = 0; at + 1 < way.length; at += 2) this.trail.step(0, way[at] ?? NaN, way[at + 1] ?? NaN);
    for (const moment of moments) this.moments.put(moment);
    this.beat += 1;
    if (scene) this.scene = shown(scene);
    this.state = state;
    this.told = told ?? this.told;
    this.flow.hear(flow, state.ms);
    this.isHeld = progress === 'held';
    this.world = this.isPast ? this.#pastWorld(told?.ms ?? 0) : stateOf(state);
    const lines = [...printed, ...log].map((text): Message => ({
      level: 'log',
      ms: state.ms,
      place: '',
      text,
    }));
    if (messages.length + lines.length > 0)
      this.said = [...this.said, ...messages, ...lines].slice(-SAID_LINES_MAX);
    if (progress === 'over') {
      this.isRunning = false;
      this.outcome = seen.outcome;
    }
  }

  #pastWorld(ms: number): WorldState | undefined {
    const moving = this.moments.at(ms);
    return moving ? worldOf({ t: ms / 1000, ...moving }) : this.world;
  }

  #fail(error: unknown): void {
    this.refusal = words.notRun(String(error));
    this.isRunning = false;
    this.close();
  }
}

/** As the picture of the world takes it: nothing of it is moved by hand here. */
function shown(scene: Scene): WorldScene {
  return { ...scene, locked: { world: true, robot: true }, fields: false, devices: [] };
}

function stateOf({ world }: State): WorldState {
  return worldOf(world);
}

function worldOf({ t, robots, things }: Pick<WorldState, 't' | 'robots' | 'things'>): WorldState {
  return { t, robots, things, paused: false, speed: 1, led: '', said: '', faults: {} };
}
