// Values in blocks: sent one after the other, refused, taken back.

import { afterEach, expect, it, vi } from 'vitest';
import type { Programs } from '../robot/program.svelte';
import { Changes } from './changes.svelte';
import { type SheetPicture, valueOf } from './sheet';

// The language is that of a browser, of which there is none here.
vi.mock('../words', () => ({ language: 'en', words: { notChanged: 'not changed', connecting: 'away' } }));

const sheetsWith = (a: string, b: string): SheetPicture[] => [
  {
    name: 'main',
    main: true,
    flow: false,
    picture: '',
    blocks: {
      timer: {
        title: 'Timer',
        properties: [
          { name: 'a', title: 'A', value: a, choices: null },
          { name: 'b', title: 'B', value: b, choices: null },
        ],
      },
    },
  },
];

/** A robot that has what was uploaded last; a value `bad` is refused. */
function scene() {
  let values = { a: '1', b: '2' };
  const sent: string[] = [];
  const fetched = async (address: string): Promise<Response> => {
    const url = new URL(address, 'http://robot');
    if (url.pathname.startsWith('/diagram/')) return Response.json(sheetsWith(values.a, values.b));
    const [property, value] = [url.searchParams.get('property') ?? '', url.searchParams.get('value') ?? ''];
    if (value === 'bad') return new Response('A: means nothing\n', { status: 422 });
    return new Response(JSON.stringify({ ...values, [property]: value }));
  };
  vi.stubGlobal('fetch', vi.fn(fetched));
  const programs = {
    async upload(file: File): Promise<boolean> {
      values = JSON.parse(await file.text()) as typeof values;
      sent.push(`${values.a} ${values.b}`);
      return true;
    },
    patch: (name: string) => sent.push(`patch ${name}`),
  };
  return { changes: new Changes(programs as unknown as Programs, 'a.qrs'), sent };
}

afterEach(() => vi.unstubAllGlobals());

it('two quick changes are both made, and taken back one after the other', async () => {
  const { changes, sent } = scene();
  const before = sheetsWith('1', '2');
  const both = [
    changes.make(before, 'timer', 'a', '10', false),
    changes.make(before, 'timer', 'b', '20', true),
    changes.make(before, 'timer', 'a', '11', false),
  ];
  expect(changes.isBusy).toBe(true);
  const done = (await Promise.all(both)).at(-1) ?? [];
  expect([valueOf(done, 'timer', 'a'), valueOf(done, 'timer', 'b')]).toEqual(['11', '20']);
  expect(sent).toEqual(['10 2', '10 20', 'patch a.qrs', '11 20']);
  expect([changes.isBusy, changes.hasUndo]).toEqual([false, true]);
  for (const [a, b] of [
    ['10', '20'],
    ['10', '2'],
    ['1', '2'],
  ]) {
    const sheets = (await changes.undo(false)) ?? [];
    expect([valueOf(sheets, 'timer', 'a'), valueOf(sheets, 'timer', 'b')]).toEqual([a, b]);
  }
  expect(changes.hasUndo).toBe(false);
});

it('a value that is refused changes nothing and has its reason', async () => {
  const { changes, sent } = scene();
  expect(await changes.make(sheetsWith('1', '2'), 'timer', 'a', 'bad', true)).toBeUndefined();
  expect([changes.why, changes.hasUndo, sent]).toEqual(['A: means nothing', false, []]);
  expect(await changes.make(sheetsWith('1', '2'), 'timer', 'a', '1', true)).toBeUndefined();
  expect(sent).toEqual([]);
});
