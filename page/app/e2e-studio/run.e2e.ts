// A person holds a run, looks back at it, measures it, and makes it many times.

import { join } from 'node:path';
import type { Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, expect, test } from 'vitest';
import { Look, barriers, eventually } from '../e2e/robot.js';
import { Site } from './site';

const ROOT = join(import.meta.dirname, '../../..');
const LINE = join(ROOT, 'examples/diagrams/line.qrs');
const WORLD = join(ROOT, 'examples/dataflow/line.xml');

let look: Look;
let site: Site;

beforeAll(async () => {
  look = await Look.start();
  site = await Site.start();
});
afterEach(() => {
  expect(look.complaints).toEqual([]);
});
afterAll(async () => {
  await look?.end();
  await site?.end();
});

/** The studio with a program that follows a line, in its world. */
async function line(): Promise<Page> {
  const page = await look.open(site.url);
  page.setDefaultTimeout(20_000);
  await page.getByLabel('Open').setInputFiles(LINE);
  await node(page, 'Timer').waitFor();
  await page.getByLabel('Load a world').setInputFiles(WORLD);
  await page.getByText('The world is that of line.xml').waitFor();
  return page;
}

const node = (page: Page, name: string) =>
  page.locator('.svelte-flow__node').filter({ has: page.locator('strong', { hasText: name }) });
const button = (page: Page, name: string) => page.getByRole('button', { name, exact: true });
const status = (page: Page) => page.locator('.held [role=status]');

async function fill(page: Page, label: string, text: string): Promise<void> {
  await page.getByLabel(label).fill(text);
  await page.getByLabel(label).press('Enter');
}

/** Model time that is seen, in seconds. */
async function time(page: Page): Promise<number> {
  return Number(/([\d.]+) s/.exec((await status(page).textContent()) ?? '')?.[1]);
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
  await fill(page, 'From this time on', '100');
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
