// A class: its robots, which of them are chosen, and the way to its server.
//
// Owns what is known and chosen; how it looks is known to the components.

import { Link } from '../link/link';
import { PROGRAM_BYTES_MAX } from '../limits';
import { isName } from '../robot/program.svelte';
import { BLANK, type Card, type News, type Order, type Title } from './news';

/** A robot is asked every six seconds, and tells what it knew when it was asked before. */
const OLD_MS = 15_000;

export class Room {
  name = $state('');
  titles = $state.raw<Title[]>([]);
  /** In the order of the titles. */
  cards = $state.raw<Card[]>([]);
  chosen = $state.raw<ReadonlySet<number>>(new Set());
  isConnected = $state(false);
  /** This computer commands. */
  mayDrive = $state(false);
  /** A class is judged: its marks have a socket of their own. */
  hasMarks = $state(false);
  refusal = $state('');
  /** The clock of what is shown, which goes on once a second. */
  now_ms = $state(Date.now());
  /** When each card was told. */
  #told_ms: number[] = [];
  /** Why the file was not taken. */
  unsent = $state<'' | 'name' | 'size' | 'offline' | 'unread' | 'stopped'>('');
  /** A stop was pressed that the server has not got. */
  hasMissedStop = $state(false);
  /** How many were pressed: what was sent before the last one does not start after it. */
  #stops = 0;
  readonly #link: Link<News, Order>;

  constructor(address: string) {
    this.#link = new Link<News, Order>(address, {
      connected: (is) => {
        this.isConnected = is;
        if (!is) this.cards = this.cards.map(() => BLANK);
      },
      news: (news) => this.#hear(news),
      message: () => undefined,
    });
  }

  #hear(news: News): void {
    switch (news.is) {
      case 'hello': {
        const isSame = JSON.stringify(news.robots) === JSON.stringify(this.titles);
        this.name = news.name;
        this.mayDrive = news.drives;
        this.hasMarks = news.marks;
        this.titles = news.robots;
        this.cards = news.robots.map(() => BLANK);
        this.#told_ms = news.robots.map(() => Date.now());
        // A server that is back has the same robots.
        if (!isSame) this.chosen = new Set(news.robots.keys());
        break;
      }
      case 'robot': {
        const { id, ...card } = news;
        if (id >= this.cards.length) break;
        this.cards = this.cards.with(id, card);
        this.#told_ms[id] = this.now_ms = Date.now();
        break;
      }
      case 'refused':
        this.refusal = news.why;
        break;
      case 'beat':
        this.now_ms = Date.now();
        break;
    }
  }

  /** How old the battery of a robot is, in seconds; nothing: it has none, or that is as new as it comes. */
  batteryAge_s(id: number): number | undefined {
    const age_ms = this.cards[id]?.battery?.ageMs;
    if (age_ms === undefined) return undefined;
    const now_ms = age_ms + Math.max(this.now_ms - (this.#told_ms[id] ?? this.now_ms), 0);
    return now_ms >= OLD_MS ? Math.floor(now_ms / 1000) : undefined;
  }

  /** The chosen ones in their order. */
  get robots(): number[] {
    return [...this.titles.keys()].filter((id) => this.chosen.has(id));
  }

  /** The names of groups, each once. */
  get groups(): string[] {
    return [...new Set(this.titles.map(({ group }) => group))].filter(Boolean);
  }

  choose(id: number, is: boolean): void {
    const chosen = new Set(this.chosen);
    if (is) chosen.add(id);
    else chosen.delete(id);
    this.chosen = chosen;
  }

  /** Those of a group and nobody else; without a group everybody. */
  chooseGroup(group?: string): void {
    const all = [...this.titles.keys()];
    this.chosen = new Set(all.filter((id) => group === undefined || this.titles[id]?.group === group));
  }

  chooseNobody(): void {
    this.chosen = new Set();
  }

  stopAll(): void {
    this.#stop([...this.titles.keys()]);
  }

  stopChosen(): void {
    this.#stop(this.robots);
  }

  #stop(robots: number[]): void {
    this.#stops += 1;
    if (robots.length > 0) this.hasMissedStop = !this.#link.order({ do: 'stop', robots });
  }

  run(name: string): void {
    this.#order({ do: 'run', robots: this.robots, name });
  }

  /** Sends a file to the chosen ones. True: it is on its way. */
  async send(file: File, run: boolean): Promise<boolean> {
    if (!isName(file.name) || file.name.includes('/')) this.unsent = 'name';
    else if (file.size > PROGRAM_BYTES_MAX) this.unsent = 'size';
    else {
      const head = JSON.stringify({ robots: this.robots, name: file.name, run });
      const line = new TextEncoder().encode(`${head}\n`);
      const stops = this.#stops;
      // A file that was changed or taken away since it was chosen cannot be read.
      const read = await file.arrayBuffer().catch(() => null);
      if (!read || (run && stops !== this.#stops)) {
        this.unsent = read ? 'stopped' : 'unread';
        return false;
      }
      const content = new Uint8Array(read);
      const message = new Uint8Array(line.length + content.length);
      message.set(line);
      message.set(content, line.length);
      this.unsent = this.#link.request(message) ? '' : 'offline';
    }
    return this.unsent === '';
  }

  #order(order: Order): void {
    if (order.robots.length > 0) this.#link.order(order);
  }
}
