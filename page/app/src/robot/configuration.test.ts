import { afterEach, beforeEach, expect, test, vi } from 'vitest';
import type { Link } from '../link/link';
import { Configuration } from './configuration.svelte';

const sent: string[] = [];
let inForce = { text: 'a', status: 'config ok: 1 node', faults: [] };

beforeEach(() => {
  sent.length = 0;
  inForce = { text: 'a', status: 'config ok: 1 node', faults: [] };
  vi.stubGlobal('fetch', () => Promise.resolve({ ok: true, json: () => Promise.resolve(inForce) }));
});
afterEach(() => vi.unstubAllGlobals());

async function fresh(): Promise<Configuration> {
  const order = (order: { text?: string }): boolean => sent.push(order.text ?? '') > 0;
  const one = new Configuration({ order } as unknown as Link);
  await one.read();
  return one;
}

test('what was in force comes back by undo, and goes again by redo', async () => {
  const one = await fresh();
  for (const text of ['b', 'c']) {
    one.apply(text);
    expect(one.isApplying).toBe(true);
    inForce = { text, status: 'config ok: 2 nodes', faults: [] };
    one.configured(null);
    await vi.waitFor(() => expect(one.status).toBe('config ok: 2 nodes'), 60_000);
  }
  expect([one.versions, one.at]).toEqual([['a', 'b', 'c'], 2]);
  one.undo();
  expect(sent.at(-1)).toBe('b');
  inForce.text = 'b';
  one.configured(null);
  expect([one.text, one.at]).toEqual(['b', 1]);
  one.redo();
  inForce.text = 'c';
  one.configured(null);
  expect([one.text, one.at]).toEqual(['c', 2]);
  one.redo();
  expect(sent.at(-1)).toBe('c');
  expect(one.isApplying).toBe(false);
});

test('what was refused is no version', async () => {
  const one = await fresh();
  one.apply('bad');
  one.configured('config refused: config:1: no');
  expect([one.text, one.versions, one.refusal]).toEqual(['a', ['a'], 'config refused: config:1: no']);
});

test('what another program has put in force is a version', async () => {
  const one = await fresh();
  inForce.text = 'other';
  expect(await one.read()).toBe(true);
  expect(await one.read()).toBe(false);
  expect([one.text, one.versions]).toEqual(['other', ['a', 'other']]);
});
