// A person draws a program of data flow with mouse and keys, has it run, and keeps it.

import { readFileSync, readdirSync } from 'node:fs';
import { join } from 'node:path';
import type { Locator, Page } from 'playwright-core';
import { expect, test } from 'vitest';
import { barriers, eventually } from '../e2e/robot.js';
import { begin, button } from './begin';
import { drafted, library } from './site';

const EXAMPLES = join(import.meta.dirname, '../../../examples/dataflow');

const here = begin();

const nodes = (page: Page): Locator => page.locator('.svelte-flow__node');
const edges = (page: Page): Locator => page.locator('.svelte-flow__edge');

async function shot(page: Page, name: string): Promise<void> {
  if (process.env['SHOTS']) await page.screenshot({ path: join(process.env['SHOTS'], `studio-${name}.png`) });
}

/** A new program of data flow. */
async function begun(): Promise<Page> {
  const page = await here.open();
  await nodes(page).first().waitFor();
  await page.getByRole('button', { name: 'New data flow' }).click();
  await page.getByText('Drag blocks here').waitFor();
  return page;
}

/** Drags a block from the list to a place of the sheet, in px from its upper left corner. */
async function drag(page: Page, title: string, x: number, y: number): Promise<void> {
  const count = await nodes(page).count();
  const source = button(page, `Add ${title}`);
  await source.dragTo(page.locator('.svelte-flow'), { targetPosition: { x, y } });
  await eventually(`${title} is there`, async () => (await nodes(page).count()) > count);
}

/** Moves the mouse from one port to another. */
async function pull(page: Page, [from, out]: [number, string], [to, into]: [number, string]): Promise<void> {
  const middle = async (block: number, port: string): Promise<[number, number]> => {
    const box = await nodes(page).nth(block).locator(`[title^="${port}:"]`).boundingBox();
    if (!box) throw new Error(`${port} is not seen`);
    return [box.x + box.width / 2, box.y + box.height / 2];
  };
  const end = await middle(to, into);
  await page.mouse.move(...(await middle(from, out)));
  await page.mouse.down();
  await page.mouse.move(...end, { steps: 8 });
  await page.mouse.up();
}

async function link(page: Page, from: [number, string], to: [number, string]): Promise<void> {
  const count = await edges(page).count();
  await pull(page, from, to);
  await eventually('the link is there', async () => (await edges(page).count()) > count);
}

async function set(page: Page, block: number, label: string, value: string): Promise<void> {
  await nodes(page).nth(block).locator('.block').click();
  const field = page.getByLabel('Properties').getByLabel(label, { exact: true });
  await field.fill(value);
  await field.press('Escape');
  await field.fill(value);
  await field.press('Enter');
}

async function saved(page: Page, name: string): Promise<Uint8Array> {
  const download = page.waitForEvent('download');
  await button(page, 'Save').click();
  const file = join(here.home, name);
  await (await download).saveAs(file);
  return new Uint8Array(readFileSync(file));
}

/** Drives to a wall and ends there. */
async function drawWall(page: Page): Promise<void> {
  await drag(page, 'Sensor', 90, 120);
  await drag(page, 'Text programming', 330, 180);
  await drag(page, 'Motors', 600, 120);
  await drag(page, 'If', 330, 440);
  await drag(page, 'Stop', 600, 440);
  await set(page, 0, 'Sensor', 'sensorD1');
  await set(page, 1, 'IO0', '2 * (I0 - 20)');
  await set(page, 3, 'Condition', 'data < 23');
  await link(page, [0, 'Output OUT'], [1, 'Input I0']);
  await link(page, [1, 'Output O0'], [2, 'Input M3']);
  await link(page, [1, 'Output O0'], [2, 'Input M4']);
  await link(page, [0, 'Output OUT'], [3, 'Input DATA']);
  await link(page, [3, 'Output TRUE'], [4, 'Input IN1']);
}

test('a program drawn with the mouse drives to the wall, and its tokens are seen', async () => {
  const page = await begun();
  await drawWall(page);
  await page.getByText('Nothing is wrong.').waitFor({ state: 'attached' });
  // The room without its rules, which are about another program.
  const room = readFileSync(join(EXAMPLES, 'walls.xml'), 'utf8').replace(
    /<constraints>[^]*<\/constraints>/,
    '',
  );
  const buffer = Buffer.from(room);
  await page
    .getByLabel('Load a world')
    .setInputFiles({ name: 'walls.xml', mimeType: 'application/xml', buffer });
  await page.getByText('The world is that of walls.xml.').waitFor();
  await page.getByRole('button', { name: 'Dismiss' }).click();
  await page.getByLabel('Show the program as').selectOption('source');
  await page.getByText('sensorD1').first().waitFor({ state: 'attached' });
  await page.getByLabel('Show the program as').selectOption('lua');
  await page.getByLabel('Speed').selectOption('1');
  await button(page, 'Run').click();
  await page.locator('.token').first().waitFor();
  await expect.poll(() => page.locator('.block.lit').count()).toBeGreaterThan(1);
  await shot(page, 'flow');
  // A number is changed while it drives.
  await set(page, 1, 'IO0', '3 * (I0 - 20)');
  await page.getByLabel('Speed').selectOption('fastest');
  await page.getByText('The program has ended.').waitFor();
  const bytes = await saved(page, 'wall.qrs');
  const { open } = await library();
  const drawn = open('wall.qrs', bytes);
  if (!drawn.ok) throw new Error(drawn.error.problems[0]?.message);
  const judged = drawn.value.judge({ trajectory: true });
  expect(judged.ok && judged.value.verdict).toBe('ended');
  // The same from the beginning takes as long as the judge says.
  await button(page, 'Run').click();
  const seconds = judged.ok ? (judged.value.ms / 1000).toFixed(2) : '';
  await page.getByText(`Time: ${seconds} s`).waitFor();
  await page.context().close();
});

test('a wrong connection is refused in words, and everything is taken back', async () => {
  const page = await begun();
  await drag(page, 'Zip flows', 150, 150);
  await drag(page, 'Motors', 450, 150);
  await pull(page, [0, 'Output OUT'], [1, 'Input M3']);
  await page.getByText('a list comes here, but a whole number is needed').waitFor();
  await pull(page, [0, 'Output OUT'], [1, 'Output CF_OUT']);
  await page.getByText('a link ends at an input, and this is an output').waitFor();
  expect(await edges(page).count()).toBe(0);
  // Drawn from its end it is the same link.
  await drag(page, 'Value generator', 150, 400);
  await pull(page, [1, 'Input M4'], [2, 'Output OUT']);
  await expect.poll(() => edges(page).count()).toBe(1);
  expect(await barriers(page)).toEqual([]);
  for (let left = 4; left > 0; left -= 1) await page.keyboard.press('Control+z');
  await expect.poll(() => nodes(page).count()).toBe(0);
  await page.keyboard.press('Control+y');
  await expect.poll(() => nodes(page).count()).toBe(1);
  await page.context().close();
});

test('by keys alone a program is drawn and run', async () => {
  const page = await begun();
  for (const title of ['Value generator', 'Motors']) {
    await button(page, `Add ${title}`).press('Enter');
    await page.getByRole('heading', { name: title }).waitFor();
  }
  await nodes(page).first().press('Enter');
  const properties = page.getByLabel('Properties');
  await page.getByRole('heading', { name: 'Value generator' }).waitFor();
  await properties.getByLabel('Connect to').selectOption({ label: 'Motors' });
  // The first output with a value is offered, and an input that takes it.
  await expect
    .poll(() => properties.getByLabel('From the output').locator('option:checked').textContent())
    .toContain('OUT');
  await properties.getByLabel('To the input').selectOption({ label: 'M3: a whole number' });
  await properties.getByRole('button', { name: 'Connect', exact: true }).press('Enter');
  await expect.poll(() => edges(page).count()).toBe(1);
  expect(await edges(page).first().getAttribute('aria-label')).toContain('M3');
  expect(await barriers(page)).toEqual([]);
  await page.context().close();
});

test('each program of the library is opened, drawn, saved and opened again as the same', async () => {
  const page = await here.open();
  await nodes(page).first().waitFor();
  const files = readdirSync(EXAMPLES).filter((name) => name.endsWith('.flow'));
  expect(files.length).toBeGreaterThan(4);
  for (const name of files) {
    await page.getByLabel('Open').setInputFiles(join(EXAMPLES, name));
    const title = name.replace('.flow', '.qrs');
    await page.getByRole('heading', { name: title }).waitFor();
    await page.getByText('Its comments are not kept').waitFor();
    const bytes = await saved(page, title);
    await page.getByLabel('Open').setInputFiles(join(here.home, title));
    await page.getByText('Its comments are not kept').waitFor({ state: 'detached' });
    const [one, other] = await Promise.all([drafted(bytes), drafted(await saved(page, title))]);
    expect(other.about()).toEqual(one.about());
    for (const { id } of one.about().diagrams) expect(other.sheet(id)).toEqual(one.sheet(id));
  }
  await shot(page, 'flow-library');
  expect(await barriers(page)).toEqual([]);
  await page.context().close();
});

test('blocks of one language are not pasted into a program of the other', async () => {
  const page = await here.open();
  await nodes(page).first().waitFor();
  await button(page, 'Add Timer').click();
  await eventually('it is there', async () => (await nodes(page).count()) === 3);
  await nodes(page).nth(2).click();
  await page.keyboard.press('Control+c');
  await page.getByRole('button', { name: 'New data flow' }).click();
  await page.getByRole('button', { name: 'Discard the changes' }).click();
  await page.getByText('Drag blocks here').waitFor();
  await page.locator('.svelte-flow__pane').click();
  await page.keyboard.press('Control+v');
  await page.getByText('What was copied are blocks of control flow').waitFor();
  expect(await nodes(page).count()).toBe(0);
  await page.context().close();
});
