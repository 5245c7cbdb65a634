// A program in JavaScript or Python, run to its end in a Worker of its own, which is ended when it does not end by itself.
//
// Owns the order: everything is loaded, then the ways out are taken away, then the program runs. A program in JavaScript comes
// with the Worker, as the function `trikProgram`: the policy of the page allows no text to become a program otherwise.

import init, * as web from 'trik-studio-web';
import base from 'robot-script:base';
import codes from 'robot-script:codes';
import robotScript from 'robot-script:robot';
import talk from 'robot-script:talk';
import type { Judged, Locale, Message, Scene, ScriptState } from '../engine/facts';
import { robot } from './brick';
import { told } from './failure';
import { Link, Over } from './link';
import { leaveInside, leaveLanguage } from './sweep';

/** What a program is begun with. */
export interface Beginning {
  name: string;
  text: string;
  /** As XML; empty: an empty floor. */
  world: string;
  seed: number;
  inputs: string[];
  locale: Locale;
  /** Where pyodide is. */
  python: string;
  /** A mistake of its text with its line, if it cannot run. */
  broken: string;
}

/** One moment of the run. */
export interface Picture {
  state: ScriptState;
  /** Only if what stands still has changed. */
  scene: Scene | undefined;
  messages: Message[];
  printed: string[];
}

/** What the page is told. */
export type PlayerNews =
  | { kind: 'ready' }
  | { kind: 'refused'; why: string }
  | { kind: 'begun' }
  | { kind: 'pictures'; pictures: Picture[] }
  | { kind: 'over'; outcome: Judged | undefined; remarks: string[] };

/** Pictures that are told at once, and how long they may wait for that. */
const TOGETHER = 50;
const TOGETHER_MS = 100;
/** Packets of one picture: what a program does before it computes for ever is seen. */
const ALONE = 100;
const SCENE_EVERY = 10;
/** Calls in a stack. */
const CALLS = 50;
/** Until a browser tells of a promise that has failed. */
const LOST_MS = 20;

const post = postMessage.bind(globalThis) as (told: PlayerNews) => void;
const clock = performance.now.bind(performance);
const later = setTimeout.bind(globalThis);
const program = (globalThis as { trikProgram?: () => void }).trikProgram;
const file = location.href;

/** What is seen of a run, in packets. */
class Watch {
  #waiting: Picture[] = [];
  #last = clock();
  #looks = 0;
  #packets = 0;
  #scene = '';
  #isOver = false;

  constructor(private readonly script: web.Script) {}

  look(link: Link): void {
    const { isOver } = link;
    // Whatever a program does after its end, nobody is told.
    if (this.#isOver) return;
    this.#isOver = isOver;
    const { script } = this;
    const { messages } = script.news();
    const printed = link.printed.splice(0);
    let scene: Scene | undefined;
    if (this.#looks % SCENE_EVERY === 0 || isOver) {
      const still = script.scene();
      const text = JSON.stringify(still);
      if (text !== this.#scene) scene = still;
      this.#scene = text;
    }
    this.#looks += 1;
    this.#waiting.push({ state: script.state(), scene, messages, printed });
    const isFull =
      this.#packets < ALONE || this.#waiting.length >= TOGETHER || clock() - this.#last > TOGETHER_MS;
    if (!isFull && !isOver) return;
    post({ kind: 'pictures', pictures: this.#waiting });
    this.#packets += 1;
    this.#waiting = [];
    this.#last = clock();
    if (isOver) post({ kind: 'over', outcome: script.outcome(), remarks: script.remarks() });
  }
}

function failed(link: Link, text: string): void {
  link.raw('error', text);
  link.raw('end', '1');
}

async function runJavaScript(link: Link, text: string): Promise<void> {
  let lost: { reason: unknown } | undefined;
  addEventListener('unhandledrejection', (event) => {
    event.preventDefault();
    lost ??= { reason: event.reason };
  });
  leaveLanguage();
  // What the judge tells comes through it.
  Object.freeze(JSON);
  (Error as { stackTraceLimit?: number }).stackTraceLimit = CALLS;
  try {
    const made = robot(link, text, [base, codes, robotScript, talk]);
    program?.call(globalThis);
    // What was promised goes on once the text has ended.
    await new Promise((done) => later(done, LOST_MS));
    // It comes after what the program does in its promises.
    if (lost) throw (lost as { reason: unknown }).reason;
    if (made.hasEvents) made.loop();
  } catch (error) {
    if (!(error instanceof Over)) {
      failed(link, told(error, file, 'trikProgram'));
      return;
    }
  }
  link.raw('end', '0');
}

async function begin({ name, text, world, seed, inputs, locale, python, broken }: Beginning): Promise<void> {
  await init();
  const begun = web.script(name, world, { seed, inputs, locale });
  if (!begun.ok) {
    post({ kind: 'refused', why: begun.error.problems.map(({ message }) => message).join('\n') });
    return;
  }
  const script = begun.value;
  const watch = new Watch(script);
  const link: Link = new Link(script, () => watch.look(link));
  const engine = name.endsWith('.py') ? await (await import('./python')).python(python) : undefined;
  post({ kind: 'begun' });
  watch.look(link);
  if (broken) {
    failed(link, broken);
  } else if (engine) {
    leaveInside();
    engine(link, name, text, seed);
  } else {
    await runJavaScript(link, text);
  }
}

addEventListener(
  'message',
  ({ data }: MessageEvent<Beginning>) => {
    begin(data).catch((error: unknown) => post({ kind: 'refused', why: String(error) }));
  },
  { once: true },
);
post({ kind: 'ready' });
