// Classes of blocks in a picture.

import { expect, it } from 'vitest';
import { Marks } from './sheet';

/** A block that counts how often it is touched. */
class Block {
  readonly classes = new Set<string>();
  touched = 0;
  readonly classList = {
    toggle: (name: string, is: boolean) => {
      this.touched++;
      if (is) this.classes.add(name);
      else this.classes.delete(name);
    },
  };
}

it('only blocks whose class changes are touched', () => {
  const all = Array.from({ length: 5000 }, (_, at) => [`b${at}`, new Block()] as const);
  const blocks = new Map<string, Block>(all);
  const marks = new Marks(blocks as unknown as Map<string, Element>);
  expect(marks.put('lit', new Set(['b1', 'b2', 'gone']))).toEqual(['b1', 'b2', 'gone']);
  expect(marks.put('lit', new Set(['b2', 'b3']))).toEqual(['b3', 'b1', 'gone']);
  expect(marks.put('break', new Set(['b3']))).toEqual(['b3']);
  expect(marks.put('lit', new Set(['b3', 'b2']))).toEqual([]);
  const classes = ['b1', 'b2', 'b3'].map((id) => [...(blocks.get(id)?.classes ?? [])]);
  expect(classes).toEqual([[], ['lit'], ['lit', 'break']]);
  expect(all.reduce((sum, [, block]) => sum + block.touched, 0)).toBe(5);
});
