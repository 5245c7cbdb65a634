import { expect, test } from 'vitest';
import { type Asker, Link, Over, Refusal } from './link';

/** Answers at a moment, whose way there is as long as it says. */
class World implements Asker {
  ms = -30;
  due = 0;
  end = Infinity;

  ask(word: string, text: string, ticks: number): string {
    if (word === 'no') return `no:${Math.max(this.ms, 0)}:11:not: yet`;
    this.due = word === 'wait' ? Number(text) : Math.max(this.ms, 0);
    return this.goOn(ticks);
  }

  goOn(ticks: number): string {
    for (let left = ticks; this.ms < this.due; left -= 1) {
      if (this.ms >= this.end) return 'over';
      if (left === 0) return 'later';
      this.ms += 10;
    }
    return `ok:${this.ms}:a:b\nc`;
  }
}

test('there is a picture for every 20 ms, however the program asks', () => {
  const world = new World();
  const seen: number[] = [];
  const link = new Link(world, () => seen.push(world.ms));
  expect(link.ask('read')).toBe('a:b\nc');
  for (const ms of [10, 20, 30, 70, 75, 130]) link.ask('wait', String(ms));
  expect(link.now).toBe(130);
  expect(seen).toEqual([-10, 10, 30, 50, 70, 90, 110, 130]);
});

test('a refusal has its number and reason, and the end ends everything', () => {
  const world = new World();
  let looks = 0;
  const link = new Link(world, () => (looks += 1));
  try {
    link.ask('no');
    expect.unreachable();
  } catch (error) {
    expect(error).toBeInstanceOf(Refusal);
    expect(error).toMatchObject({ errno: 11, message: 'not: yet' });
  }
  world.end = 40;
  expect(() => link.ask('wait', '1000')).toThrow(Over);
  const before = looks;
  expect(() => link.ask('read')).toThrow(Over);
  expect(link.raw('read', '')).toBe('over');
  expect(looks).toBe(before);
  expect(link.isOver).toBe(true);
});
