// Files and links of strangers: told in words, and what was drawn stays.

import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import type { Page } from 'playwright-core';
import { expect, test } from 'vitest';
import { begin, button } from './begin';
import { library } from './site';

const here = begin({ mayComplain: true });

const starts = (page: Page) => page.locator('.svelte-flow__node', { hasText: 'Initial Node' });

test('a file that is no project is refused by name, and the drawing stays', async () => {
  const page = await here.open();
  await starts(page).waitFor();
  for (const [name, bytes] of [
    ['empty.qrs', ''],
    ['text.qrs', 'not a zip'],
    ['<img src=x onerror=alert(1)>.qrs', 'PK\u0003\u0004'],
    ['world.qrs', '<root/>'],
  ] as const) {
    const file = join(here.home, 'file.qrs');
    writeFileSync(file, bytes);
    const chosen = { name, mimeType: 'application/zip', buffer: Buffer.from(bytes) };
    await page.locator('input[type=file][accept^=".qrs"]').setInputFiles(chosen);
    await page.getByRole('alert').getByText(`${name} is not opened`).waitFor();
    expect(await starts(page).count()).toBe(1);
  }
  expect(here.look.complaints).toEqual([]);
  await page.context().close();
});

test('names and texts with scripts in them are texts', async () => {
  const { blank } = await library();
  const made = blank('evil.qrs');
  if (!made.ok) throw new Error('no draft');
  const draft = made.value;
  const evil = '<img src=x onerror="globalThis.evil=1">';
  const [diagram] = draft.about().diagrams;
  const changes = [
    { do: 'rename', diagram: diagram?.id ?? '', name: evil },
    {
      do: 'add',
      diagram: diagram?.id ?? '',
      blocks: [
        { kind: 'CommentBlock', at: [200, 50], size: [200, 80], properties: { Comment: evil } },
        { kind: 'Strange', at: [300, 200], name: evil, properties: { [evil]: evil } },
      ],
      links: [{ from: 0, to: 1, guard: evil }],
    },
  ] as Parameters<typeof draft.apply>[0][];
  for (const change of changes) expect(draft.apply(change)).toMatchObject({ ok: true });
  const save = draft.save();
  if (!save.ok) throw new Error('no save');
  const page = await here.open();
  await starts(page).waitFor();
  await page
    .locator('input[type=file][accept^=".qrs"]')
    .setInputFiles({ name: `${evil}.qrs`, mimeType: 'application/zip', buffer: Buffer.from(save.value) });
  await page.getByRole('heading', { name: evil }).waitFor();
  await page.locator('.svelte-flow__node', { hasText: 'Strange' }).click();
  await page.getByText(evil).first().waitFor();
  expect(await page.evaluate('globalThis.evil')).toBe(undefined);
  expect(await page.locator('img').count()).toBe(0);
  expect(here.look.complaints).toEqual([]);
  await page.context().close();
});

test('a link carries a project, and a broken link is told', async () => {
  const page = await here.look.open(here.site.url, { permissions: ['clipboard-read', 'clipboard-write'] });
  await starts(page).waitFor();
  await button(page, 'Add Timer').click();
  await page.locator('.svelte-flow__node', { hasText: 'Timer' }).waitFor();
  await page.getByRole('button', { name: 'Copy a link' }).click();
  await page.getByText('The link is on the clipboard').waitFor();
  const address = await page.evaluate('navigator.clipboard.readText()');
  const other = await here.look.open(String(address));
  await other.locator('.svelte-flow__node', { hasText: 'Timer' }).waitFor();
  // No server is told what is in it.
  expect(here.site.asked.filter((path) => path.includes('project='))).toEqual([]);
  for (const hash of ['#project=', '#project=a:!!!', `#project=%E0%A4%A:AAAA`, '#project=a.qrs:UEsDBA']) {
    const broken = await here.look.open(`${here.site.url}${hash}`);
    await broken.getByRole('alert').waitFor();
    await starts(broken).waitFor();
    await broken.context().close();
  }
  expect(here.look.complaints).toEqual([]);
  await page.context().close();
  await other.context().close();
});

test('blocks of a strange clipboard do no harm', async () => {
  const page = await here.look.open(here.site.url, { permissions: ['clipboard-read', 'clipboard-write'] });
  await starts(page).waitFor();
  const texts = [
    'no blocks',
    '{"blocks": 1, "links": []}',
    '{"blocks": [{}], "links": []}',
    '{"blocks": [{"kind": "Timer", "at": [1e99, 0]}], "links": []}',
    '{"blocks": [{"kind": "../../x", "at": [0, 0]}], "links": [{"from": 9, "to": 7}]}',
    `{"blocks": [${'{"kind": "Timer", "at": [0, 0]},'.repeat(30000)}{}], "links": []}`,
  ];
  for (const text of texts) {
    await page.evaluate((written) => navigator.clipboard.writeText(written), text);
    await page.keyboard.press('Escape');
    await page.locator('.svelte-flow__pane').click({ position: { x: 5, y: 5 } });
    await page.keyboard.press('Control+v');
  }
  await button(page, 'Add Timer').click();
  await page.locator('.svelte-flow__node', { hasText: 'Timer' }).waitFor();
  expect(await page.locator('.svelte-flow__node').count()).toBe(3);
  expect(here.look.complaints).toEqual([]);
  await page.context().close();
});
