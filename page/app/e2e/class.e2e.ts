// The page of a class, over two robots and one that is not there.

import { rmSync } from 'node:fs';
import { join } from 'node:path';
import { afterAll, beforeAll, expect, test } from 'vitest';
import { ru } from '../src/class/ru';
import { ClassPage, Look, Robot, barriers, eventually, newHome } from './robot.js';

const DRIVE = "print('here')\nbrick.motor('M3').setPower(40)\nscript.wait(60000)\n";

const home = newHome();
let look: Look;
let anna: Robot;
let boris: Robot;
let room: ClassPage;

beforeAll(async () => {
  look = await Look.start();
  anna = await Robot.startIn(home, 'a');
  boris = await Robot.startIn(home, 'b');
  const lines = ['anna ./a red', 'boris ./b blue', 'clara 127.0.0.77 blue', ''];
  room = await ClassPage.start(home, lines.join('\n'));
});

afterAll(async () => {
  await look?.end();
  await room?.end();
  for (const robot of [anna, boris]) await robot?.leave();
  rmSync(home, { recursive: true, force: true });
});

const program = (name = 'go.py', text = DRIVE) => ({
  name,
  mimeType: 'text/x-python',
  buffer: Buffer.from(text),
});
const power = (robot: Robot) => robot.read('motors/M3/value');
const file = 'input[type=file]';

async function shot(page: Awaited<ReturnType<Look['open']>>, name: string): Promise<void> {
  if (process.env.SHOTS) {
    await page.screenshot({ path: join(process.env.SHOTS, `class-${name}.png`), fullPage: true });
  }
}

test('a program is sent to all, runs on those that are there, and the space bar stops them', async () => {
  const page = await look.open(room.url);
  await page.getByText('2 of 3 reached, 0 running').waitFor();
  const clara = page.getByRole('article', { name: 'clara' });
  await clara.getByText('nothing takes programs at 127.0.0.77:8888').waitFor();
  await page.setInputFiles(file, program());
  await page.getByRole('button', { name: 'Send to 3 and run' }).click();
  await page.getByText('2 of 3 reached, 2 running').waitFor();
  for (const robot of [anna, boris]) {
    await eventually('the motor turns', () => power(robot) === '40');
  }
  await clara.getByText('go.py: not done: the robot is not reached').waitFor();
  await page.getByRole('article', { name: 'anna' }).getByText('go.py has started').waitFor();
  // As its tree has it, with the unit; and who has started the program.
  for (const name of ['anna', 'boris']) {
    const card = page.getByRole('article', { name });
    await card.getByText(/^battery \d+(\.\d+)? V$/).waitFor();
    await card.getByText('this page is in control').waitFor();
  }
  expect(await clara.getByText('battery').count()).toBe(0);
  await shot(page, 'runs');
  expect(await barriers(page)).toEqual([]);
  // Wherever the focus is.
  await page.getByRole('checkbox', { name: 'Choose anna' }).focus();
  await page.keyboard.press('Space');
  for (const robot of [anna, boris]) {
    await eventually('the motor rests', () => power(robot) === '0');
  }
  await page.getByText(/2 at rest, the last after \d+ ms; 1 not reached/).waitFor();
  await page.getByRole('article', { name: 'anna' }).getByText('go.py was stopped by a client').waitFor();
  expect(await page.getByRole('checkbox', { name: 'Choose anna' }).isChecked()).toBe(true);
  await shot(page, 'stopped');
  expect(await barriers(page)).toEqual([]);
  await page.context().close();
});

test('only the chosen ones run, and by the keyboard alone', async () => {
  const page = await look.open(room.url);
  await page.getByText('2 of 3 reached').waitFor();
  await page.getByRole('button', { name: 'Group red' }).press('Enter');
  await page.getByText('1 of 3 chosen').waitFor();
  await page.getByRole('checkbox', { name: 'Choose boris' }).press('Enter');
  await page.getByText('2 of 3 chosen').waitFor();
  await page.getByRole('checkbox', { name: 'Choose boris' }).press('Enter');
  await page.setInputFiles(file, program('one.py'));
  await page.getByRole('button', { name: 'Send to 1 and run' }).press('Enter');
  await eventually('the motor turns', () => power(anna) === '40');
  expect(power(boris)).toBe('0');
  await page.getByRole('button', { name: 'Stop the chosen ones' }).press('Enter');
  await eventually('the motor rests', () => power(anna) === '0');
  await page.getByRole('button', { name: 'Run one.py on 1' }).press('Enter');
  await eventually('the motor turns again', () => power(anna) === '40');
  await page.getByRole('button', { name: 'Stop all' }).press('Enter');
  await eventually('the motor rests again', () => power(anna) === '0');
  await page.context().close();
});

test('a robot that was ended and started again is there again, and the others do not wait', async () => {
  const page = await look.open(room.url);
  await page.getByText('2 of 3 reached').waitFor();
  await boris.leave();
  await page.getByText('1 of 3 reached').waitFor();
  // What its battery had is told with its age, and nobody is in control any more.
  const gone = page.getByRole('article', { name: 'boris' });
  await gone.getByText(/^battery .* V, \d+ s ago$/).waitFor();
  expect(await gone.getByText('in control').count()).toBe(0);
  await page.getByRole('article', { name: 'boris' }).getByText('no virtual robot of yours').waitFor();
  await page.setInputFiles(file, program());
  await page.getByRole('button', { name: 'Send to 3 and run' }).click();
  await eventually('the motor turns', () => power(anna) === '40');
  await page.getByRole('button', { name: 'Stop all' }).click();
  await eventually('the motor rests', () => power(anna) === '0');
  await boris.back();
  await page.getByText('2 of 3 reached').waitFor();
  await page.getByRole('link', { name: 'Its page: boris' }).waitFor();
  const url = await page.getByRole('link', { name: 'Its page: boris' }).getAttribute('href');
  expect(url).toBe(boris.url);
  await page.context().close();
});

test('failures, names and refusals are text, whatever is in them', async () => {
  const page = await look.open(room.url);
  await page.getByText('2 of 3 reached').waitFor();
  const name = '<img src=x onerror=alert(1)>.py';
  await page.setInputFiles(file, program(name, "raise ValueError('<b>bold</b>')\n"));
  await page.getByRole('button', { name: 'Send to 3 and run' }).click();
  await page.getByRole('article', { name: 'anna' }).getByText('has failed').waitFor();
  expect(await page.locator('img, article b').count()).toBe(0);
  await page.setInputFiles(file, program('a:b.py'));
  await page.getByRole('button', { name: 'Send to 3 and run' }).click();
  await page.getByText('cannot be a program').waitFor();
  await page.context().close();
});

test('on a telephone, in the dark and in Russian nothing is missing and nothing bars the way', async () => {
  const page = await look.open(room.url, {
    locale: 'ru-RU',
    colorScheme: 'dark',
    viewport: { width: 390, height: 800 },
  });
  await page.getByText(ru.sum({ all: 3, there: 2, run: 0 })).waitFor();
  await page.setInputFiles(file, program());
  await page.getByRole('button', { name: ru.sendRun(3) }).click();
  await page.getByText(ru.runs('go.py')).first().waitFor();
  await shot(page, 'phone');
  expect(await barriers(page)).toEqual([]);
  const wide = await page.evaluate(() => document.documentElement.scrollWidth > innerWidth);
  expect(wide).toBe(false);
  await page.getByRole('button', { name: ru.stopAll }).click();
  await eventually('the motor rests', () => power(anna) === '0');
  await page
    .getByText(/\u043e\u0441\u0442\u0430\u043d\u043e\u0432\u043b\u0435\u043d\u043e: 2/)
    .first()
    .waitFor();
  expect(await page.getByText(/was stopped|has started/).count()).toBe(0);
  await page.context().close();
});

test('no page has complained', () => {
  expect(look.complaints).toEqual([]);
});
