// Programs of the robot: which there are, which one runs, what it says and asks.
//
// Owns what was heard of them over the control port and of their folder. Knows no sensors and no diagrams.

import { SvelteMap } from 'svelte/reactivity';
import { PROGRAM_BYTES_MAX, QUESTION_S_MAX } from '../limits';
import type { Link } from '../link/link';

/** A program in the robot's folder. */
export interface Stored {
  name: string;
  bytes: number;
  changed_s: number | null;
}

/** A line of a program, or about one. */
export interface OutputLine {
  kind: 'print' | 'error' | 'info' | 'mail';
  text: string;
  /** No other line has it. */
  number: number;
}

/** What a diagram wants to know from a person. */
export interface Question {
  number: number;
  variable: string;
  question: string;
  default?: string;
  /** How long it waits for its answer. */
  seconds?: number;
  /** What was wrong with the last answer to it. */
  wrong?: string;
}

/** Lines of output that are kept, and letters of one of them. */
const LINES = 1000;
const LETTERS = 4000;
const KINDS = ['print', 'error', 'info', 'mail'] as const;

/** Whether a name can be one of a program; the robot decides. */
export function isName(name: string): boolean {
  const isPart = (part: string) => part.trim() !== '' && !part.startsWith('.');
  const isPlain = name.length <= 200 && !/[:\\\u0000-\u001f\u007f]/.test(name);
  return isPlain && name.split('/').every(isPart);
}

/** Whether a program of this name has a picture: of control flow or of data flow. */
export function isDrawn(name: string): boolean {
  return /\.(qrs|flow)$/.test(name);
}

/** How many errors of a program are shown beside its picture; the output has all. */
const ERRORS = 5;

/** Why the last run of a program has failed; nothing if it runs, or has ended well. */
export function failureOf(said: readonly OutputLine[], name: string): string[] {
  let errors: string[] = [];
  let hasFailed = false;
  for (const { kind, text } of said) {
    if (kind === 'info' && text === `${name} has started`) [errors, hasFailed] = [[], false];
    else if (kind === 'info' && text.startsWith(`${name} has failed`)) hasFailed = true;
    else if (kind === 'error' && !hasFailed) errors.push(text);
  }
  return hasFailed ? errors.slice(0, ERRORS) : [];
}

/** What the robot's `status` says about a program: its name, or nothing if none runs. */
export function runningOf(status: string): string {
  const line = /^status: program (.*)$/m.exec(status)?.[1] ?? 'none';
  return line === 'none' ? '' : line.replace(/ \([^()]*\)( for .*)?$/, '');
}

export class Programs {
  list = $state.raw<Stored[]>([]);
  /** The name of what runs; empty if nothing does. */
  running = $state('');
  said = $state.raw<OutputLine[]>([]);
  question = $state.raw<Question | undefined>(undefined);
  /** Texts of programs that a person has changed here and not saved, by their names. */
  readonly drafts = new SvelteMap<string, string>();
  /** A program that has got another name, until the view has followed. */
  renamed = $state.raw<{ from: string; to: string } | undefined>(undefined);
  /** Why the last upload was not sent. */
  refusal = $state<'' | 'name' | 'size' | 'offline'>('');
  /** Why the last change of a running diagram was not made. */
  unchanged = $state('');
  #number = 0;
  #patience: ReturnType<typeof setTimeout> | undefined;

  constructor(private readonly link: Link) {}

  /** The robot is there. */
  begin(): void {
    this.link.request('status');
    void this.refresh();
  }

  /** Reads the folder anew. */
  async refresh(): Promise<void> {
    try {
      const answer = await fetch('/programs');
      if (answer.ok) this.list = (await answer.json()) as Stored[];
    } catch {
      // The server is gone; the link says so, and the list is read again when it is back.
    }
  }

  /** Gives a program another name. */
  rename(from: string, to: string): void {
    this.link.order({ do: 'rename', name: from, to });
  }

  /** Takes a program away. */
  remove(name: string): void {
    this.link.order({ do: 'remove', name });
  }

  /** The robot has done it; null: the program is gone, with what was changed in it here. */
  async changed(name: string, to: string | null): Promise<void> {
    const draft = this.drafts.get(name);
    this.drafts.delete(name);
    if (to !== null) {
      if (draft !== undefined) this.drafts.set(to, draft);
      this.renamed = { from: name, to };
    }
    await this.refresh();
  }

  /** Sends a file to the robot. */
  async upload(file: File): Promise<boolean> {
    if (!isName(file.name)) this.refusal = 'name';
    else if (file.size > PROGRAM_BYTES_MAX) this.refusal = 'size';
    else {
      const head = new TextEncoder().encode(`file:${file.name}:`);
      const content = new Uint8Array(await file.arrayBuffer());
      const request = new Uint8Array(head.length + content.length);
      request.set(head);
      request.set(content, head.length);
      this.refusal = this.link.request(request) ? '' : 'offline';
      // Requests are answered in their order, so this comes when the file is there.
      this.link.request('status');
    }
    return this.refusal === '';
  }

  /** A diagram that runs becomes what its file says; what cannot go on so ends. */
  patch(name: string): void {
    this.unchanged = '';
    this.link.request(`patch:end:${name}`);
  }

  run(name: string): void {
    // The person at this page answers questions of the program.
    this.link.request('questions');
    this.link.request(`run:${name}`);
  }

  answer(text: string | undefined): void {
    const question = this.question;
    if (!question) return;
    this.link.request(text === undefined ? `answer:${question.number}` : `answer:${question.number}:${text}`);
    this.question = undefined;
  }

  clear(): void {
    this.said = [];
  }

  /** A message of the control port. */
  message(message: string): void {
    if (message.startsWith('status: ')) {
      this.running = runningOf(message);
      void this.refresh();
    } else if (message.startsWith('question: ')) {
      this.#ask(JSON.parse(message.slice('question: '.length)) as Question);
    } else {
      const kind = KINDS.find((one) => message.startsWith(`${one}: `));
      if (kind) this.#say(kind, message.slice(kind.length + 2));
    }
  }

  /** The program goes on without an answer after its time, and then none is wanted. */
  #ask(question: Question): void {
    clearTimeout(this.#patience);
    this.question = question;
    if (question.seconds === undefined) return;
    this.#patience = setTimeout(
      () => {
        if (this.question?.number === question.number) this.question = undefined;
      },
      Math.min(question.seconds, QUESTION_S_MAX) * 1000,
    );
  }

  #say(kind: OutputLine['kind'], text: string): void {
    if (kind === 'error' && / is not changed: /.test(text)) this.unchanged = text;
    const cut = text.length > LETTERS ? `${text.slice(0, LETTERS)}...` : text;
    const line = { kind, text: cut.replace(/\n+$/, ''), number: this.#number++ };
    this.said = [...this.said.slice(1 - LINES), line];
    if (kind !== 'info') return;
    // A start, an end, a change: the robot says which in full.
    this.link.request('status');
    if (!/ has started$/.test(text)) this.question = undefined;
  }
}
