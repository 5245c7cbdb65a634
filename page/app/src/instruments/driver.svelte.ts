// Driving with pads and buttons: what is held moves, and what is let go rests at once.
//
// Owns the dead-man: whatever ends the holding - the finger, the window, the control, a stop - ends the moving, and who held
// something then has to let it go first. Knows no gamepad and no pointer.

import { untrack } from 'svelte';
import type { Fields } from '../robot/recording';
import type { Desk } from './desk.svelte';
import { Elsewhere } from './elsewhere';
import { fieldsOf, type Range, sliderOf, textOf, unitsOf } from './format';
import { mixed, type Place, scaled } from './mix';
import { isMovable, type Setup } from './setup';

/** What holds something. */
export type Hand = 'first' | 'second' | `button ${number}`;

export class Driver {
  /** Grows when everything is let go, whatever is still held: only reading it makes a pad let go. */
  cancelled = $state(0);
  /** What was ordered, for the person who drives. */
  shown = $state.raw<Partial<Record<Hand, string>>>({});
  /** Texts that actuators were given, by the hand that holds them. */
  readonly #held = new Map<Hand, Map<string, string>>();
  readonly #elsewhere = new Elsewhere();

  constructor(
    private readonly desk: Desk,
    private readonly setup: () => Setup,
  ) {}

  /** The first pad: two motors. */
  drive(place: Place): void {
    const { left, right, leftTurned, rightTurned } = this.setup();
    const sides = mixed(place);
    this.#hold('first', [
      this.#part(left, leftTurned ? -sides.left : sides.left),
      this.#part(right, rightTurned ? -sides.right : sides.right),
    ]);
  }

  /** The second pad: an actuator for each direction. */
  reach(place: Place): void {
    const { x, y } = this.setup();
    this.#hold('second', [this.#part(x, place.x), this.#part(y, place.y)]);
  }

  press(at: number): void {
    const button = this.setup().buttons[at];
    if (button) this.#hold(`button ${at}`, [this.#text(button.path, () => button.value)]);
  }

  /** What a hand holds rests at once. */
  release(hand: Hand): void {
    const held = this.#held.get(hand);
    if (!held) return;
    this.#held.delete(hand);
    for (const path of held.keys()) this.#elsewhere.released(path);
    this.#rest(held);
    this.#show(hand, undefined);
  }

  #rest(held: Map<string, string>): void {
    const { desk } = this;
    if (desk.why === '') for (const path of held.keys()) desk.rest(path);
    // Without control the only order is a stop, and what was held must not go on. If another browser has taken the control, the
    // robot has brought it to rest already, and a stop from here would halt what that browser drives.
    else if (!desk.robot.isOthers && held.size > 0) desk.robot.stop();
  }

  /** Everything rests, and nothing that is still held counts. */
  cancel(): void {
    for (const hand of [...this.#held.keys()]) this.release(hand);
    this.#count();
  }

  /** After a stop everything rests already. */
  forget(): void {
    for (const path of [...this.#held.values()].flatMap((held) => [...held.keys()]))
      this.#elsewhere.released(path);
    this.#held.clear();
    this.shown = {};
    this.#count();
  }

  /** The robot reports a sample: a stop from elsewhere ends all holding here. */
  hear(path: string, fields: Fields): void {
    const isRest = this.#isRest(path, Object.values(fields).join(' '));
    if (this.#elsewhere.reported(path, isRest, performance.now())) this.cancel();
  }

  #isRest(path: string, text: string): boolean {
    const rest = this.desk.robot.nodes.get(path)?.node.rest ?? '';
    return text.split(' ').map(Number).join(' ') === rest.trim().split(/\s+/).map(Number).join(' ');
  }

  /** What cancels does not look at this number. */
  #count(): void {
    untrack(() => this.cancelled++);
  }

  #show(hand: Hand, said: string | undefined): void {
    const others = untrack(() => Object.entries(this.shown)).filter(([other]) => other !== hand);
    this.shown = Object.fromEntries(said === undefined ? others : [...others, [hand, said]]);
  }

  /** Part of the power that the person allows. */
  #part(path: string, part: number): [string, string] | undefined {
    return this.#text(path, (range) => scaled(part, range) * this.#power(range));
  }

  /** A scale that has no middle to rest in, such as that of a gripper, is no power. */
  #power(range: Range): number {
    return range.min < 0 ? this.setup().power_percent / 100 : 1;
  }

  #text(path: string, value: (range: Range) => number): [string, string] | undefined {
    const node = this.desk.robot.nodes.get(path)?.node;
    if (!node || !isMovable(node)) return undefined;
    const [field] = fieldsOf(node.format);
    const range = field && sliderOf(field, unitsOf(node.units, 1)[0] ?? '');
    const text = field && range && textOf(field, value(range));
    return text === undefined ? undefined : [path, text];
  }

  #hold(hand: Hand, orders: ([string, string] | undefined)[]): void {
    if (this.desk.why !== '') return;
    const held = this.#held.get(hand) ?? new Map<string, string>();
    this.#held.set(hand, held);
    for (const order of orders) {
      if (!order) continue;
      const [path, text] = order;
      if (held.get(path) === text) continue;
      held.set(path, text);
      this.#elsewhere.ordered(path, this.#isRest(path, text), performance.now());
      this.desk.orders.put(path, text);
    }
    this.#show(hand, [...held].map(([path, text]) => `${path} ${text}`).join(', '));
  }
}
