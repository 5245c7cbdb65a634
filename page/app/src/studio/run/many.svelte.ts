// Many runs of the project, with other random numbers and perhaps in other fields, on all cores: what each comes to, and the ways.
//
// Owns which runs are done. Each Worker makes one after the other.

import {
  EDIT_FILE_MB_MAX,
  FIELDS_MAX,
  MANY_RUNS_MAX,
  MANY_WORKERS_MAX,
  WORLD_FILE_MB_MAX,
} from '../../limits';
import { language } from '../../words';
import { Heat } from '../../world/heat';
import { Remote } from '../engine/remote';
import type { RunCalls, Whole } from '../engine/runs.worker';
import type { Studio } from '../studio.svelte';
import { words as all } from '../words';
import type { Runner } from './runner.svelte';
import { csv, type DoneRun } from './table';
import { words } from './words';

/** Another world for the project. */
export interface Field {
  name: string;
  /** In XML. */
  text: string;
}

interface Job {
  /** The place of its field; -1: the world of the project. */
  field: number;
  seed: number;
}

export class Many {
  /** In each field. */
  count = $state(20);
  done = $state.raw<DoneRun[]>([]);
  /** Without any the project is run in its own world. */
  fields = $state.raw<readonly Field[]>([]);
  shows = $state<'ways' | 'heat'>('ways');
  isRunning = $state(false);
  refusal = $state('');
  /** How often each place of the project's own world was come to. */
  heat = $state.raw<Heat | undefined>(undefined);
  #workers: Remote<RunCalls>[] = [];

  constructor(
    private readonly studio: Studio,
    private readonly runner: Runner,
  ) {}

  /** How many had each verdict. */
  get sum(): Partial<Record<Whole['verdict'], number>> {
    const sum: Partial<Record<Whole['verdict'], number>> = {};
    for (const { verdict } of this.done) sum[verdict] = (sum[verdict] ?? 0) + 1;
    return sum;
  }

  /** Takes the worlds of these files; of a name that is there already the new one counts. */
  async choose(files: readonly File[]): Promise<void> {
    this.refusal = '';
    const worker = new Remote<RunCalls>(begun());
    try {
      for (const file of files) await this.#add(worker, file);
    } catch (error) {
      this.refusal = String(error);
    }
    worker.end();
  }

  async #add(worker: Remote<RunCalls>, file: File): Promise<void> {
    const { name } = file;
    const others = this.fields.filter((one) => one.name !== name);
    const most = name.endsWith('.qrs') ? EDIT_FILE_MB_MAX : WORLD_FILE_MB_MAX;
    if (others.length >= FIELDS_MAX) this.#refuse(words.mostFields(FIELDS_MAX));
    else if (file.size > most << 20) this.#refuse(words.notField(name, all.tooLarge(most)));
    else {
      const bytes = new Uint8Array(await file.arrayBuffer());
      const field = await worker.call('field', name, bytes, language);
      if (field === undefined) this.#refuse(words.notField(name, words.noWorld));
      else if (typeof field === 'string') this.#refuse(words.notField(name, field));
      else this.fields = [...others, { name, text: field.text }];
    }
  }

  /** One more reason, once. */
  #refuse(why: string): void {
    const all = this.refusal.split('\n').filter(Boolean);
    if (!all.includes(why)) this.refusal = [...all, why].join('\n');
  }

  without(name: string): void {
    this.fields = this.fields.filter((field) => field.name !== name);
  }

  async run(): Promise<void> {
    const bytes = await this.studio.bytes();
    if (!bytes || this.isRunning) return;
    const { fields, runner } = this;
    this.clear();
    this.isRunning = true;
    runner.trail.clear();
    this.heat = fields.length === 0 && runner.scene ? new Heat(runner.scene.bounds) : undefined;
    const jobs = this.#jobs();
    let next = 0;
    const work = async (worker: Remote<RunCalls>): Promise<void> => {
      for (let job = jobs[next++]; job && this.isRunning; job = jobs[next++]) {
        const field = fields[job.field];
        const whole = await worker.call('whole', this.studio.name, bytes, job.seed, language, field?.text);
        if (this.isRunning) this.#take(job, field, whole);
      }
    };
    const cores = Math.min(navigator.hardwareConcurrency || 1, MANY_WORKERS_MAX, jobs.length);
    this.#workers = Array.from({ length: cores }, () => new Remote<RunCalls>(begun()));
    try {
      await Promise.all(this.#workers.map(work));
    } catch (error) {
      if (this.isRunning) this.refusal = String(error);
    }
    this.end();
  }

  #jobs(): Job[] {
    const fields = this.fields.length === 0 ? [-1] : [...this.fields.keys()];
    const wanted = Math.max(Math.floor(this.count) || 1, 1);
    const count = Math.min(wanted, Math.floor(MANY_RUNS_MAX / fields.length));
    if (count < wanted) this.refusal = words.mostRuns(MANY_RUNS_MAX, count);
    const seeds = Array.from({ length: count }, (_, at) => at + 1);
    return fields.flatMap((field) => seeds.map((seed) => ({ field, seed })));
  }

  /** What is done is of another project. */
  clear(): void {
    this.end();
    this.done = [];
    this.refusal = '';
    this.heat = undefined;
  }

  /** No more runs; what is done stays. */
  end(): void {
    this.isRunning = false;
    for (const worker of this.#workers) worker.end();
    this.#workers = [];
  }

  /** The table of what is done, for a spreadsheet. */
  csv(): string {
    return csv(this.done);
  }

  #take({ field: number, seed }: Job, field: Field | undefined, whole: Whole | string): void {
    const at = { number, field: field?.name ?? '', seed };
    if (typeof whole === 'string') {
      // In one field it may not run, and in the next one it does.
      if (field) this.#put(at, { verdict: 'broken', ms: 0, totalScore: null, why: whole });
      else {
        this.refusal = whole;
        this.isRunning = false;
      }
      return;
    }
    const { verdict, ms, totalScore, way } = whole;
    if (!field) this.#draw(way);
    // Only the picture needs the way.
    this.#put(at, { verdict, ms, totalScore, why: '' });
  }

  #draw(way: Float64Array): void {
    const { trail } = this.runner;
    const robot = this.done.length;
    for (let at = 0; at + 1 < way.length; at += 2) trail.step(robot, way[at] ?? NaN, way[at + 1] ?? NaN);
    this.heat?.put(way);
  }

  #put(
    at: Pick<DoneRun, 'number' | 'field' | 'seed'>,
    came: Omit<DoneRun, 'number' | 'field' | 'seed'>,
  ): void {
    this.done = [...this.done, { ...at, ...came }].toSorted(
      (one, other) => one.number - other.number || one.seed - other.seed,
    );
  }
}

function begun(): Worker {
  return new Worker(new URL('../engine/runs.worker.ts', import.meta.url), { type: 'module' });
}
