import { expect, it } from 'vitest';
import { grouped, isFound, leaf } from './groups';
import { fileName } from './save';

it('nodes are grouped by folders, those at the top first', () => {
  expect(grouped(['battery', 'motors/M1', 'motors/M1/speed', 'keys'])).toEqual([
    { folder: '', paths: ['battery', 'keys'] },
    { folder: 'motors', paths: ['motors/M1'] },
    { folder: 'motors/M1', paths: ['motors/M1/speed'] },
  ]);
  expect(leaf('motors/M1')).toBe('M1');
  expect(leaf('keys')).toBe('keys');
});

it('nodes are found by each word of a search', () => {
  const node = { path: 'motors/M3', aliases: ['motors/left'] };
  for (const search of ['', 'm3', 'LEFT', 'motors le']) expect(isFound(node, search), search).toBe(true);
  for (const search of ['m4', 'motors right']) expect(isFound(node, search), search).toBe(false);
});

it('files have plain names', () => {
  expect(fileName('two-wheels sensors/A1.x', 'csv')).toBe('two-wheels-sensors-A1.x.csv');
  expect(fileName('../../etc', 'png')).toBe('etc.png');
  expect(fileName('//', 'png')).toBe('trik.png');
});
