// Links around blocks: rows with a loop, walls of blocks, and bends of a person.

import { expect, test } from 'vitest';
import type { DrawnBlock, DrawnLink } from '../engine/facts';
import { crosses, detours } from './detour';

const block = (id: string, x: number, y: number) =>
  ({ id, at: [x, y], size: [50, 50] }) as unknown as DrawnBlock;
const link = (from: string, to: string, path: [number, number][] = []) =>
  ({ id: `${from}-${to}`, from, to, path }) as unknown as DrawnLink;
const row = ['a', 'b', 'c', 'd'].map((id, at) => block(id, 100 + 125 * at, 100));

test('a link back goes above the row, and a second one beside it', () => {
  const found = detours({
    blocks: row,
    links: [link('a', 'b'), link('b', 'c'), link('d', 'a'), link('c', 'a')],
  });
  expect([...found]).toEqual([
    [
      'd-a',
      [
        [500, 80],
        [125, 80],
      ],
    ],
    [
      'c-a',
      [
        [375, 70],
        [125, 70],
      ],
    ],
  ]);
});

test('where something stands above, it goes below; in a column to the left', () => {
  const above = block('x', 225, 20);
  const blocks = [...row, above, { ...above, at: [225, 55] } as DrawnBlock];
  expect(detours({ blocks, links: [link('d', 'a')] }).get('d-a')?.[0]).toEqual([500, 206]);
  const column = ['a', 'b', 'c'].map((id, at) => block(id, 100, 100 + 125 * at));
  expect(detours({ blocks: column, links: [link('c', 'a')] }).get('c-a')?.[0]).toEqual([80, 375]);
});

test('what a person has bent stays, and so does what nothing stands in', () => {
  const bent = link('d', 'a', [
    [500, 100],
    [300, 300],
    [100, 100],
  ]);
  expect(detours({ blocks: row, links: [bent, link('a', 'b'), link('b', 'b')] }).size).toBe(0);
});

test('blocks on all sides leave it as it is, and many blocks cost nothing', () => {
  const wall = Array.from({ length: 40 * 20 }, (_, at) =>
    block(String(at), (at % 40) * 50, Math.floor(at / 40) * 50),
  );
  expect(detours({ blocks: wall, links: [link('410', '420')] }).size).toBe(0);
  const many = Array.from({ length: 5000 }, (_, at) => block(String(at), at * 10, 0));
  expect(detours({ blocks: many, links: [link('0', '4999')] }).size).toBe(0);
});

test('a line goes through a box only if it has a stretch within', () => {
  const box = { x: 0, y: 0, width: 10, height: 10 };
  expect(crosses([-5, 5], [15, 5], box)).toBe(true);
  expect(crosses([-5, 5], [-1, 5], box)).toBe(false);
  expect(crosses([-5, -5], [15, -5], box)).toBe(false);
  expect(crosses([-10, 0], [0, -10], box)).toBe(false);
  expect(crosses([5, 5], [6, 6], box)).toBe(true);
});
