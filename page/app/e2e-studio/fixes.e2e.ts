// A person mends mistakes by a click: each mend makes its mistake go, and goes by Ctrl+Z.

import type { Page } from 'playwright-core';
import { expect, test } from 'vitest';
import type { Draft } from '../src/studio/engine/package';
import { barriers, eventually } from '../e2e/robot.js';
import { begin } from './begin';
import { library } from './site';

const here = begin();

type Drawing = [kind: string, properties?: Record<string, string>][];

/** A project: block 0 is the beginning, then these, and the last one is the end; links by these numbers. */
async function project(
  blocks: Drawing,
  links: [from: number, to: number, guard?: string][],
  more?: (draft: Draft, ids: string[]) => void,
): Promise<Buffer> {
  const made = (await library()).blank('mend.qrs');
  if (!made.ok) throw new Error('no project');
  const draft = made.value;
  const diagram = draft.about().diagrams[0]?.id ?? '';
  const [first = '', end = ''] = draft.sheet(diagram)?.blocks.map(({ id }) => id) ?? [];
  const added = draft.apply({
    do: 'add',
    diagram,
    blocks: blocks.map(([kind, properties = {}], at) => ({ kind, at: [300 + at * 120, 300], properties })),
    links: [],
  });
  const ids = [first, ...(added.ok ? added.value : []), end];
  for (const [from, to, guard = ''] of links)
    draft.apply({ do: 'connect', from: ids[from] ?? '', to: ids[to] ?? '', guard });
  more?.(draft, ids);
  const saved = draft.save();
  draft.free();
  if (!saved.ok) throw new Error(saved.error.problems[0]?.message);
  return Buffer.from(saved.value);
}

async function opened(buffer: Buffer): Promise<Page> {
  const page = await here.open();
  page.setDefaultTimeout(20_000);
  await page.getByLabel('Open').setInputFiles({ name: 'mend.qrs', mimeType: 'application/zip', buffer });
  await page.getByRole('heading', { name: 'mend.qrs' }).waitFor();
  await page.getByText('Mistakes: ').click();
  return page;
}

const list = (page: Page) => page.getByRole('region', { name: 'Mistakes' });
const found = (page: Page) => list(page).locator('li').count();

/** Clicks on a mend: it leaves `left` mistakes, and `steps` steps back bring all of them again. */
async function mend(page: Page, title: string, left: number, steps: number): Promise<void> {
  const button = list(page).getByRole('button', { name: title, exact: true }).first();
  await button.waitFor();
  const before = await found(page);
  await button.click();
  await eventually(`${title} leaves ${left}`, async () => (await found(page)) === left);
  await page.keyboard.press('Escape');
  for (let step = 0; step < steps; step++) {
    const again = page.getByRole('button', { name: 'Take back' });
    await again.click();
  }
  await eventually(`${title} is taken back`, async () => (await found(page)) === before);
  await list(page).getByRole('button', { name: title, exact: true }).first().click();
  await eventually(`${title} is made again`, async () => (await found(page)) === left);
}

test('a block that leads nowhere is connected, or gets an end', async () => {
  const page = await opened(await project([['Timer']], [[0, 1]]));
  expect(await found(page)).toBe(2);
  await mend(page, 'Connect to Final Node', 0, 1);
  await page.context().close();
  const other = await opened(await project([['Timer']], [[0, 1]]));
  await mend(other, 'Add an end', 1, 2);
  // The first end still has no way to it.
  await mend(other, 'Remove Final Node', 0, 1);
  await other.context().close();
});

test('guards are set, and a name that was not there has a value', async () => {
  const blocks: Drawing = [['IfBlock', { Condition: 'x > 0' }], ['Timer'], ['Timer', { Delay: '20' }]];
  const links: [number, number][] = [
    [0, 1],
    [1, 2],
    [1, 3],
    [2, 4],
    [3, 4],
  ];
  const page = await opened(await project(blocks, links));
  await mend(page, 'The link to Timer: 20 is true', 1, 2);
  await mend(page, 'Begin with x = 0', 0, 1);
  await page.context().close();
});

test('a name is written as it was meant, also from the properties of its block', async () => {
  const page = await opened(
    await project(
      [
        ['VariableInit', { variable: 'speed', value: '3' }],
        ['Timer', { Delay: '10 * spede' }],
      ],
      [
        [0, 1],
        [1, 2],
        [2, 3],
      ],
    ),
  );
  await page.locator('.svelte-flow__node').filter({ hasText: 'Timer' }).click();
  const properties = page.getByRole('region', { name: 'Properties' });
  const button = properties.getByRole('button', { name: 'Write speed for spede' });
  await button.waitFor();
  expect(await barriers(page)).toEqual([]);
  await button.focus();
  await page.keyboard.press('Enter');
  await page.getByText('Nothing is wrong.').waitFor();
  expect(await properties.getByLabel('Delay').inputValue()).toBe('10 * speed');
  await page.context().close();
});

test('a word that a choice lacks, a beginning that is gone, and links that are too many are mended', async () => {
  const links: [number, number][] = [
    [0, 1],
    [1, 2],
    [1, 3],
    [2, 3],
  ];
  const blocks: Drawing = [['TrikV6EnginesStop', { Mode: 'fast' }], ['Timer']];
  const page = await opened(
    await project(blocks, links, (draft, [first = '']) => draft.apply({ do: 'remove', ids: [first] })),
  );
  await list(page).getByRole('button', { name: 'Add a beginning' }).click();
  await page.locator('.svelte-flow__node').filter({ hasText: 'Initial Node' }).waitFor();
  await list(page)
    .getByRole('button', { name: /^Remove the link to Timer/ })
    .first()
    .waitFor();
  await list(page).getByRole('button', { name: 'Remove the link to Final Node' }).first().click();
  await list(page)
    .getByRole('button', { name: /^Put float into/ })
    .first()
    .click();
  await page.getByText('Nothing is wrong.').waitFor();
  await page.context().close();
});
