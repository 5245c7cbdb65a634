// Opens recordings: the last minutes of the robot, or a file; to be shown, or to be compared with the one that is shown.
//
// Owns that one is read at a time, the newest that was asked for. What reads them is loaded when it is needed.

import type { Robot } from '../robot/robot.svelte';
import { words } from '../words';
import type { Opened, ReadProgress } from './open';

/** Where a recording comes from. */
export type From = 'robot' | File;

export class Opener {
  /** Something is being read. */
  isBusy = $state(false);
  /** The part of it that was read; undefined while nobody knows. */
  part = $state<number | undefined>(undefined);
  /** Why the last one was not opened, or not to its end; empty if nothing is wrong. */
  wrong = $state('');
  /** Grows with each attempt: one that is not the newest is given up. */
  #attempt = 0;

  constructor(private readonly robot: Robot) {}

  /** Shows a recording. */
  async open(from: From): Promise<void> {
    await this.#with(from, (code, opened, complaint) => {
      const { robot } = this;
      const isFile = from !== 'robot';
      const name = isFile ? from.name : robot.name;
      const source = {
        is: isFile ? ('file' as const) : ('box' as const),
        name,
        bytes: isFile ? undefined : opened.bytes,
        complaint,
      };
      const past = new code.Past(opened.memory, source, () => robot.changed());
      past.seek(isFile ? 0 : past.length_s);
      robot.show(past);
    });
  }

  /** Compares a recording with the one that is shown. */
  async compare(from: From): Promise<void> {
    const { past } = this.robot;
    await this.#with(from, (code, { memory }, complaint) => {
      if (!past || this.robot.past !== past) return;
      past.beside = code.recordingBeside(past, memory, from === 'robot' ? words.past.box : from.name);
      this.wrong = complaint;
      this.robot.changed();
    });
  }

  /** Compares the robot from now on with the recording from its beginning. */
  async compareLive(): Promise<void> {
    const { past } = this.robot;
    const code = await import('./open');
    if (!past || this.robot.past !== past) return;
    past.beside = code.robotBeside(past, this.robot, words.past.live);
    past.seek(0);
    past.play();
  }

  /** Gives up what is being read. */
  cancel(): void {
    this.#attempt++;
    this.isBusy = false;
  }

  async #with(
    from: From,
    use: (code: typeof import('./open'), opened: Opened, complaint: string) => void,
  ): Promise<void> {
    const attempt = ++this.#attempt;
    this.isBusy = true;
    this.part = undefined;
    this.wrong = '';
    const told: ReadProgress = (part) => {
      if (attempt === this.#attempt) this.part = part;
      return attempt === this.#attempt;
    };
    try {
      const code = await import('./open');
      try {
        const { address } = this.robot;
        const opened = await (from === 'robot' ? code.fromRobot(address, told) : code.fromFile(from, told));
        if (opened && attempt === this.#attempt)
          use(code, opened, opened.wrong ? words.past.onlyPart(code.explained(opened.wrong)) : '');
      } catch (error) {
        if (attempt === this.#attempt) this.wrong = code.explained(error);
      }
    } catch {
      // The server of the page is gone, so its other parts are not to be had.
      if (attempt === this.#attempt) this.wrong = words.connecting;
    }
    if (attempt === this.#attempt) this.isBusy = false;
  }
}
