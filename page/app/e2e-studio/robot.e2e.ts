// The studio that a robot gives: a drawing is sent to it, runs, is changed while it runs, held, and stopped.

import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import type { Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, expect, test } from 'vitest';
import { Look, Robot, barriers, eventually } from '../e2e/robot.js';
import { Site, library } from './site';

let look: Look;
let robot: Robot;
let home: string;

beforeAll(async () => {
  look = await Look.start();
  robot = await Robot.start();
  home = mkdtempSync(join(tmpdir(), 'trik-studio-'));
  writeFileSync(join(home, 'turn.qrs'), await turning());
});
afterEach(() => {
  expect(look.complaints).toEqual([]);
});
afterAll(async () => {
  await look?.end();
  await robot?.end();
  rmSync(home, { recursive: true, force: true });
});

/** A program that turns a motor and says a number, again and again. */
async function turning(): Promise<Uint8Array> {
  const begun = (await library()).blank('turn.qrs');
  if (!begun.ok) throw new Error('no draft');
  const draft = begun.value;
  const diagram = draft.about().diagrams[0]?.id ?? '';
  const [start, end] = draft.sheet(diagram)?.blocks ?? [];
  const apply = (change: Parameters<typeof draft.apply>[0]): string[] => {
    const made = draft.apply(change);
    if (!made.ok) throw new Error(made.error.problems[0]?.message);
    return made.value;
  };
  const [motor = '', count = '', wait = ''] = apply({
    do: 'add',
    diagram,
    blocks: [
      { kind: 'TrikV6EnginesForward', at: [250, 200], properties: { Ports: 'M3', Power: '40' } },
      { kind: 'Function', at: [350, 200], properties: { Body: 'n = 7; print(n)' } },
      { kind: 'Timer', at: [450, 200], properties: { Delay: '100' } },
    ],
    links: [
      { from: 0, to: 1 },
      { from: 1, to: 2 },
      { from: 2, to: 0 },
    ],
  });
  expect([motor, count, wait].every(Boolean)).toBe(true);
  apply({ do: 'remove', ids: [end?.id ?? ''] });
  apply({ do: 'connect', from: start?.id ?? '', to: motor });
  const saved = draft.save();
  if (!saved.ok) throw new Error('no save');
  return saved.value;
}

const panel = (page: Page) => page.getByRole('region', { name: /^Robot / });
const node = (page: Page, name: string) =>
  page.locator('.svelte-flow__node').filter({ has: page.locator('strong', { hasText: name }) });
const power = () => Number(robot.read('motors/M3/value'));

test('a drawing runs on the robot, is changed there while it runs, held, stepped and stopped', async () => {
  const page = await look.open(`${robot.url}studio/`);
  await page.getByLabel('Open', { exact: true }).setInputFiles(join(home, 'turn.qrs'));
  await page.getByRole('heading', { name: 'turn.qrs' }).waitFor();
  const robots = panel(page);
  await robots.getByText('No program runs.').waitFor();
  await robots.getByRole('button', { name: 'Send and run' }).click();
  await robots.getByText('turn.qrs runs. The robot runs this version.').waitFor();
  await robots.getByRole('log').getByText('7', { exact: true }).first().waitFor();
  await eventually('the motor turns', () => power() === 40);
  await page.locator('.svelte-flow__node .lit').first().waitFor();
  expect(await barriers(page)).toEqual([]);
  if (process.env['SHOTS']) await page.screenshot({ path: join(process.env['SHOTS'], 'studio-robot.png') });

  // What is drawn is in force with no stop.
  await node(page, 'Motors Forward').click();
  const field = page.getByLabel('Properties').getByLabel('Power (%)', { exact: true });
  await field.fill('55');
  await field.press('Enter');
  await eventually('the motor turns faster', () => power() === 55);
  await robots.getByText('turn.qrs runs. The robot runs this version.').waitFor();

  // A mistake is not sent.
  await field.fill('1 +');
  await field.press('Enter');
  await robots.getByText(/the robot goes on with the version before/).waitFor();
  expect(await robots.getByRole('button', { name: 'Send and run' }).isDisabled()).toBe(true);
  expect(power()).toBe(55);
  await page.getByRole('button', { name: 'Take back' }).click();
  await robots.getByText('turn.qrs runs. The robot runs this version.').waitFor();

  // Held, and a step further.
  await robots.getByRole('button', { name: 'Pause' }).click();
  await robots.getByText('turn.qrs is stopped; motors rest.').waitFor();
  await eventually('the motor rests', () => power() === 0);
  await robots.getByRole('button', { name: 'Step' }).click();
  await robots.getByRole('button', { name: 'Go on' }).click();
  await eventually('the motor turns again', () => power() === 55);

  // A breakpoint that is set while it runs.
  await node(page, 'Timer').click();
  await page.keyboard.press('b');
  await robots.getByText('turn.qrs is stopped; motors rest.').waitFor();
  await node(page, 'Timer').click();
  await page.keyboard.press('b');
  await robots.getByRole('button', { name: 'Go on' }).click();
  await eventually('the motor turns again', () => power() === 55);

  // The space bar stops it.
  await page.locator('.svelte-flow__pane').click({ position: { x: 5, y: 5 } });
  await page.keyboard.press('Space');
  await robots.getByText('No program runs.').waitFor();
  await eventually('the motor rests', () => power() === 0);
  // Also where it would press the button that has started it.
  const sends = robots.getByRole('button', { name: 'Send and run' });
  await sends.click();
  await eventually('the motor turns once more', () => power() === 55);
  await sends.focus();
  await page.keyboard.press('Space');
  await robots.getByText('No program runs.').waitFor();
  await eventually('the motor rests again', () => power() === 0);
  await page.waitForTimeout(500);
  expect(power()).toBe(0);
  await page.context().close();
});

test('a program of data flow on the robot shows its tokens', async () => {
  const page = await look.open(`${robot.url}studio/`);
  const file = join(import.meta.dirname, '../../../examples/dataflow/walls.flow');
  await page.getByLabel('Open', { exact: true }).setInputFiles(file);
  const robots = panel(page);
  await robots.getByRole('button', { name: 'Send and run' }).click();
  await robots.getByText(/runs\. The robot runs this version\./).waitFor();
  await page.locator('.svelte-flow__node .lit').first().waitFor();
  await robots.getByRole('button', { name: 'Stop', exact: true }).click();
  await robots.getByText('No program runs.').waitFor();
  await page.context().close();
});

test('a program with text is sent, runs and is stopped', async () => {
  const page = await look.open(`${robot.url}studio/`);
  const text = 'brick.motor("M3").setPower(30); while (true) { print("on"); script.wait(200); }\n';
  const file = { name: 'turn.js', mimeType: 'text/javascript', buffer: Buffer.from(text) };
  await page.getByLabel('Open', { exact: true }).setInputFiles(file);
  const robots = panel(page);
  await robots.getByRole('button', { name: 'Send and run' }).click();
  await robots.getByText('turn.js runs. The robot runs this version.').waitFor();
  await robots.getByRole('log').getByText('on', { exact: true }).first().waitFor();
  await eventually('the motor turns', () => power() === 30);
  expect(await robots.getByRole('button', { name: 'Pause' }).count()).toBe(0);
  expect(await barriers(page)).toEqual([]);
  await robots.getByRole('button', { name: 'Stop', exact: true }).click();
  await eventually('the motor rests', () => power() === 0);
  await page.context().close();
});

test('the page of the robot leads to its diagrams in the studio and back', async () => {
  const page = await look.open(`${robot.url}#program`);
  await page.getByRole('link', { name: 'Draw turn.qrs in the studio' }).click();
  await page.getByRole('heading', { name: 'turn.qrs' }).waitFor();
  await node(page, 'Motors Forward').waitFor();
  // It is what the robot was sent last.
  await node(page, 'Motors Forward').click();
  const field = page.getByLabel('Properties').getByLabel('Power (%)', { exact: true });
  await eventually('the power is that of the robot', async () => (await field.inputValue()) === '55');
  await panel(page).getByRole('link', { name: 'Its page' }).click();
  await page.getByRole('link', { name: 'New diagram in the studio' }).waitFor();
  await page.context().close();
});

test('another browser that is in control keeps this one from sending, and not from stopping', async () => {
  const first = await look.open(`${robot.url}studio/`);
  await first.getByLabel('Open', { exact: true }).setInputFiles(join(home, 'turn.qrs'));
  await panel(first).getByRole('button', { name: 'Send and run' }).click();
  await eventually('the motor turns', () => power() === 40);
  const second = await look.open(`${robot.url}studio/`);
  const robots = panel(second);
  await robots.getByText(/is in control\./).waitFor();
  expect(await robots.getByRole('button', { name: 'Send and run' }).isDisabled()).toBe(true);
  await robots.getByText('turn.qrs runs, which is not what is open here.').waitFor();
  await robots.getByRole('button', { name: 'Stop', exact: true }).click();
  await eventually('the motor rests', () => power() === 0);
  await robots.getByRole('button', { name: 'Take control' }).click();
  await panel(first)
    .getByText(/is in control\./)
    .waitFor();
  await first.context().close();
  await second.context().close();
});

test('a studio without a robot opens that of a robot with the project', async () => {
  const site = await Site.start();
  const page = await look.open(site.url);
  await page.getByLabel('Open', { exact: true }).setInputFiles(join(home, 'turn.qrs'));
  await page.getByRole('heading', { name: 'turn.qrs' }).waitFor();
  await page.getByText('To a robot', { exact: true }).click();
  const address = page.getByLabel('Address of the robot');
  await address.fill('not an address');
  await page.getByRole('button', { name: 'Open there' }).click();
  await page.getByText(/An address is a name or numbers/).waitFor();
  await address.fill(new URL(robot.url).host);
  const opened = page.context().waitForEvent('page');
  await address.press('Enter');
  const there = await opened;
  await there.getByRole('heading', { name: 'turn.qrs' }).waitFor();
  expect(there.url()).toBe(`${robot.url}studio/`);
  await panel(there).getByRole('button', { name: 'Send and run' }).click();
  await eventually('the motor turns', () => power() === 40);
  await panel(there).getByRole('button', { name: 'Stop', exact: true }).click();
  await eventually('the motor rests', () => power() === 0);
  await page.context().close();
  await site.end();
});
