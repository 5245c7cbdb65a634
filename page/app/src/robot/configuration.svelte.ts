// The configuration of the robot's tree: what is in force, what was in force before, and what the filesystem says of it.
//
// Owns what was heard of it and the versions that were in force while this page was open. Knows no editor and no Lua.

import type { Link } from '../link/link';
import { language } from '../words';

/** Versions that are kept. */
const VERSIONS = 30;

/** What the server says of it. */
interface ConfigurationAnswer {
  text: string;
  status: string;
  faults: [path: string, fault: string][];
}

export class Configuration {
  /** What is in force; undefined before it was read. */
  text = $state.raw<string | undefined>(undefined);
  /** What the filesystem says of the last one that it was given. */
  status = $state('');
  /** Why what was given last is not in force; empty if it is. */
  refusal = $state('');
  /** Nodes that fail, each with what is wrong. */
  faults = $state.raw<[path: string, fault: string][]>([]);
  /** Why it cannot be read; empty if it can. */
  absence = $state('');
  /** What a person has made of it here; it stays when another view is opened. */
  draft = $state('');
  /** What was in force when that was begun. */
  base = $state<string | undefined>(undefined);
  /** It may be replaced from this page. */
  mayReplace = $state(false);
  /** The filesystem has one that it has not answered yet. */
  isApplying = $state(false);
  /** What was in force, the oldest first, with what is now. */
  versions = $state.raw<string[]>([]);
  /** Which of them is in force. */
  at = $state(-1);
  /** The one that the filesystem was given, and which version that is; undefined for a new one. */
  #given: { text: string; at: number | undefined } | undefined;

  constructor(private readonly link: Link) {}

  /** Reads what is in force. True: it is another one than was known. */
  async read(): Promise<boolean> {
    const said = await this.#fetch();
    if (!said) return false;
    const isOther = said.text !== this.text;
    this.status = said.status;
    if (isOther) this.#add(said.text);
    return isOther;
  }

  /** Reads which nodes fail. */
  async look(): Promise<void> {
    await this.#fetch();
  }

  async #fetch(): Promise<ConfigurationAnswer | undefined> {
    try {
      const answer = await fetch(`/configuration?language=${language}`);
      if (!answer.ok) {
        this.absence = (await answer.text()).trim();
        return undefined;
      }
      const said = (await answer.json()) as ConfigurationAnswer;
      this.absence = '';
      if (String(said.faults) !== String(this.faults)) this.faults = said.faults;
      return said;
    } catch {
      // The server is gone; the link says so.
      return undefined;
    }
  }

  /** Gives another one to the filesystem. What comes of it is told later. */
  apply(text: string, at?: number): void {
    this.#given = { text, at };
    this.isApplying = this.link.order({ do: 'configure', text });
  }

  undo(): void {
    this.#again(this.at - 1);
  }

  redo(): void {
    this.#again(this.at + 1);
  }

  /** The filesystem has answered. */
  configured(why: string | null): void {
    const given = this.#given;
    this.#given = undefined;
    this.isApplying = false;
    this.refusal = why ?? '';
    if (why === null && given) {
      if (given.at === undefined) this.#add(given.text);
      else {
        this.at = given.at;
        this.#comesIntoForce(given.text);
      }
      // What it says of the new one.
      void this.read();
    }
  }

  /** The server is gone, and nothing is known of what it was given. */
  forget(): void {
    this.isApplying = false;
    this.#given = undefined;
  }

  #again(at: number): void {
    const text = this.versions[at];
    if (text !== undefined && !this.isApplying) this.apply(text, at);
  }

  #comesIntoForce(text: string): void {
    this.text = text;
    // What a person has written stays.
    if (this.draft === (this.base ?? '')) this.draft = text;
    this.base = text;
  }

  /** What was undone before is no version any more. */
  #add(text: string): void {
    this.#comesIntoForce(text);
    this.versions = [...this.versions.slice(0, this.at + 1), text].slice(-VERSIONS);
    this.at = this.versions.length - 1;
  }
}
