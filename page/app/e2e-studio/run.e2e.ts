// A person holds a run, looks back at it, measures it, and makes it many times.

import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import type { Page } from 'playwright-core';
import { expect, test } from 'vitest';
import { barriers, eventually } from '../e2e/robot.js';
import { begin, button } from './begin';

const ROOT = join(import.meta.dirname, '../../..');
const LINE = join(ROOT, 'examples/diagrams/line.qrs');
const WORLD = join(ROOT, 'examples/dataflow/line.xml');

const here = begin();

/** The studio with a program that follows a line, in its world. */
async function line(): Promise<Page> {
  const page = await here.open();
  page.setDefaultTimeout(20_000);
  await page.getByLabel('Open').setInputFiles(LINE);
  await node(page, 'Timer').waitFor();
  await page.getByLabel('Load a world').setInputFiles(WORLD);
  await page.getByText('The world is that of line.xml').waitFor();
  return page;
}

const node = (page: Page, name: string) =>
  page.locator('.svelte-flow__node').filter({ has: page.locator('strong', { hasText: name }) });
const status = (page: Page) => page.locator('.held [role=status]');

async function fill(page: Page, label: string, text: string): Promise<void> {
  await page.getByLabel(label).fill(text);
  await page.getByLabel(label).press('Enter');
}

/** Model time that is seen, in seconds. */
async function time(page: Page): Promise<number> {
  return Number(/([\d.]+) s/.exec((await status(page).textContent()) ?? '')?.[1]);
}

/** A file that a click gives, as text. */
async function given(page: Page, name: string): Promise<string> {
  const download = page.waitForEvent('download');
  await button(page, name).click();
  const file = join(here.home, 'given.csv');
  await (await download).saveAs(file);
  return readFileSync(file, 'utf8');
}

async function shot(page: Page, name: string): Promise<void> {
  if (process.env['SHOTS']) await page.screenshot({ path: join(process.env['SHOTS'], `studio-${name}.png`) });
}

test('a breakpoint holds under its condition, and a wrong condition is refused at once', async () => {
  const page = await line();
  await node(page, 'Timer').click();
  await button(page, 'Breakpoint').click();
  await fill(page, 'Only if', 'nobody > 3');
  await page.getByText('Undeclared identifier: nobody').waitFor();
  await fill(page, 'Only if', 'sum > 20');
  await page.getByText('Undeclared identifier: nobody').waitFor({ state: 'detached' });
  await page.getByLabel('Speed').selectOption('fastest');
  await button(page, 'Run').click();
  await page.getByText(/Held, .*: a breakpoint/).waitFor();
  await fill(page, 'Compute an expression', 'sum > 20');
  await page.getByText('sum > 20 = true').waitFor();
  await fill(page, 'Compute an expression', 'sum >');
  await page.locator('.computed.wrong').waitFor();
  // A breakpoint that writes holds nothing.
  await fill(page, 'Write and go on', 'sum is {sum');
  await page.getByText('This brace is not closed').waitFor();
  await fill(page, 'Write and go on', 'sum is {sum}');
  await fill(page, 'Only if', '');
  await button(page, 'Go on').click();
  await page.getByText('The task is done.').waitFor();
  await page
    .getByText(/sum is -?\d/)
    .first()
    .waitFor();
  await page.context().close();
});

test('a run is stepped, looked back at, and goes on from the present as if nothing had been', async () => {
  const page = await line();
  await node(page, 'Timer').click();
  await button(page, 'Breakpoint').click();
  await fill(page, 'Starting with hit number', '100');
  await button(page, 'Run').click();
  await page.getByText('Held, 1.02 s: a breakpoint').waitFor();
  await button(page, 'Step over').click();
  await expect.poll(() => page.locator('.lit strong').textContent()).toBe('Function');
  const held = await time(page);
  await button(page, 'Step back').click();
  await page.getByText(/In the past/).waitFor();
  await expect.poll(() => page.locator('.lit strong').textContent()).toBe('Timer');
  // The slider goes through the past: variables and lit blocks are those of then.
  const slider = page.getByLabel('Moment of the run');
  await slider.press('Home');
  await page.getByText('In the past, 0.00 s').waitFor();
  await expect.poll(() => page.locator('.lit strong').textContent()).toBe('Initial Node');
  await page.getByText('No variable has a value yet.').waitFor();
  for (let press = 0; press < 20; press++) await slider.press('ArrowRight');
  await page.getByText('In the past, 0.20 s').waitFor();
  await shot(page, 'past');
  expect(await barriers(page)).toEqual([]);
  await button(page, 'Back to the last breakpoint').click();
  await eventually('it is earlier', async () => (await time(page)) < 0.21);
  // What is past cannot be changed.
  expect(await page.getByRole('button', { name: /^kp is/ }).count()).toBe(0);
  await button(page, 'To the present').click();
  await page.getByText('Held').waitFor();
  expect(await time(page)).toBe(held);
  await node(page, 'Timer').click();
  await button(page, 'Breakpoint').click();
  await page.getByLabel('Speed').selectOption('fastest');
  await button(page, 'Go on').click();
  await page.getByText('Time: 34.83 s').waitFor();
  // After the end its past is there.
  await button(page, 'Step back').click();
  await page.getByText(/In the past, 34/).waitFor();
  await page.context().close();
});

test('a value is changed while the program is held, and a change of it holds the program', async () => {
  const page = await line();
  await button(page, 'Run').click();
  await expect.poll(() => page.locator('.bar .number').textContent()).not.toBe('0.0 s');
  await button(page, 'Pause').click();
  await page.getByText(/Held, /).waitFor();
  await page.getByRole('button', { name: /^kp is/ }).click();
  await fill(page, 'New value of kp', 'kp + nobody');
  await page.locator('.said .wrong').waitFor();
  await fill(page, 'New value of kp', '0.5 + 0.25');
  await page.getByRole('button', { name: 'kp is 0.75' }).waitFor();
  await page.getByLabel('Stop when sum changes').check();
  await button(page, 'Go on').click();
  await page.getByText(/Held, .*: sum was .* and is /).waitFor();
  await shot(page, 'held');
  expect(await barriers(page)).toEqual([]);
  await page.getByLabel('Stop when sum changes').uncheck();
  await button(page, 'Go on').click();
  await page.getByText('It runs').waitFor();
  await button(page, 'End').click();
  await page.context().close();
});

test('numbers of a run are drawn over its time and saved as a table', async () => {
  const page = await line();
  await page.getByLabel('Speed').selectOption('fastest');
  await button(page, 'Run').click();
  await page.getByText('Time: 34.83 s').waitFor();
  expect(await page.evaluate("performance.getEntries().some(({ name }) => name.includes('RunGraph'))")).toBe(
    false,
  );
  await page.getByText('Values', { exact: true }).click();
  for (const name of ['u', 'A1']) await button(page, `Graph of ${name}`).click();
  const graph = page.locator('.graph');
  await page.getByRole('img', { name: 'Over the time of the run: u, A1' }).waitFor();
  await expect.poll(() => graph.locator('tbody tr').count()).toBe(2);
  // Least, mean and greatest are in order.
  const [, low, mean, high] = (await graph.locator('tbody tr').nth(1).locator('td').allTextContents()).map(
    (text) => Number(text.replace('\u2212', '-')),
  );
  expect(low).toBeLessThan(mean ?? NaN);
  expect(mean).toBeLessThan(high ?? NaN);
  await shot(page, 'graph');
  expect(await barriers(page)).toEqual([]);
  const lines = (await given(page, 'Save as CSV')).trim().split('\n');
  expect(lines[0]).toBe('time_s,u,A1');
  expect(lines.length).toBeGreaterThan(500);
  expect(Number(lines.at(-1)?.split(',')[0])).toBeCloseTo(34.83);
  await button(page, 'Without u').click();
  await page.getByRole('img', { name: 'Over the time of the run: A1' }).waitFor();
  await page.context().close();
});

test('many runs are a heat map, and many fields a table', async () => {
  const page = await line();
  await page.getByText('Many runs', { exact: true }).click();
  await page.getByLabel('Runs, with the seeds').fill('6');
  await button(page, 'Run all').click();
  await page.getByText('The task is done in 6.').waitFor();
  const drawn = (): Promise<string> => page.evaluate("document.querySelector('.picture canvas').toDataURL()");
  const ways = await drawn();
  await page.getByLabel('Heat map').check();
  await page.getByText('from 1 to 6').waitFor();
  await expect.poll(drawn).not.toBe(ways);
  await shot(page, 'heat');
  expect(await barriers(page)).toEqual([]);
  await page.getByLabel('Ways', { exact: true }).check();
  await expect.poll(drawn).toBe(ways);
  // Fields: what is none is said, and the others are run.
  const text = readFileSync(WORLD, 'utf8');
  const field = (name: string, content: string) => ({
    name,
    mimeType: 'text/xml',
    buffer: Buffer.from(content),
  });
  const files = page.getByLabel('Choose fields');
  await files.setInputFiles([field('wrong.xml', '<root><world>')]);
  await page.getByText('wrong.xml is no field').waitFor();
  await files.setInputFiles([
    field('one.xml', text),
    field('=two.xml', readFileSync(join(ROOT, 'examples/dataflow/straight.xml'), 'utf8')),
  ]);
  await button(page, 'Without =two.xml').waitFor();
  await page.getByLabel('Runs, with the seeds').fill('2');
  await button(page, 'Run all').click();
  await eventually('all are done', async () => (await page.locator('.list tbody tr').count()) === 4);
  await shot(page, 'fields');
  expect(await barriers(page)).toEqual([]);
  const lines = (await given(page, 'Save as CSV')).trim().split('\n');
  expect(lines[0]).toBe('field,seed,verdict,time_s,score,why');
  expect(lines[1]).toMatch(/^one\.xml,1,accomplished,34\.83,/);
  expect(lines[3]).toMatch(/^"'=two\.xml",1,/);
  await page.context().close();
});
