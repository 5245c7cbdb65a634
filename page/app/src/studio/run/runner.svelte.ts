// A run of the project in its world: begun, held, stepped, as fast as a person wants, to its verdict.
//
// Owns the clock of the page. The run itself is in a Worker, which is ended and begun anew when it does not answer.

import { SAID_LINES_MAX } from '../../limits';
import { language } from '../../words';
import type { Around } from '../../world/around';
import { Trail } from '../../world/trail';
import type { Scene as WorldScene, WorldState } from '../../world/types';
import type { Judged, Message, Scene, State } from '../engine/facts';
import { Remote } from '../engine/remote';
import type { RunCalls, Seen } from '../engine/runs.worker';
import { Flow } from '../flow/tokens.svelte';
import type { Studio } from '../studio.svelte';
import { words } from '../words';

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
  /** The changed program is not in force, and why. */
  lag = $state('');
  refusal = $state('');
  speed = $state(1);
  seed = $state(1);
  readonly trail = new Trail();
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

  /** Names of the diagrams in which threads are. */
  get diagrams(): ReadonlySet<string> {
    const threads = this.isRunning ? (this.state?.threads ?? []) : [];
    return new Set(threads.map(({ diagram }) => diagram));
  }

  /** Blocks in which threads are. */
  get lit(): ReadonlySet<string> {
    const threads = this.isRunning ? (this.state?.threads ?? []) : [];
    const reacting = this.isRunning ? this.flow.lit : [];
    return new Set([...threads.map(({ id }) => id), ...reacting]);
  }

  /** The world with the robot at its start; whatever ran is over. */
  async look(): Promise<void> {
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

  /** To the next block. */
  async step(): Promise<void> {
    await this.#order('step');
  }

  /** Puts the program as it is drawn now into the run. */
  async change(): Promise<void> {
    if (!this.#remote || !this.isRunning) return;
    const bytes = await this.studio.bytes();
    if (!bytes || !this.isRunning) return;
    try {
      const why = await this.#remote.call('patch', this.studio.name, bytes, language);
      this.lag = why ? words.notInForce(why) : '';
    } catch (error) {
      this.#fail(error);
    }
  }

  /** Breakpoints are those of the studio from now on. */
  async stopAt(breakpoints: ReadonlySet<string>): Promise<void> {
    if (this.isRunning) await this.#remote?.call('stopAt', [...breakpoints]);
  }

  async #order(order: string): Promise<void> {
    if (!this.#remote || !this.isRunning) return;
    try {
      const seen = await this.#remote.call('order', order);
      if (typeof seen === 'string') this.refusal = seen;
      else this.#take(seen);
    } catch (error) {
      this.#fail(error);
    }
    this.#last = performance.now();
    this.#next();
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
    this.isRunning = false;
    this.refusal = this.lag = '';
    this.#number += 1;
    const bytes = await this.studio.bytes();
    if (!bytes) return undefined;
    this.#remote ??= new Remote<RunCalls>(
      new Worker(new URL('../engine/runs.worker.ts', import.meta.url), { type: 'module' }),
    );
    try {
      const begun = await this.#remote.call(
        'begin',
        this.studio.name,
        bytes,
        this.seed,
        [...this.studio.breakpoints],
        language,
      );
      this.trail.clear();
      this.flow.clear();
      if (typeof begun !== 'string') return begun;
      this.refusal = words.notRun(begun);
    } catch (error) {
      this.#fail(error);
    }
    return undefined;
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

  #take({ progress, state, messages, printed, way, scene, outcome, told }: Seen): void {
    for (let at = 0; at + 1 < way.length; at += 2) this.trail.step(0, way[at] ?? NaN, way[at + 1] ?? NaN);
    if (scene) this.scene = shown(scene);
    this.state = state;
    this.flow.hear(told, state.ms);
    this.isHeld = progress === 'held';
    this.world = stateOf(state);
    const lines = printed.map((text): Message => ({ level: 'log', ms: state.ms, place: '', text }));
    if (messages.length + lines.length > 0)
      this.said = [...this.said, ...messages, ...lines].slice(-SAID_LINES_MAX);
    if (progress === 'over') {
      this.isRunning = false;
      this.outcome = outcome;
    }
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
  const { t, robots, things } = world;
  return { t, robots, things, paused: false, speed: 1, led: '', said: '', faults: {} };
}
