// The diagram that runs, as the robot's debugger tells it.
//
// Owns tags of orders and the newest state. What an order means is known to the robot; docs/protocol.md has the table.

import { SvelteMap } from 'svelte/reactivity';
import { ORDERS_WAITING_MAX } from '../limits';
import type { Link } from '../link/link';
import { isObject } from './plain';
import { type DebuggerState, type Place, stateOf } from './told';

export interface Answer {
  done: boolean;
  why?: string;
  program?: DebuggerState | undefined;
  number?: number;
  type?: string;
  value?: string;
  breakpoints?: Breakpoint[];
}

export interface Breakpoint {
  number: number;
  block?: Place | string;
  variable?: string;
  hits: number;
}

/** The protocol has 32 bits for it. */
const TAG_MAX = 4294967295;

export class Debugger {
  /** Undefined while no diagram runs. */
  told = $state.raw<DebuggerState | undefined>(undefined);
  /** Breakpoints by the id of their block. */
  breakpoints = $state.raw<ReadonlyMap<string, number>>(new Map());
  /** Blocks at which a diagram stops when it is run from here, by its name; they are kept when it has ended. */
  readonly plans = new SvelteMap<string, readonly string[]>();
  /** Why the last order was not carried out. */
  why = $state('');
  #tag = 0;
  #toggled: Promise<void> = Promise.resolve();
  #waiting = new Map<number, (answer: Answer) => void>();

  constructor(private readonly link: Link) {}

  /** Asks for something; the answer says whether it was done. Undefined: there is none, because the robot is gone. */
  async ask(order: string): Promise<Answer | undefined> {
    if (this.#waiting.size >= ORDERS_WAITING_MAX) return undefined;
    this.#tag = (this.#tag + 1) % TAG_MAX;
    const tag = this.#tag;
    if (!this.link.request(`debug:${tag} ${order}`)) return undefined;
    return new Promise((answered) => this.#waiting.set(tag, answered));
  }

  /** Looks where the program is. */
  async look(): Promise<void> {
    const isFirst = this.told === undefined;
    const answer = await this.ask('look');
    if (answer) this.told = answer.done ? answer.program : undefined;
    if (isFirst && this.told?.attached) await this.#learn();
  }

  /** Gives an order, and keeps the reason if it is not carried out. */
  async order(order: string): Promise<Answer | undefined> {
    const answer = await this.ask(order);
    this.why = answer?.done === false ? (answer.why ?? '') : '';
    if (answer?.program) this.told = answer.program;
    return answer;
  }

  /** Blocks of a diagram that have a breakpoint. */
  planned(name: string): readonly string[] {
    return this.plans.get(name) ?? [];
  }

  /** Puts a breakpoint at a block of a diagram, or takes it away; one that does not run yet has it when it is run. */
  async toggle(name: string, id: string, isRunning: boolean): Promise<void> {
    // One after the other: each begins with what the one before has left.
    this.#toggled = this.#toggled.then(() => this.#toggle(name, id, isRunning));
    await this.#toggled;
  }

  async #toggle(name: string, id: string, isRunning: boolean): Promise<void> {
    const isNew = isRunning ? !this.breakpoints.has(id) : !this.planned(name).includes(id);
    if (isRunning && !(await (isNew ? this.#set(id) : this.#clear(id)))) return;
    const others = this.planned(name).filter((one) => one !== id);
    this.plans.set(name, isNew ? [...others, id] : others);
  }

  /** Runs a diagram with its breakpoints; it begins at once, or waits at its first block. */
  async run(name: string, waits: boolean): Promise<void> {
    // The person at this page answers questions of the program.
    this.link.request('questions');
    const answer = await this.order(`run ${name}`);
    if (!answer?.done) return;
    let why = '';
    for (const id of this.planned(name)) {
      if (!(await this.#set(id))) why ||= this.why;
    }
    if (!waits) await this.order('continue');
    this.why ||= why;
  }

  /** Breakpoints that the diagram has already: another client has set them, or this page before it was loaded anew. */
  async #learn(): Promise<void> {
    const answer = await this.ask('breakpoints');
    const all = new Map(this.breakpoints);
    for (const { number, block } of answer?.breakpoints ?? []) {
      const id = typeof block === 'object' ? block.id : block;
      if (id !== undefined) all.set(id, number);
    }
    this.breakpoints = all;
  }

  /** Goes on without debugger, and without breakpoints. */
  async detach(name: string): Promise<void> {
    if (!(await this.order('detach'))?.done) return;
    this.plans.delete(name);
    this.breakpoints = new Map();
  }

  async #set(id: string): Promise<boolean> {
    if (!this.told?.attached) await this.order('attach');
    const answer = await this.order(`break ${id}`);
    if (answer?.number === undefined) return false;
    this.breakpoints = new Map([...this.breakpoints, [id, answer.number]]);
    return true;
  }

  async #clear(id: string): Promise<boolean> {
    const number = this.breakpoints.get(id);
    if (number !== undefined && !(await this.order(`clear ${number}`))?.done) return false;
    this.breakpoints = new Map([...this.breakpoints].filter(([one]) => one !== id));
    return true;
  }

  /** A message of the control port. */
  message(message: string): void {
    if (!message.startsWith('debug: ')) return;
    const value = parsed(message.slice('debug: '.length));
    if (!isObject(value)) return;
    if (typeof value.to === 'number') {
      this.#waiting.get(value.to)?.({ ...(value as unknown as Answer), program: stateOf(value.program) });
      this.#waiting.delete(value.to);
    } else if (value.state === 'gone') {
      this.#gone();
    } else {
      this.told = stateOf(value) ?? this.told;
    }
  }

  /** The connection was lost: what was asked has no answer. */
  begin(): void {
    for (const answered of this.#waiting.values()) answered({ done: false, why: '' });
    this.#waiting.clear();
    this.#gone();
  }

  #gone(): void {
    this.told = undefined;
    this.breakpoints = new Map();
  }
}

function parsed(text: string): unknown {
  try {
    return JSON.parse(text);
  } catch {
    return undefined;
  }
}
