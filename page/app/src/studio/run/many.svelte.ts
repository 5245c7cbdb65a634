// Many runs of the project with other random numbers, on all cores: how many solve the task, and the ways of all of them.
//
// Owns which runs are done. Each Worker makes one after the other.

import { MANY_RUNS_MAX, MANY_WORKERS_MAX } from '../../limits';
import { language } from '../../words';
import type { Trail } from '../../world/trail';
import { Remote } from '../engine/remote';
import type { RunCalls, Whole } from '../engine/runs.worker';
import type { Studio } from '../studio.svelte';

export class Many {
  count = $state(20);
  done = $state.raw<Whole[]>([]);
  isRunning = $state(false);
  refusal = $state('');
  #workers: Remote<RunCalls>[] = [];

  constructor(
    private readonly studio: Studio,
    private readonly trail: Trail,
  ) {}

  /** How many had each verdict. */
  get sum(): Partial<Record<Whole['verdict'], number>> {
    const sum: Partial<Record<Whole['verdict'], number>> = {};
    for (const { verdict } of this.done) sum[verdict] = (sum[verdict] ?? 0) + 1;
    return sum;
  }

  async run(): Promise<void> {
    const bytes = await this.studio.bytes();
    if (!bytes || this.isRunning) return;
    this.done = [];
    this.refusal = '';
    this.isRunning = true;
    this.trail.clear();
    const all = Math.min(Math.max(Math.floor(this.count) || 1, 1), MANY_RUNS_MAX);
    let next = 1;
    const work = async (worker: Remote<RunCalls>): Promise<void> => {
      while (this.isRunning && next <= all)
        this.#take(await worker.call('whole', this.studio.name, bytes, next++, language));
    };
    const cores = Math.min(navigator.hardwareConcurrency || 1, MANY_WORKERS_MAX, all);
    this.#workers = Array.from({ length: cores }, () => new Remote<RunCalls>(begun()));
    try {
      await Promise.all(this.#workers.map(work));
    } catch (error) {
      if (this.isRunning) this.refusal = String(error);
    }
    this.end();
  }

  /** What is done is of another project. */
  clear(): void {
    this.end();
    this.done = [];
    this.refusal = '';
  }

  /** No more runs; what is done stays. */
  end(): void {
    this.isRunning = false;
    for (const worker of this.#workers) worker.end();
    this.#workers = [];
  }

  #take(whole: Whole | string): void {
    if (typeof whole === 'string') {
      this.refusal = whole;
      this.isRunning = false;
      return;
    }
    const number = this.done.length;
    for (let at = 0; at + 1 < whole.way.length; at += 2)
      this.trail.step(number, whole.way[at] ?? NaN, whole.way[at + 1] ?? NaN);
    // Only the way of the picture is needed.
    this.done = [...this.done, { ...whole, way: new Float64Array() }].toSorted(
      (one, other) => one.seed - other.seed,
    );
  }
}

function begun(): Worker {
  return new Worker(new URL('../engine/runs.worker.ts', import.meta.url), { type: 'module' });
}
