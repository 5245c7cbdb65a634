// The robot that has given this page: the project is sent to it, run there, changed while it runs, and stopped.
//
// Owns which version the robot has of what is drawn here. Programs and the debugger speak with it as those of its own page do.

import { DRAWN_AFTER_MS } from '../../limits';
import type { Taker } from '../../link/link';
import { Link } from '../../link/link';
import type { News } from '../../link/words';
import { Debugger } from '../../robot/debugger.svelte';
import { Programs } from '../../robot/program.svelte';
import { heard, language } from '../../words';
import { Flow } from '../flow/tokens.svelte';
import { orderOf, type Point } from '../run/point';
import type { Script } from '../script/script.svelte';
import type { Studio } from '../studio.svelte';
import { type Source, sourceOf } from './source';
import { words } from './words';

/** How often it is asked where its program is, while somebody looks. */
const LOOK_MS = 100;
const NOWHERE: ReadonlySet<string> = new Set();

export class Robot implements Taker {
  name = $state('');
  isConnected = $state(false);
  /** Why it takes no programs; empty if it does. */
  absence = $state('');
  mayDrive = $state(true);
  /** Why the last pairing code was refused. */
  unpaired = $state('');
  isInControl = $state(false);
  holder = $state('');
  /** What was not done, and why. */
  refusal = $state('');
  /** What is drawn goes to the robot while it runs there. */
  isLive = $state(true);
  /** The name under which it has what is open here; empty if it has not. */
  sent = $state('');
  /** The version that it has. */
  #newest = $state.raw<unknown>(undefined);
  readonly #link: Link;
  readonly programs: Programs;
  readonly debugger: Debugger;
  /** What a program of data flow tells of its blocks and ports. */
  readonly #flow = new Flow();
  /** Breakpoints that it was given. */
  #points: ReadonlyMap<string, Point> = new Map();
  #patching = false;
  #timer: ReturnType<typeof setTimeout> | undefined;
  /** Which program it has. */
  #program = '';

  constructor(
    private readonly studio: Studio,
    private readonly script: Script,
    address: string,
  ) {
    this.#link = new Link(address, this);
    this.programs = new Programs(this.#link);
    this.debugger = new Debugger(this.#link);
  }

  /** The robot that has given the page, if one has. */
  static ofPage(studio: Studio, script: Script): Robot | undefined {
    if (!document.querySelector('meta[name=trik-robot]')) return undefined;
    return new Robot(studio, script, `ws://${location.host}/socket?language=${language}`);
  }

  get isOthers(): boolean {
    return !this.isInControl && this.holder !== '';
  }

  /** It does what it is told from here. */
  get mayAct(): boolean {
    return this.isConnected && !this.absence && this.mayDrive && !this.isOthers;
  }

  /** What is looked at, and sent. */
  readonly source: Source = $derived.by(() => sourceOf(this.studio, this.script));

  /** What runs there is what is open here, perhaps in an older version. */
  get isOurs(): boolean {
    return this.sent !== '' && this.programs.running === this.sent && this.#program === this.source.program;
  }

  get isNewest(): boolean {
    return this.#newest === this.source.version;
  }

  get hasMistakes(): boolean {
    return this.source.hasMistakes;
  }

  /** The debugger holds it. */
  get isHeld(): boolean {
    const state = this.debugger.told?.state;
    return this.isOurs && (state === 'stopped' || state === 'past');
  }

  #threads = $derived.by(() => {
    const told = this.isOurs && this.source.isDrawn ? (this.debugger.told?.threads ?? []) : [];
    return told.flatMap(({ at, calls }) => [at, ...(calls ?? [])]).filter((at) => at !== undefined);
  });

  /** Blocks in which its program is. */
  readonly lit: ReadonlySet<string> = $derived.by(() => {
    if (this.studio.isFlow) return this.isOurs ? this.#flow.lit : NOWHERE;
    return this.#threads.length > 0 ? new Set(this.#threads.map(({ id }) => id)) : NOWHERE;
  });

  /** Diagrams in which its program is. */
  readonly diagrams: ReadonlySet<string> = $derived(
    this.#threads.length > 0 ? new Set(this.#threads.map(({ diagram }) => diagram)) : NOWHERE,
  );

  /** Sends what is open, and runs it. */
  async run(): Promise<void> {
    this.refusal = '';
    const { source } = this;
    const { name } = source;
    if (!(await this.#upload(source))) return;
    this.sent = name;
    this.#newest = source.version;
    this.#program = source.program;
    this.#points = source.isDrawn ? this.studio.breakpoints : new Map();
    if (this.#points.size === 0) {
      this.programs.run(name);
      return;
    }
    // The person at this page answers questions of the program.
    this.#link.request('questions');
    if (!(await this.#ordered(`run ${name}`))) return;
    const why = await this.#setAll();
    await this.#ordered('continue');
    this.refusal ||= why;
  }

  /** Everything to rest, and its program to its end. Works without control. */
  stop(): void {
    this.#link.order({ do: 'stop' });
  }

  take(): void {
    this.#link.order({ do: 'take' });
  }

  async order(order: 'pause' | 'step' | 'continue'): Promise<void> {
    if (!this.debugger.told?.attached) await this.#ordered('attach');
    await this.#ordered(order);
  }

  /** Breakpoints of the drawing are those of the program that runs, too. */
  async stopAt(points: ReadonlyMap<string, Point>): Promise<void> {
    if (!this.isOurs || !this.mayAct || points === this.#points) return;
    this.#points = points;
    if (!this.debugger.told?.attached && !(await this.#ordered('attach'))) return;
    await this.#ordered('clear all');
    this.refusal = await this.#setAll();
  }

  /** Why the first one that is not set was refused; empty if all are. */
  async #setAll(): Promise<string> {
    let why = '';
    for (const [id, point] of this.#points) {
      if (!(await this.#ordered(orderOf(id, point)))) why ||= this.refusal;
    }
    return why;
  }

  /** Gives an order to the debugger; a refusal is kept. */
  async #ordered(order: string): Promise<boolean> {
    const answer = await this.debugger.order(order);
    this.refusal = heard(this.debugger.why);
    return answer?.done === true;
  }

  /** What is drawn has changed: the program that runs becomes that, unless it has mistakes. */
  drawn(): void {
    const isWanted = this.isLive && this.source.isDrawn && !this.isNewest && !this.hasMistakes;
    if (!isWanted || !this.isOurs || !this.mayAct) return;
    clearTimeout(this.#timer);
    // While a number is being turned there is a new version at each step of it.
    this.#timer = setTimeout(() => void this.#patch(), DRAWN_AFTER_MS);
  }

  async #patch(): Promise<void> {
    if (this.#patching) {
      this.drawn();
      return;
    }
    this.#patching = true;
    const { source } = this;
    try {
      if (source.isDrawn && this.isOurs && (await this.#upload(source, this.sent))) {
        this.programs.patch(this.sent);
        this.#newest = source.version;
      }
    } finally {
      this.#patching = false;
    }
    this.drawn();
  }

  async #upload(source: Source, name = source.name): Promise<boolean> {
    const bytes = await source.bytes();
    if (!bytes) return false;
    if (await this.programs.upload(new File([bytes.slice()], name))) return true;
    if (this.programs.refusal) this.refusal = words.notSent[this.programs.refusal];
    return false;
  }

  /** A program of the robot as a file; a text says why there is none. */
  async file(name: string): Promise<File | string> {
    const path = name.split('/').map(encodeURIComponent).join('/');
    try {
      const answer = await fetch(`/save/${path}?language=${language}`);
      if (!answer.ok) return (await answer.text()).trim();
      return new File([await answer.blob()], name);
    } catch (error) {
      return String(error);
    }
  }

  /** What was opened is what the robot has under this name. */
  isThere(name: string): void {
    this.sent = name;
    this.#program = this.source.program;
  }

  /** Asks where the program is, again and again while it runs and somebody looks. Returns what ends that. */
  watch(): () => void {
    let isOver = false;
    this.#flow.clear();
    const again = async (): Promise<void> => {
      if (!document.hidden) await this.debugger.look();
      const { told } = this.debugger;
      if (told && this.studio.isFlow) this.#flow.hear(told, told.ms ?? 0);
      if (!isOver) setTimeout(() => void again(), LOOK_MS);
    };
    void again();
    return () => (isOver = true);
  }

  /** A studio from elsewhere has sent the person here with a code. It counts once, so the address forgets it. */
  #pairByAddress(): void {
    const address = new URL(location.href);
    const code = address.searchParams.get('code');
    if (code === null) return;
    address.searchParams.delete('code');
    history.replaceState(null, '', address);
    this.pair(code);
  }

  /** Somebody has typed a pairing code. */
  pair(code: string): void {
    this.unpaired = '';
    this.#link.order({ do: 'pair', code });
  }

  // What the link says.

  connected(is: boolean): void {
    this.isConnected = is;
    if (!is) this.absence = '';
  }

  news(news: News): void {
    switch (news.is) {
      case 'hello':
        this.name = news.name;
        this.mayDrive = news.drives;
        if (!news.drives) this.#pairByAddress();
        break;
      case 'control':
        this.isInControl = news.mine;
        this.holder = news.who ?? '';
        break;
      case 'robot':
        this.absence = news.there ? '' : (news.why ?? '?');
        if (!news.there) break;
        this.programs.begin();
        this.debugger.begin();
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
      case 'written':
      case 'stages':
      case 'configured':
      case 'scene':
      case 'world':
      case 'playback':
      case 'beat':
        // Nothing of it is shown here.
        break;
      default:
        news satisfies never;
    }
  }

  message(bytes: Uint8Array): void {
    const message = new TextDecoder().decode(bytes);
    this.programs.message(message);
    this.debugger.message(message);
  }
}
