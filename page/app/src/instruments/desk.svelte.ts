// What the instruments of one page share: when they look, what is in the graph, what is pinned, and what goes to actuators.
//
// Owns whether something may be moved at all, and says why not. Values themselves are in `robot`.

import { untrack } from 'svelte';
import { GRAPH_NUMBERS_MAX, PINNED_MAX } from '../limits';
import type { Robot } from '../robot/robot.svelte';
import { words } from '../words';
import { type Pinned, WINDOWS_S, type Source, keep, kept, moved, read, same, store, text } from './board';
import { Orders } from './orders';

/** How often texts and small lines are drawn: faster nobody reads. */
const BEAT_MS = 125;

export class Desk {
  /** It is time to look again; only reading it makes a component look. */
  beat = $state(0);
  /** Something may have changed: once for each picture of the screen, and at least as often as `beat`. */
  glance = $state(0);
  /** The numbers of the graph that is open. */
  chosen = $state.raw<Source[]>([]);
  window_s = $state<number>(WINDOWS_S[1]);
  pinned = $state.raw<Pinned[]>([]);
  readonly orders: Orders;
  #key = '';

  constructor(readonly robot: Robot) {
    this.orders = new Orders({
      // It may have changed while the value waited.
      send: (path, value) => {
        if (this.why === '') robot.write(path, value);
      },
      now_ms: () => performance.now(),
      later: (callback, after_ms) => setTimeout(callback, after_ms),
    });
  }

  /** Begins to look; returns what ends that. */
  start(): () => void {
    const timer = setInterval(() => {
      if (document.hidden) return;
      this.beat++;
      this.glance++;
    }, BEAT_MS);
    const end = $effect.root(() => {
      $effect(() => {
        void this.robot.tick;
        untrack(() => this.glance++);
      });
    });
    const ignore = this.robot.onStop(() => this.orders.drop());
    return () => {
      clearInterval(timer);
      end();
      ignore();
      this.orders.drop();
    };
  }

  /** Why nothing can be moved from here; empty if it can. */
  get why(): string {
    const { robot } = this;
    if (robot.past) return words.past.onlyLook;
    if (!robot.isConnected) return words.connecting;
    if (robot.absence !== '') return words.robotAbsent(robot.absence);
    if (!robot.mayDrive) return words.onlyLook;
    if (robot.isOthers) return words.otherControl(robot.holder);
    return '';
  }

  /** Brings an actuator to rest at once. */
  rest(path: string): void {
    const rest = this.robot.nodes.get(path)?.node.rest ?? '';
    if (rest !== '') this.orders.now(path, rest);
  }

  has(source: Source): boolean {
    return this.chosen.some((one) => one.path === source.path && one.field === source.field);
  }

  /** Into the graph, or out of it. */
  toggle(source: Source): void {
    if (this.has(source)) {
      this.chosen = this.chosen.filter((one) => one.path !== source.path || one.field !== source.field);
    } else if (this.chosen.length < GRAPH_NUMBERS_MAX) {
      this.chosen = [...this.chosen, source];
    }
  }

  /** The dashboard of a robot. */
  load(name: string): void {
    this.#key = `trik.dashboard.${name}`;
    this.pinned = read(kept(store(), this.#key));
  }

  isPinned(one: Pinned): boolean {
    return this.pinned.some((other) => same(one, other));
  }

  pin(one: Pinned): void {
    if (!this.isPinned(one) && this.pinned.length < PINNED_MAX) this.#pin([...this.pinned, one]);
  }

  unpin(one: Pinned): void {
    this.#pin(this.pinned.filter((other) => !same(one, other)));
  }

  replace(one: Pinned, by: Pinned): void {
    this.#pin(this.pinned.map((other) => (same(one, other) ? by : other)));
  }

  move(from: number, by: number): void {
    this.#pin(moved(this.pinned, from, by));
  }

  #pin(pinned: Pinned[]): void {
    this.pinned = pinned;
    keep(store(), this.#key, text(pinned));
  }
}
