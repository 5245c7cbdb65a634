// A run in a Worker: the world and the program tick by tick, as fast as the page asks.

import init, * as web from 'trik-studio-web';
import type { Finding, Judged, Locale, Message, Progress, Scene, State } from './facts';
import { serve } from './remote';

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
  /** Only at the end. */
  outcome: Judged | undefined;
  /** Of data flow, sometimes: what its debugger tells of blocks and ports. */
  told: unknown;
}

/** What came out of a run that nobody looked at. */
export interface Whole extends Pick<Judged, 'verdict' | 'ms' | 'totalScore'> {
  seed: number;
  /** As that of what is seen. */
  way: Float64Array;
}

/** Between two looks at what stands still, in looks at all else. */
const SCENE_EVERY = 10;
/** The same of what blocks and ports of data flow do. */
const TOLD_EVERY = 3;

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

function told(): unknown {
  const answer = run?.order('look');
  return answer?.ok && answer.value.done ? answer.value['program'] : undefined;
}

function see(progress: Progress): Seen {
  if (!run) throw new Error('nothing runs');
  const { messages, printed } = run.news();
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
  return {
    way,
    progress,
    state: run.state(),
    messages,
    printed,
    scene: changed,
    outcome: run.outcome(),
    told: isFlow && (looks % TOLD_EVERY === 0 || progress !== 'runs') ? told() : undefined,
  };
}

const calls = {
  /** A text says why nothing runs. */
  begin(name: string, bytes: Uint8Array, seed: number, breakpoints: string[], locale: Locale): Seen | string {
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
    const begun = project.run({ locale, seed, debug: true });
    if (!begun.ok) return said(begun.error.problems);
    run = begun.value;
    run.order('attach');
    for (const id of breakpoints) run.order(`break ${id}`);
    return see(run.progress());
  },
  /** What a debugger is told, as `trik debug` sends it; a text says why it is not done. */
  order(order: string): Seen | string {
    if (!run) throw new Error('nothing runs');
    const told = run.order(order);
    if (!told.ok) return said(told.error.problems);
    return told.value.done ? see(run.progress()) : told.value.why;
  },
  /** Breakpoints are at these blocks, and at no others. */
  stopAt(breakpoints: string[]): void {
    run?.order('clear all');
    for (const id of breakpoints) run?.order(`break ${id}`);
  },
  /** Puts a new version into the run; a text says why it stays as it is. */
  patch(name: string, bytes: Uint8Array, locale: Locale): string {
    const opened = web.open(name, bytes, { locale });
    if (!opened.ok) return said(opened.error.problems);
    const patched = run?.patch(opened.value);
    opened.value.free();
    return patched && !patched.ok ? said(patched.error.problems) : '';
  },
  /** A whole run with this seed, as fast as it goes; a text says why there is none. */
  whole(name: string, bytes: Uint8Array, seed: number, locale: Locale): Whole | string {
    const opened = web.open(name, bytes, { locale });
    if (!opened.ok) return said(opened.error.problems);
    const begun = opened.value.run({ locale, seed });
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
    return see(run.tick(count));
  },
  end(): Seen {
    run?.end();
    return see('over');
  },
};

export type RunCalls = typeof calls;

serve(calls, init());
