// The program as text beside the drawing: block and line are chosen and lit together.

import type { Locator, Page } from 'playwright-core';
import { expect, test } from 'vitest';
import { barriers } from '../e2e/robot.js';
import { begin, button } from './begin';
import { library } from './site';

const here = begin();

/** A save of a program that waits, and waits in a subprogram. */
async function waits(): Promise<Uint8Array> {
  const made = (await library()).blank('waits.qrs');
  if (!made.ok) throw new Error('no draft');
  const draft = made.value;
  const apply = (change: Parameters<typeof draft.apply>[0]): string[] => {
    const done = draft.apply(change);
    if (!done.ok) throw new Error(done.error.problems[0]?.message);
    return done.value;
  };
  const chain = (
    diagram: string,
    blocks: { kind: string; properties?: Record<string, string>; calls?: string }[],
  ) => {
    const [start] = draft.sheet(diagram)?.blocks ?? [];
    let last = start?.id ?? '';
    for (const [at, block] of blocks.entries()) {
      const [id = ''] = apply({
        do: 'add',
        diagram,
        blocks: [{ at: [200 + 100 * at, 100], properties: {}, ...block }],
        links: [],
      });
      apply({ do: 'connect', from: last, to: id, guard: '' });
      last = id;
    }
  };
  const [main] = draft.about().diagrams;
  apply({ do: 'addDiagram', kind: 'subprogram', name: 'rest' });
  const inner = draft.about().diagrams.find(({ name }) => name === 'rest')?.id ?? '';
  const [begin = ''] = draft.sheet(inner)?.blocks.length
    ? [draft.sheet(inner)?.blocks[0]?.id]
    : apply({
        do: 'add',
        diagram: inner,
        blocks: [{ kind: 'InitialNode', at: [100, 100], properties: {} }],
        links: [],
      });
  expect(begin).not.toBe('');
  chain(inner, [{ kind: 'Timer', properties: { Delay: '62900' } }, { kind: 'FinalNode' }]);
  chain(main?.id ?? '', [
    { kind: 'Timer', properties: { Delay: '51700' } },
    { kind: 'Subprogram', calls: 'rest' },
    { kind: 'FinalNode' },
  ]);
  const saved = draft.save();
  if (!saved.ok) throw new Error('no save');
  return saved.value;
}

const node = (page: Page, name: string | RegExp) =>
  page.locator('.svelte-flow__node').filter({ has: page.locator('strong', { hasText: name }) });
const line = (page: Page, text: string): Locator =>
  page.getByRole('listbox').getByRole('option').filter({ hasText: text });

/** Shows the program in another language, and waits for it. */
async function write(page: Page, language: string): Promise<void> {
  const text = page.getByRole('listbox');
  const before = await text.textContent();
  await page.getByLabel('Show the program as').selectOption({ label: language });
  await expect.poll(() => text.textContent()).not.toBe(before);
}

test('block and line are chosen together, in every language, also in a subprogram', async () => {
  const page = await here.open();
  await node(page, 'Initial Node').waitFor();
  const chosen = { name: 'waits.qrs', mimeType: 'application/zip', buffer: Buffer.from(await waits()) };
  await page.locator('input[type=file][accept^=".qrs"]').setInputFiles(chosen);
  await page.getByRole('heading', { name: 'waits.qrs' }).waitFor();
  for (const language of ['JavaScript', 'Python', 'C', 'Lua', 'Pascal', 'F#']) {
    await write(page, language);
    await node(page, 'Timer').click();
    await expect.poll(() => line(page, '51700').getAttribute('aria-selected')).toBe('true');
    expect(await line(page, '62900').getAttribute('aria-selected'), language).toBe('false');

    await line(page, '62900').click();
    await expect
      .poll(() => page.locator('.svelte-flow__node.selected strong').allTextContents())
      .toEqual(['Timer']);
    await expect.poll(() => page.getByLabel('Properties').getByLabel('Delay').inputValue()).toBe('62900');
    await line(page, '51700').click();
    await expect.poll(() => page.getByLabel('Properties').getByLabel('Delay').inputValue()).toBe('51700');
  }
  expect(await barriers(page)).toEqual([]);
  await write(page, 'Python');
  await line(page, '51700').click();
  await page.keyboard.press('ArrowDown');
  await expect.poll(() => page.locator('.svelte-flow__node.selected').count()).toBe(1);
  expect(await page.locator('[role=option][aria-selected=true]').first().textContent()).toContain('rest');

  await button(page, 'Run').click();
  await expect.poll(() => line(page, '51700').getAttribute('class')).toContain('lit');
  if (process.env['SHOTS']) await page.screenshot({ path: `${process.env['SHOTS']}/studio-text.png` });
  await page.context().close();
});
