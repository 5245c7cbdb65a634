// A Worker that runs one program with text, from the side of the page.
//
// Owns how the text becomes a program though the policy allows no text to be evaluated: the Worker's own text is the program, as a
// function. Knows nothing of what is shown.

import { ENGINE_MS_MAX, SILENT_MS_MAX } from '../../limits';
import { languageOf } from './names';
import playerAddress from './player.worker.ts?worker&url';
import type { Beginning, PlayerNews } from './player.worker';

/** Who hears of a run. */
export interface Listener {
  /** Everything but `ready`. */
  told(told: PlayerNews): void;
  /** It was ended because it was silent: before the engine had come, or after. */
  silent(hadBegun: boolean): void;
  broken(why: string): void;
}

function workerOf(text: string): Worker {
  const address = URL.createObjectURL(new Blob([text], { type: 'text/javascript' }));
  const worker = new Worker(address);
  // The Worker has it by then; its own address stays the name in stacks.
  worker.addEventListener('message', () => URL.revokeObjectURL(address), { once: true });
  worker.addEventListener('error', () => URL.revokeObjectURL(address), { once: true });
  return worker;
}

/** What is wrong with the text of a program, with its line; empty if it can be run. */
async function mistakes(text: string): Promise<string> {
  const alone = await mistakesOf((word) => `throw ${word};${text}\n`);
  // A directive counts where it stands first, as in the function that the text becomes.
  return alone || mistakesOf((word) => `throw ${word};(function(){${text}\n});`);
}

function mistakesOf(made: (word: string) => string): Promise<string> {
  // It ends with a word that nobody else knows before it does anything: any other end is a mistake of the text. What can stand
  // alone can stand in a function as well, and nothing of it outside of that.
  const word = `parsed ${[...crypto.getRandomValues(new Uint32Array(4))].join('-')}`;
  return new Promise((done) => {
    const worker = workerOf(made(JSON.stringify(word)));
    worker.addEventListener('error', (event) => {
      event.preventDefault();
      worker.terminate();
      const said = event.message.replace(/^Uncaught /, '');
      done(said.includes(word) ? '' : `Line ${event.lineno}: ${said}`);
    });
  });
}

export class Player {
  #worker: Worker | undefined;
  #silence: ReturnType<typeof setTimeout> | undefined;
  #isGone = false;
  #hasBegun = false;

  constructor(private readonly listener: Listener) {}

  /** Runs a program. What it was begun with says all but what is wrong with its text. */
  async begin(beginning: Omit<Beginning, 'broken'>): Promise<void> {
    const { name, text } = beginning;
    const isJavaScript = languageOf(name) === 'js';
    const broken = isJavaScript ? await mistakes(text) : '';
    if (this.#isGone) return;
    const program = isJavaScript && !broken ? `globalThis.trikProgram=function(){${text}\n};` : '';
    const address = JSON.stringify(new URL(playerAddress, location.href).href);
    const failed = `(why)=>postMessage({kind:'refused',why:String(why)})`;
    this.#worker = workerOf(`${program}import(${address}).catch(${failed});`);
    this.#worker.addEventListener('message', ({ data }: MessageEvent<PlayerNews>) => {
      if (this.#isGone) return;
      if (data.kind === 'ready') this.#worker?.postMessage({ ...beginning, broken } satisfies Beginning);
      else this.listener.told(data);
      this.#hasBegun ||= data.kind === 'begun';
      if (data.kind === 'over' || data.kind === 'refused') this.end();
      else this.#listen();
    });
    this.#worker.addEventListener('error', (event) => {
      event.preventDefault();
      if (this.#isGone) return;
      this.end();
      this.listener.broken(event.message || 'the Worker has not begun');
    });
    this.#listen();
  }

  /** Ends the Worker, whatever it does. */
  end(): void {
    this.#isGone = true;
    clearTimeout(this.#silence);
    this.#worker?.terminate();
  }

  /** A program that asks is heard of: its pictures come. */
  #listen(): void {
    clearTimeout(this.#silence);
    const hadBegun = this.#hasBegun;
    this.#silence = setTimeout(
      () => {
        this.end();
        this.listener.silent(hadBegun);
      },
      hadBegun ? SILENT_MS_MAX : ENGINE_MS_MAX,
    );
  }
}
