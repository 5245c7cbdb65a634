// The way of a program to its world: each question moves the world as far as its answer needs.
//
// Owns when a picture is due, and how the end of a run ends its program. Knows no language and no Worker.

/** What is asked: a run of the package for browsers. */
export interface Asker {
  ask(word: string, text: string, ticks: number): string;
  goOn(ticks: number): string;
}

/** The run is over: whatever the program does now, nobody answers. */
export class Over extends Error {
  override name = 'Over';
}

/** What was asked is not answered, and why. */
export class Refusal extends Error {
  readonly errno: number;
  constructor(errno: number, reason: string) {
    super(reason);
    this.errno = errno;
  }
}

/** A reading that is not there yet. */
export const NOT_YET = 11;
/** Ticks of 10 ms from picture to picture. */
const PICTURE_TICKS = 2;
const TICK_MS = 10;
/** What is told of what a program prints: lines, and characters of each. The judge itself keeps less. */
const LINES_MAX = 10_000;
/** Lines that are told at once, and not with the next picture. */
const LINES_AT_ONCE = 50;
const LINE_LENGTH_MAX = 1000;
/** When a program begins, before its own time does. */
const BEGIN_MS = -30;

export class Link {
  /** Milliseconds since the program has begun. */
  now = 0;
  isOver = false;
  /** What the program has printed and nobody has taken yet. */
  printed: string[] = [];
  #lines = 0;
  #at = BEGIN_MS;
  #left = PICTURE_TICKS;
  readonly #asker: Asker;
  readonly #look: () => void;

  /** `look` is called whenever a picture is due, and at the end. */
  constructor(asker: Asker, look: () => void) {
    this.#asker = asker;
    this.#look = look;
  }

  /** The answer as the package writes it: `ok:NOW:TEXT`, `no:NOW:ERRNO:REASON`, `over`. */
  raw(word: string, text: string): string {
    if (this.isOver) return 'over';
    let told = this.#asker.ask(word, text, this.#left);
    while (told === 'later') {
      this.#at += this.#left * TICK_MS;
      this.#picture();
      told = this.#asker.goOn(this.#left);
    }
    if (told === 'over') {
      this.isOver = true;
      this.#look();
      return told;
    }
    this.now = Number(told.split(':', 2)[1]);
    this.#left -= (this.now - this.#at) / TICK_MS;
    this.#at = this.now;
    if (word === 'print' && this.#lines < LINES_MAX) {
      this.#lines += 1;
      this.printed.push(text.replace(/\n$/, '').slice(0, LINE_LENGTH_MAX));
      // It may be the last thing that the program does.
      if (this.#lines <= LINES_AT_ONCE) this.#look();
    }
    if (this.#left <= 0) this.#picture();
    return told;
  }

  #picture(): void {
    this.#left = PICTURE_TICKS;
    this.#look();
  }

  /** The text of an answer. Throws a `Refusal`, or `Over`. */
  ask(word: string, text = ''): string {
    const told = this.raw(word, text);
    if (told === 'over') throw new Over('the run is over');
    const [kind = '', now = ''] = told.split(':', 2);
    const rest = told.slice(kind.length + now.length + 2);
    if (kind === 'ok') return rest;
    const colon = rest.indexOf(':');
    throw new Refusal(Number(rest.slice(0, colon)), rest.slice(colon + 1));
  }
}
