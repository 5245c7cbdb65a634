// Calls of functions in a Worker, with the types of these functions.
//
// Owns the messages between both sides. Knows nothing of what is called.

/** What can be called on the other side. */
export type Calls = Record<string, (...given: never[]) => unknown>;

interface Asked {
  number: number;
  name: string;
  given: unknown[];
}

interface Answered {
  number: number;
  value?: unknown;
  wrong?: string;
}

/** Answers calls from outside, one after the other. `ready` comes first. */
export function serve(calls: Calls, ready: Promise<unknown>): void {
  addEventListener('message', (event: MessageEvent<Asked>) => {
    const { number, name, given } = event.data;
    const call = calls[name] as (...given: unknown[]) => unknown;
    ready
      .then(() => call(...given))
      .then(
        (value) => postMessage({ number, value } satisfies Answered),
        (error: unknown) => postMessage({ number, wrong: String(error) } satisfies Answered),
      );
  });
}

/** The other side of a Worker that serves. */
export class Remote<C extends Calls> {
  readonly #waiting = new Map<number, { done: (value: never) => void; failed: (why: Error) => void }>();
  #number = 0;

  constructor(private readonly worker: Worker) {
    worker.addEventListener('message', ({ data }: MessageEvent<Answered>) => {
      const waiting = this.#waiting.get(data.number);
      this.#waiting.delete(data.number);
      if (data.wrong !== undefined) waiting?.failed(new Error(data.wrong));
      else waiting?.done(data.value as never);
    });
    worker.addEventListener('error', (event) => this.#fail(event.message || 'the Worker has not begun'));
  }

  /** Calls a function there. It fails if the function does, or if the Worker has ended. */
  call<N extends keyof C & string>(name: N, ...given: Parameters<C[N]>): Promise<Awaited<ReturnType<C[N]>>> {
    return new Promise((done, failed) => {
      this.#number += 1;
      this.#waiting.set(this.#number, { done, failed });
      this.worker.postMessage({ number: this.#number, name, given } satisfies Asked);
    });
  }

  /** Ends the Worker, whatever it does. */
  end(): void {
    this.worker.terminate();
    this.#fail('the Worker was ended');
  }

  #fail(why: string): void {
    for (const { failed } of this.#waiting.values()) failed(new Error(why));
    this.#waiting.clear();
  }
}
