// A person draws a program with mouse, finger and keys, and has it judged.

import { existsSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import type { Page } from 'playwright-core';
import { expect, test } from 'vitest';
import { barriers, eventually } from '../e2e/robot.js';
import { begin, button } from './begin';
import { DATA, drafted, library } from './site';

const here = begin();

const node = (page: Page, name: string | RegExp) =>
  page.locator('.svelte-flow__node').filter({ has: page.locator('strong', { hasText: name }) });

/** Drags a block from the list to a place of the sheet, in px from its upper left corner. */
async function drag(page: Page, title: string, x: number, y: number): Promise<void> {
  const sheet = page.locator('.svelte-flow');
  const count = await page.locator('.svelte-flow__node').count();
  const source = button(page, `Add ${title}`);
  await source.dragTo(sheet, { targetPosition: { x, y } });
  await eventually(
    `${title} is there`,
    async () => (await page.locator('.svelte-flow__node').count()) > count,
  );
}

/** Draws a link from the right side of a block to the left one of another. */
async function link(page: Page, from: number, to: number): Promise<void> {
  const nodes = page.locator('.svelte-flow__node');
  const count = await page.locator('.svelte-flow__edge').count();
  await nodes.nth(from).hover();
  const source = await nodes.nth(from).locator('[data-handlepos=right]').boundingBox();
  const end = await nodes.nth(to).boundingBox();
  if (!source || !end) throw new Error('no block is seen');
  await page.mouse.move(source.x + source.width / 2, source.y + source.height / 2);
  await page.mouse.down();
  await page.mouse.move(end.x + end.width / 2, end.y + end.height / 2, { steps: 8 });
  await page.mouse.up();
  await eventually(
    'the link is there',
    async () => (await page.locator('.svelte-flow__edge').count()) > count,
  );
}

async function set(page: Page, block: number, values: Record<string, string>): Promise<void> {
  await page.locator('.svelte-flow__node').nth(block).click();
  for (const [label, value] of Object.entries(values)) {
    const field = page.getByLabel('Properties').getByLabel(label, { exact: true });
    if ((await field.evaluate((one) => one.tagName)) === 'SELECT') await field.selectOption(value);
    else {
      await field.fill(value);
      await field.press('Escape');
      await field.fill(value);
      await field.press('Enter');
    }
  }
}

async function saved(page: Page, name: string): Promise<Uint8Array> {
  const download = page.waitForEvent('download');
  await button(page, 'Save').click();
  const file = join(here.home, name);
  await (await download).saveAs(file);
  return new Uint8Array(readFileSync(file));
}

/** How many projects the browser keeps. */
const KEPT = `new Promise((done) => {
  const opened = indexedDB.open('trik-studio', 1);
  opened.onsuccess = () => {
    const count = opened.result.transaction('projects').objectStore('projects').count();
    count.onsuccess = () => (opened.result.close(), done(count.result));
  };
})`;

async function shot(page: Page, name: string): Promise<void> {
  if (process.env['SHOTS']) await page.screenshot({ path: join(process.env['SHOTS'], `studio-${name}.png`) });
}

test('a program drawn with the mouse is judged as its original', async () => {
  const page = await here.open();
  await node(page, 'Initial Node').waitFor();
  // Encoders, turns and waits of the second example of TRIK Studio, in three rows.
  const rows: [string, Record<string, string>][][] = [
    [
      ['Clear Encoder', { Ports: 'E3' }],
      ['Motors Forward', { Ports: 'M3, M4', 'Power (%)': '100' }],
      ['Wait for Encoder', { Port: 'E3', 'Tacho Limit': '2500' }],
      ['Stop Motors', { Ports: 'M3, M4' }],
    ],
    [
      ['Clear Encoder', { Ports: 'E3' }],
      ['Motors Backward', { Ports: 'M4', 'Power (%)': '50' }],
      ['Motors Forward', { Ports: 'M3', 'Power (%)': '50' }],
      ['Wait for Encoder', { Port: 'E3', 'Tacho Limit': '250' }],
      ['Stop Motors', { Ports: 'M3, M4' }],
    ],
    [
      ['Clear Encoder', { Ports: 'E3' }],
      ['Motors Forward', { Ports: 'M3, M4', 'Power (%)': '100' }],
      ['Wait for Encoder', { Port: 'E3', 'Tacho Limit': '1500' }],
    ],
  ];
  let count = 2;
  for (const [row, blocks] of rows.entries()) {
    for (const [column, [title, values]] of blocks.entries()) {
      await drag(page, title, 90 + column * 125, [110, 230, 570][row] ?? 0);
      await set(page, count, values);
      count += 1;
    }
  }
  const order = [0, ...Array.from({ length: count - 2 }, (_, at) => at + 2), 1];
  for (const [at, to] of order.slice(1).entries()) await link(page, order[at] ?? 0, to);
  await page.getByText('Nothing is wrong.').waitFor({ state: 'attached' });
  await shot(page, 'drawn');
  await page.getByRole('button', { name: 'Arrange' }).click();
  await page.getByLabel('Speed').selectOption('fastest');
  await button(page, 'Run').click();
  await page.getByText('The program has ended.').waitFor();
  const shown = await page.getByText(/Time: [\d.]+ s/).textContent();
  // What was drawn is a file that the judge takes, and takes as long as the original with its world does.
  const { open } = await library();
  const drawn = open('drawn.qrs', await saved(page, 'drawn.qrs'));
  if (!drawn.ok) throw new Error(drawn.error.problems[0]?.message);
  const judged = drawn.value.judge();
  expect(judged.ok && judged.value.verdict).toBe('ended');
  if (judged.ok) expect(shown).toContain(`Time: ${(judged.value.ms / 1000).toFixed(2)} s`);
  const example = join(DATA, 'examples/2._AroundTheCorner_encoder.qrs');
  if (existsSync(example) || process.env['TRIK_REQUIRE_DATA'] === '1') {
    const original = open('original.qrs', new Uint8Array(readFileSync(example)));
    if (!original.ok) throw new Error('the example is not read');
    const field = (await drafted(new Uint8Array(readFileSync(example)))).world() ?? '';
    const options = { field, trajectory: true };
    const [one, other] = [drawn.value.judge(options), original.value.judge(options)];
    expect(one).toEqual(other);
  }
  await page.context().close();
});

test('a run is seen: the block that works, the way, the verdict of the rules', async () => {
  const root = join(import.meta.dirname, '../../..');
  const page = await here.open();
  await node(page, 'Initial Node').waitFor();
  await page.getByLabel('Open').setInputFiles(join(root, 'examples/diagrams/line.qrs'));
  await page.getByRole('heading', { name: 'line.qrs' }).waitFor();
  await page.getByLabel('Load a world').setInputFiles(join(root, 'examples/dataflow/line.xml'));
  await page.getByText('The world is that of line.xml.').waitFor();
  await page.getByRole('button', { name: 'Dismiss' }).click();
  await page.getByLabel('Speed').selectOption('10');
  await button(page, 'Run').click();
  await expect.poll(() => page.locator('.lit').count()).toBeGreaterThan(0);
  await expect
    .poll(async () => parseFloat((await page.locator('.bar .number').textContent()) ?? ''))
    .toBeGreaterThan(12);
  await page.getByLabel('Speed').selectOption('0.25');
  // A coefficient is changed while it drives: the run goes on, with the new one.
  await node(page, /^Function$/)
    .nth(0)
    .click();
  const body = page.getByLabel('Properties').getByRole('textbox').first();
  await body.fill('kp = 0.7\nki = 0.02\nkd = 1.5');
  await body.press('Enter');
  await body.fill('kp = 0.7\nki = 0.02\nkd = ');
  await body.press('Enter');
  await page.getByText('The run goes on with the program as it was').waitFor();
  await body.fill('kp = 0.7\nki = 0.02\nkd = 1.5');
  await body.press('Enter');
  await page.getByText('The run goes on with the program as it was').waitFor({ state: 'detached' });
  // A breakpoint holds the program and its world before a block, and steps go from block to block.
  await node(page, 'Timer').click();
  await button(page, 'Breakpoint').click();
  await page.getByRole('button', { name: 'Go on' }).waitFor();
  expect(await page.locator('.lit strong').textContent()).toBe('Timer');
  await shot(page, 'run');
  const held = await page.locator('.bar .number').textContent();
  await page.getByRole('button', { name: 'Step over' }).click();
  await expect.poll(() => page.locator('.lit strong').textContent()).toBe('Function');
  await button(page, 'Breakpoint').click();
  await page.getByLabel('Speed').selectOption('fastest');
  await page.getByRole('button', { name: 'Go on' }).click();
  await page.getByText('The task is done.').waitFor();
  await page.getByText(/Time: 3[45]\.\d\d s/).waitFor();
  expect(await page.locator('.bar .number').textContent()).not.toBe(held);
  expect(await page.locator('.lit').count()).toBe(0);
  // From the beginning it is the run of `trik check`.
  await page.keyboard.press('Escape');
  for (let change = 0; change < 3; change++) await page.keyboard.press('Control+z');
  await button(page, 'Run').click();
  await page.getByText('Time: 34.83 s').waitFor();
  await page.context().close();
});

test('what is drawn is taken back, made again, copied, and found as it was left', async () => {
  const page = await here.open();
  await node(page, 'Initial Node').waitFor();
  await button(page, 'Add Timer').click();
  await node(page, /^Timer/).waitFor();
  await page.locator('.svelte-flow__node').nth(2).click();
  await page.keyboard.press('Control+c');
  await page.keyboard.press('Control+v');
  await expect.poll(() => node(page, /^Timer/).count()).toBe(2);
  await page.keyboard.press('Delete');
  await expect.poll(() => node(page, /^Timer/).count()).toBe(1);
  await page.keyboard.press('Control+z');
  await expect.poll(() => node(page, /^Timer/).count()).toBe(2);
  await page.keyboard.press('Control+z');
  await page.keyboard.press('Control+z');
  await expect.poll(() => node(page, /^Timer/).count()).toBe(0);
  expect(await page.getByRole('button', { name: 'Take back' }).isDisabled()).toBe(true);
  await page.keyboard.press('Control+y');
  await expect.poll(() => node(page, /^Timer/).count()).toBe(1);
  // A page that is loaded again has it, and so has another one once this is closed, but not before.
  await page.getByText('not saved').waitFor();
  await expect.poll(() => page.evaluate(KEPT)).toBe(1);
  await page.goto('about:blank');
  await page.goto(here.site.url);
  await node(page, /^Timer/).waitFor();
  const beside = await page.context().newPage();
  await beside.goto(here.site.url);
  await node(beside, 'Initial Node').waitFor();
  expect(await node(beside, /^Timer/).count()).toBe(0);
  await page.close();
  const again = await beside.context().newPage();
  await again.goto(here.site.url);
  await node(again, /^Timer/).waitFor();
  await again.getByText('as it was when this page was left').waitFor();
  await again.context().close();
});

test('by keys alone a block is added, written into, linked and removed', async () => {
  const page = await here.open();
  await node(page, 'Initial Node').waitFor();
  await page.getByRole('searchbox').focus();
  await page.keyboard.type('motors for');
  await page.keyboard.press('Tab');
  await page.keyboard.press('Tab');
  await page.keyboard.press('Enter');
  await node(page, 'Motors Forward').waitFor();
  const power = page.getByLabel('Power (%)');
  await power.focus();
  await page.keyboard.press('Control+a');
  await page.keyboard.type('sensorA');
  await page.getByRole('option', { name: 'sensorA1' }).waitFor();
  await page.keyboard.press('ArrowDown');
  await page.keyboard.press('Enter');
  await page.keyboard.press('Enter');
  await expect.poll(() => node(page, 'Motors Forward').textContent()).toContain('sensorA1');
  await page.getByLabel('Connect to').selectOption({ label: 'Final Node' });
  await button(page, 'Connect').press('Enter');
  await expect.poll(() => page.locator('.svelte-flow__edge').count()).toBe(1);
  await page.getByRole('group', { name: /^Motors Forward/ }).focus();
  await page.keyboard.press('Enter');
  const before = await page.getByRole('group', { name: /^Motors Forward/ }).boundingBox();
  await page.keyboard.press('ArrowRight');
  await expect
    .poll(async () => (await page.getByRole('group', { name: /^Motors Forward/ }).boundingBox())?.x)
    .toBeGreaterThan(before?.x ?? 0);
  await page.keyboard.press('Delete');
  await expect.poll(() => node(page, 'Motors Forward').count()).toBe(0);
  await page.context().close();
});

test('mistakes are shown while they are made, and lead to their block', async () => {
  const page = await here.open();
  await node(page, 'Initial Node').waitFor();
  await button(page, 'Add Function').click();
  await page.getByLabel('Connect to').selectOption({ label: 'Final Node' });
  await button(page, 'Connect').click();
  await node(page, 'Initial Node').click();
  await page.getByLabel('Connect to').selectOption({ label: 'Function' });
  await button(page, 'Connect').click();
  await page.getByText('Nothing is wrong.').waitFor({ state: 'attached' });
  await node(page, 'Function').click();
  const body = page.getByLabel('Properties').getByRole('textbox').first();
  await body.fill('x = 1 +');
  await body.press('Enter');
  await page.getByText(/to mend/).waitFor();
  await expect.poll(() => body.getAttribute('aria-invalid')).toBe('true');
  await node(page, 'Initial Node').click();
  await page.getByText(/^Mistakes/).click();
  await page.getByRole('region', { name: 'Mistakes' }).getByRole('button').first().click();
  await expect.poll(() => page.getByRole('heading', { name: 'Function' }).count()).toBe(1);
  await shot(page, 'mistake');
  await page.context().close();
});

test('a file that is chosen before the studio has come is open once it has', async () => {
  const page = await here.look.open('about:blank');
  await page.route(/[.]wasm$/, async (route) => {
    await new Promise((later) => setTimeout(later, 1500));
    await route.continue();
  });
  await page.goto(here.site.url);
  await page
    .getByLabel('Open')
    .setInputFiles(join(import.meta.dirname, '../../../examples/diagrams/line.qrs'));
  await page.getByRole('heading', { name: 'line.qrs' }).waitFor();
  await node(page, 'Timer').waitFor();
  await page.context().close();
});

test('what is being typed is in the file that Ctrl+S saves', async () => {
  const page = await here.open();
  await node(page, 'Initial Node').waitFor();
  await button(page, 'Add Timer').click();
  await page.getByLabel('Delay (ms)').fill('777');
  const download = page.waitForEvent('download');
  await page.keyboard.press('Control+s');
  const file = join(here.home, 'typed.qrs');
  await (await download).saveAs(file);
  const draft = await drafted(new Uint8Array(readFileSync(file)));
  const blocks = draft.sheet(draft.about().diagrams[0]?.id ?? '')?.blocks ?? [];
  expect(blocks.find(({ kind }) => kind === 'Timer')?.properties['Delay']).toBe('777');
  await page.context().close();
});

test('a block goes into a link, a link gets another end, and a call another subprogram', async () => {
  const page = await here.open();
  await node(page, 'Initial Node').waitFor();
  await link(page, 0, 1);
  const [start, end] = [
    await node(page, 'Initial Node').boundingBox(),
    await node(page, 'Final Node').boundingBox(),
  ];
  const flow = await page.locator('.svelte-flow').boundingBox();
  if (!start || !end || !flow) throw new Error('nothing is seen');
  await drag(page, 'Stop Motors', (start.x + end.x) / 2 + 25 - flow.x, start.y + 25 - flow.y);
  await page
    .getByRole('group', { name: 'Link from Stop Motors to Final Node' })
    .waitFor({ state: 'attached' });
  await page.getByRole('group', { name: 'Link from Initial Node to Stop Motors' }).focus();
  await page.keyboard.press('Enter');
  await button(page, 'Add Function').click();
  await page.getByRole('group', { name: 'Link from Function to Stop Motors' }).waitFor({ state: 'attached' });
  for (let change = 0; change < 2; change++) await page.keyboard.press('Control+z');
  await page
    .getByRole('group', { name: 'Link from Initial Node to Final Node' })
    .waitFor({ state: 'attached' });
  await button(page, 'Add Timer').click();
  await node(page, 'Timer').waitFor();
  await page.getByRole('group', { name: 'Link from Initial Node to Final Node' }).focus();
  await page.keyboard.press('Enter');
  const anchor = await page.locator('.anchor').last().boundingBox();
  const timer = await node(page, 'Timer').boundingBox();
  if (!anchor || !timer) throw new Error('nothing is seen');
  await page.mouse.move(anchor.x + anchor.width / 2, anchor.y + anchor.height / 2);
  await page.mouse.down();
  await page.mouse.move(timer.x + timer.width / 2, timer.y + timer.height / 2, { steps: 8 });
  await page.mouse.up();
  await page.getByRole('group', { name: 'Link from Initial Node to Timer' }).waitFor({ state: 'attached' });
  // Two subprograms have two names, and a call chooses among them.
  const main = page.getByRole('button', { name: "Robot's Behaviour Diagram" });
  for (const name of ['Subprogram 1', 'Subprogram 2']) {
    await page.getByRole('button', { name: '+ New subprogram' }).click();
    await page.getByRole('button', { name, exact: true }).waitFor();
  }
  await page.getByLabel('Name', { exact: true }).fill('Subprogram 1');
  await page.keyboard.press('Enter');
  await page.getByRole('alert').getByText('another subprogram is called').waitFor();
  await main.click();
  await button(page, 'Add Subprogram 1').click();
  await page.getByLabel('Calls').selectOption('Subprogram 2');
  await node(page, 'Subprogram 2').waitFor();
  await page.context().close();
});

test.each(['light', 'dark'] as const)('there are no barriers in %s', async (colorScheme) => {
  const page = await here.look.open(here.site.url, { colorScheme });
  await node(page, 'Initial Node').waitFor();
  await button(page, 'Add Timer').click();
  await page.getByRole('button', { name: '+ New subprogram' }).click();
  await button(page, 'Subprogram 1').waitFor();
  expect(await barriers(page)).toEqual([]);
  await page.getByRole('button', { name: "Robot's Behaviour Diagram" }).click();
  await node(page, 'Timer').click();
  expect(await barriers(page)).toEqual([]);
  await shot(page, colorScheme);
  await page.context().close();
});

test('a project that was only opened is there after the page is loaded again', async () => {
  const page = await here.open();
  await node(page, 'Initial Node').waitFor();
  const made = (await library()).blank('kept.qrs');
  const save = made.ok ? made.value.save() : made;
  if (!save.ok) throw new Error('no project');
  const file = { name: 'kept.qrs', mimeType: 'application/zip', buffer: Buffer.from(save.value) };
  await page.locator('input[type=file][accept^=".qrs"]').setInputFiles(file);
  await page.getByRole('heading', { name: 'kept.qrs' }).waitFor();
  await expect.poll(() => page.evaluate(KEPT)).toBe(1);
  await page.reload();
  await page.getByRole('heading', { name: 'kept.qrs' }).waitFor();
  await page.context().close();
});
