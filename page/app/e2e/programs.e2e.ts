// Programs and diagrams: sent, run, watched, stopped, changed.

import { expect, test } from 'vitest';
import { ru } from '../src/words/ru';
import { barriers, eventually } from './robot.js';
import { scene } from './scene.js';

const DIAGRAM = '../../editors/vscode/test/texts/count.qrs';

const there = scene();

test('a program is sent, runs, says something and is stopped by the space bar', async () => {
  const page = await there.look.open(`${there.robot.url}#program`);
  const buffer = Buffer.from("print('here I am')\nbrick.motor('M3').setPower(40)\nscript.wait(60000)\n");
  await page.setInputFiles('input[type=file]', { name: 'go.py', mimeType: 'text/x-python', buffer });
  await page.getByRole('button', { name: 'Run go.py' }).click();
  await page.getByText('here I am').waitFor();
  await page.getByText('go.py runs').waitFor();
  await eventually('the motor turns', () => there.robot.read('motors/M3/value') === '40');
  await page.keyboard.press('Space');
  await eventually('the motor rests', () => there.robot.read('motors/M3/value') === '0');
  await page.getByText('No program runs.').waitFor();
  await page.context().close();
});

test('names and output of programs are text, whatever is in them', async () => {
  const page = await there.look.open(`${there.robot.url}#program`);
  const name = '<img src=x onerror=alert(1)>.py';
  const buffer = Buffer.from("print('<script>document.title = 1</script>')\n");
  await page.setInputFiles('input[type=file]', { name, mimeType: 'text/x-python', buffer });
  await page.getByRole('button', { name: `Run ${name}` }).click();
  await page.getByText('<script>document.title = 1</script>').waitFor();
  expect(await page.locator('img').count()).toBe(0);
  expect(await page.title()).toContain('two-wheels');
  const refused = { name: 'a:b.py', mimeType: 'text/x-python', buffer };
  await page.setInputFiles('input[type=file]', refused);
  await page.getByText('cannot be a program').waitFor();
  await page.context().close();
});

test('a diagram stops at a breakpoint, goes on step by step, back, and takes a new number', async () => {
  const page = await there.look.open(`${there.robot.url}#program`);
  await page.setInputFiles('input[type=file]', DIAGRAM);
  await page.getByRole('link', { name: 'Show the diagram count.qrs' }).click();
  await page.getByRole('button', { name: 'Run, stopped at the first block' }).click();
  await page.locator('g.stopped[data-id*=InitialNode]').waitFor();
  await page.locator('g[data-id*=Timer] rect').first().click();
  await page.getByRole('button', { name: 'Breakpoint', exact: true }).click();
  await page.locator('g.break[data-id*=Timer]').waitFor();
  await page.getByRole('button', { name: 'Continue' }).click();
  await page.locator('g.stopped[data-id*=Timer]').waitFor();
  await page.getByText('at a breakpoint').waitFor();
  const value = page.locator('aside table button.number').first();
  const before = await value.textContent();
  await value.click();
  await page.locator('aside table input').fill('77');
  await page.locator('aside table').getByRole('button', { name: 'Set' }).click();
  await expect.poll(() => value.textContent()).toBe('77');
  expect(before).not.toBe('77');
  await page.getByRole('button', { name: 'Step over' }).click();
  await page.locator('g.stopped:not([data-id*=Timer])').waitFor();
  await page.getByRole('button', { name: 'Step back' }).click();
  await page.getByText('In the past').waitFor();
  await page.getByRole('button', { name: 'To the present' }).click();
  await page.getByRole('button', { name: 'Stop', exact: true }).click();
  await page.getByText('Stopped, motors').waitFor({ state: 'detached' });
  await page.context().close();
});

test('a diagram has breakpoints before it runs, and takes new values in its blocks while it does', async () => {
  const page = await there.look.open(`${there.robot.url}#program`);
  await page.setInputFiles('input[type=file]', DIAGRAM);
  await page.getByRole('link', { name: 'Show the diagram count.qrs' }).click();
  const timer = page.locator('g[data-id*=Timer]').first();
  await timer.locator('rect').first().click();
  await page.keyboard.press('b');
  await page.locator('g.break[data-id*=Timer]').waitFor();
  expect(await barriers(page)).toEqual([]);
  await page.getByRole('button', { name: 'Run', exact: true }).click();
  await page.locator('g.stopped[data-id*=Timer]').waitFor();
  await page.getByText('at a breakpoint').waitFor();
  await page.getByRole('button', { name: 'Breakpoint', exact: true }).click();
  await page.locator('g.break').waitFor({ state: 'detached' });
  const delay = page.getByLabel('Delay (ms)');
  expect(await delay.inputValue()).toBe('100');
  // What means nothing is refused with its place, and nothing changes.
  await delay.fill('100 +');
  await delay.press('Enter');
  await page.locator('aside').getByRole('alert').getByText('Delay').waitFor();
  const saved = () => page.evaluate(async () => (await fetch('/diagram/count.qrs')).text());
  expect(await saved()).not.toContain('100 +');
  await delay.fill('777000');
  await delay.press('Enter');
  await expect.poll(saved).toContain('777000');
  await page.locator('g[data-id*=Timer] text', { hasText: '777000' }).waitFor();
  await page.getByRole('button', { name: 'Continue' }).click();
  // It waits as long as is written there now; what is left of it begins with 7 for more than a minute.
  await page
    .locator('aside')
    .getByText(/waits 7\d\d\.\d\d s/)
    .waitFor();
  expect(await barriers(page)).toEqual([]);
  await page.getByRole('button', { name: 'Undo the change' }).click();
  await page.locator('g[data-id*=Timer] text', { hasText: /^100$/ }).waitFor();
  expect(await saved()).not.toContain('777000');
  await page.getByRole('button', { name: 'Fit' }).click();
  await page.getByRole('button', { name: 'Stop', exact: true }).click();
  await page.context().close();
});

for (const colorScheme of ['light', 'dark'] as const) {
  test(`everybody can use every view, ${colorScheme}`, async () => {
    const views = ['program', 'program:new.py', 'diagram', 'diagram:count.qrs', 'configuration', 'log'];
    for (const view of views) {
      const page = await there.look.open(`${there.robot.url}#${view}`, { colorScheme });
      await page.getByRole('button', { name: 'Stop', exact: true }).waitFor();
      await page.locator('main > *').first().waitFor();
      expect(await barriers(page), view).toEqual([]);
      await page.context().close();
    }
  });
}

test('a Russian browser has a Russian page', async () => {
  const page = await there.look.open(`${there.robot.url}#program`, { locale: 'ru-RU' });
  await page.getByRole('heading', { name: ru.programs }).waitFor();
  expect(await page.locator('html').getAttribute('lang')).toBe('ru');
  await page.context().close();
});

test('no page has complained', () => {
  // Of a value that was refused the browser says so too.
  expect(there.look.complaints.filter((one) => !/status of 422/.test(one))).toEqual([]);
});
