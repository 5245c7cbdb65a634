// A run in a Worker: the world and the program tick by tick, as fast as the page asks.

import init, * as web from 'trik-studio-web';
import type { DebugAnswer, Finding, Judged, Locale, Message, Progress, Scene, State } from './facts';
import { serve } from './remote';
import { joined } from '../world/pictures';
import { answerOf, type Answered, reported, type HeldState, heldOf } from '../run/told';

/** What there is to see after some ticks. */
export interface Seen {
  progress: Progress;
  state: State;
  messages: Message[];
  printed: string[];
  /** The places of the robot after each tick since the last look, x and y in turn, in metres. */
  way: Float64Array;
  /** Only if what stands still has changed. */
  scene: Scene | undefined;
  /** Moments since the last look, the oldest first; the newest is that of `state`. */
  moments: State[];
  /** Where the program is, for its debugger: while it is held, and at the end. */
  told: HeldState | undefined;
  /** Lines that breakpoints have written. */
  log: string[];
  /** Only at the end. */
  outcome: Judged | undefined;
  /** Of data flow, sometimes: what its debugger tells of blocks and ports. */
  flow: unknown;
}

/** What an order came to. */
export interface Ordered extends Answered {
  seen: Seen;
}

/** What came out of a run that nobody looked at. */
export interface Whole extends Pick<Judged, 'verdict' | 'ms' | 'totalScore'> {
  seed: number;
  /** As that of what is seen. */
  way: Float64Array;
}

/** Between two looks at what stands still, in looks at all else. */
const SCENE_EVERY = 10;
/** Moments that one look tells: a long one is told in so many steps. */
const MOMENTS = 100;
/** The same of what blocks and ports of data flow do. */
const FLOW_EVERY = 3;

let project: web.Project | undefined;
let run: web.Run | undefined;
let looks = 0;
let scene = '';
let ticks = 0;
/** The program is one of data flow. */
let isFlow = false;

function said(findings: Finding[]): string {
  return findings.map(({ block, message }) => (block ? `${block}: ${message}` : message)).join('\n');
}

function see(progress: Progress, before: State[] = []): Seen {
  if (!run) throw new Error('nothing runs');
  const { messages, printed } = run.news();
  const { log, told } = reported(run.reports());
  let changed: Scene | undefined;
  if (looks % SCENE_EVERY === 0 || progress === 'over') {
    const still = run.scene();
    const text = JSON.stringify(still);
    if (text !== scene) changed = still;
    scene = text;
  }
  looks += 1;
  const way = run.way(ticks);
  ticks += way.length / 2;
  const state = run.state();
  // Between two pieces of a search nothing is told.
  const isAsked = progress !== 'runs' || (isFlow && looks % FLOW_EVERY === 0);
  const looked = isAsked ? asked('look') : undefined;
  return {
    way,
    progress,
    state,
    moments: [...before, state],
    told: progress !== 'runs' && looked?.done ? (heldOf(looked['program']) ?? told) : undefined,
    log,
    messages,
    printed,
    scene: changed,
    outcome: run.outcome(),
    flow: isFlow && looked?.done ? looked['program'] : undefined,
  };
}

/** What the debugger answers; undefined: there is none. */
function asked(order: string): DebugAnswer | undefined {
  const answer = run?.order(order);
  return answer?.ok ? answer.value : undefined;
}

/** Breakpoints and watches, in order: why each of those that are not set is not. */
function stop(orders: readonly string[]): string[] {
  asked('clear all');
  return orders.flatMap((order) => {
    const answer = asked(order);
    // A block that was removed is back after another change, with its breakpoint.
    const isPlain = order.startsWith('break ') && !order.includes('\n');
    return answer?.done === false && !isPlain ? [answer.why] : [];
  });
}

const calls = {
  /** A text says why nothing runs. */
  begin(
    name: string,
    bytes: Uint8Array,
    seed: number,
    locale: Locale,
    stops: string[],
  ): { seen: Seen; unset: string[] } | string {
    run?.free();
    project?.free();
    run = project = undefined;
    looks = 0;
    scene = '';
    ticks = 0;
    const opened = web.open(name, bytes, { locale });
    if (!opened.ok) return said(opened.error.problems);
    project = opened.value;
    isFlow = project.about().language === 'dataflow';
    const begun = project.run({ locale, seed, debug: true, explain: true });
    if (!begun.ok) return said(begun.error.problems);
    run = begun.value;
    asked('attach');
    const unset = stop(stops);
    return { seen: see(run.progress()), unset };
  },
  /** What a debugger is told, as `trik debug` sends it. */
  order(order: string): Ordered {
    if (!run) throw new Error('nothing runs');
    const told = run.order(order);
    const answered = told.ok ? answerOf(told.value) : { why: said(told.error.problems), value: '' };
    return { ...answered, seen: see(run.progress()) };
  },
  /** It stops by these orders, and by no others; why each of those that are not set is not. */
  stopAt: stop,
  /** What is wrong with a breakpoint of a program that is not run yet; empty: nothing, or the program is not one. */
  wrongWith(name: string, bytes: Uint8Array, order: string, locale: Locale): string {
    const opened = web.open(name, bytes, { locale });
    if (!opened.ok) return '';
    const begun = opened.value.run({ locale, debug: true });
    opened.value.free();
    if (!begun.ok) return '';
    begun.value.order('attach');
    const answer = begun.value.order(order);
    begun.value.free();
    if (!answer.ok) return said(answer.error.problems);
    return answer.value.done ? '' : answer.value.why;
  },
  /** Puts a new version into the run; a text says why it stays as it is. */
  patch(name: string, bytes: Uint8Array, locale: Locale): string {
    const opened = web.open(name, bytes, { locale });
    if (!opened.ok) return said(opened.error.problems);
    const patched = run?.patch(opened.value);
    opened.value.free();
    return patched && !patched.ok ? said(patched.error.problems) : '';
  },
  /** The world of a file, a world or a project: its text, or why there is none; nothing: the project has none. */
  field(name: string, bytes: Uint8Array, locale: Locale): { text: string } | string | undefined {
    if (name.endsWith('.qrs')) {
      const edited = web.edit(name, bytes, { locale });
      if (!edited.ok) return said(edited.error.problems);
      const world = edited.value.world();
      const text = world && joined(world, edited.value.images() ?? '');
      edited.value.free();
      return text === undefined ? undefined : { text };
    }
    const found = web.lint(name, bytes, { locale });
    const problems = found.ok ? found.value : found.error.problems;
    const wrong = problems.filter(({ level }) => level === 'error').slice(0, 3);
    return wrong.length > 0 ? said(wrong) : { text: new TextDecoder().decode(bytes) };
  },
  /** A whole run with this seed, as fast as it goes, perhaps in another world; a text says why there is none. */
  whole(
    name: string,
    bytes: Uint8Array,
    seed: number,
    locale: Locale,
    field: string | undefined,
  ): Whole | string {
    const opened = web.open(name, bytes, { locale });
    if (!opened.ok) return said(opened.error.problems);
    const begun = opened.value.run({ locale, seed, ...(field === undefined ? {} : { field }) });
    opened.value.free();
    if (!begun.ok) return said(begun.error.problems);
    const whole = begun.value;
    // The judge ends it by its own limit of model time.
    while (whole.tick(6000) === 'runs');
    const judged = whole.outcome();
    const way = whole.way(0);
    whole.free();
    if (!judged) throw new Error('a run without an end');
    const { verdict, ms, totalScore } = judged;
    return { seed, verdict, ms, totalScore, way };
  },
  tick(count: number): Seen {
    if (!run) throw new Error('nothing runs');
    const step = Math.ceil(count / MOMENTS);
    const moments: State[] = [];
    let progress = run.progress();
    for (let left = count; left > 0; left -= step) {
      progress = run.tick(Math.min(step, left));
      if (progress !== 'runs') break;
      if (left > step) moments.push(run.state());
    }
    return see(progress, moments);
  },
  end(): Seen {
    run?.end();
    return see('over');
  },
};

export type RunCalls = typeof calls;

serve(calls, init());
