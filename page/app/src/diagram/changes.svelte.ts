// Values in blocks of diagrams that a person changes: by a new save from the server, sent to the robot as every program is.
//
// Owns what can be taken back. A diagram that runs goes on with the new value; the robot says what it did.

import { SHEETS_BYTES_MAX } from '../limits';
import type { Programs } from '../robot/program.svelte';
import { language, words } from '../words';
import { type SheetPicture, valueOf } from './sheet';

/** A value that was replaced. */
interface Change {
  readonly block: string;
  readonly property: string;
  readonly before: string;
}

/** A save that was sent is there within two seconds. */
const ATTEMPTS = 20;
const ATTEMPT_MS = 100;
/** Changes that can be taken back. */
const KEPT = 100;

export class Changes {
  /** Why the last one was not made. */
  why = $state('');
  #waiting = $state(0);
  #made = $state.raw<readonly Change[]>([]);
  /** The diagram after the last one. */
  #sheets: readonly SheetPicture[] = [];
  #last: Promise<unknown> = Promise.resolve();

  constructor(
    private readonly programs: Programs,
    private readonly name: string,
  ) {}

  get isBusy(): boolean {
    return this.#waiting > 0;
  }

  get hasUndo(): boolean {
    return this.#made.length > 0;
  }

  /**
   * Gives a property of a block another value, after those that wait already. Returns the diagram as it is then; undefined if it
   * has not changed.
   */
  async make(
    sheets: readonly SheetPicture[],
    block: string,
    property: string,
    value: string,
    isRunning: boolean,
  ): Promise<SheetPicture[] | undefined> {
    return this.#next(async () => {
      const now = this.#sheets.length > 0 ? this.#sheets : sheets;
      const before = valueOf(now, block, property) ?? valueOf(sheets, block, property);
      if (before === undefined || before === value) return undefined;
      const done = await this.#try(block, property, value, isRunning);
      if (done) this.#made = [...this.#made.slice(1 - KEPT), { block, property, before }];
      return done;
    });
  }

  /** Takes the last one back. */
  async undo(isRunning: boolean): Promise<SheetPicture[] | undefined> {
    return this.#next(async () => {
      const last = this.#made.at(-1);
      if (!last) return undefined;
      const done = await this.#try(last.block, last.property, last.before, isRunning);
      if (done) this.#made = this.#made.slice(0, -1);
      return done;
    });
  }

  async #next(work: () => Promise<SheetPicture[] | undefined>): Promise<SheetPicture[] | undefined> {
    this.#waiting++;
    const turn = this.#last.then(async () => {
      this.why = '';
      try {
        const sheets = await work();
        if (sheets) this.#sheets = sheets;
        return sheets;
      } catch {
        this.why = words.connecting;
        return undefined;
      } finally {
        this.#waiting--;
      }
    });
    this.#last = turn;
    return turn;
  }

  async #try(
    block: string,
    property: string,
    value: string,
    isRunning: boolean,
  ): Promise<SheetPicture[] | undefined> {
    const query = new URLSearchParams({ block, property, value, language });
    const answer = await fetch(`/changed/${pathOf(this.name)}?${query.toString()}`);
    if (!answer.ok) {
      this.why = (await answer.text()).trim() || words.notChanged;
      return undefined;
    }
    if (!(await this.programs.upload(new File([await answer.blob()], this.name)))) {
      this.why = words.notChanged;
      return undefined;
    }
    if (isRunning) this.programs.patch(this.name);
    for (let attempt = 0; attempt < ATTEMPTS; attempt++) {
      const sheets = await sheetsOf(this.name);
      if (typeof sheets !== 'string' && valueOf(sheets, block, property) === value) return sheets;
      await new Promise((done) => setTimeout(done, ATTEMPT_MS));
    }
    this.why = words.notChanged;
    return undefined;
  }
}

function pathOf(name: string): string {
  return name.split('/').map(encodeURIComponent).join('/');
}

/** The sheets of a diagram as the robot has it now; else why there are none. */
export async function sheetsOf(name: string): Promise<SheetPicture[] | string> {
  const answer = await fetch(`/diagram/${pathOf(name)}?language=${language}`);
  if (!answer.ok) return (await answer.text()).trim();
  if (Number(answer.headers.get('content-length')) > SHEETS_BYTES_MAX) {
    await answer.body?.cancel();
    return words.sheetsLarge;
  }
  return (await answer.json()) as SheetPicture[];
}
