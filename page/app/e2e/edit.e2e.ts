// Texts that are edited in the page: programs of the robot and its configuration.

import { readFileSync } from 'node:fs';
import type { Page } from 'playwright-core';
import { expect, test } from 'vitest';
import { barriers, eventually } from './robot.js';
import { scene } from './scene.js';

const there = scene();

/** The editor, once it is loaded; the plain field before it has no such attribute. */
const editor = (page: Page, label: string) => page.locator(`[contenteditable=true][aria-label="${label}"]`);

test('a program is written, fails at its line, is mended and runs', async () => {
  const page = await there.look.open(`${there.robot.url}#program`);
  await page.getByLabel('New program').fill('first.exe');
  await page.getByRole('button', { name: 'Write' }).click();
  await page.getByText('A name of at most').waitFor();
  await page.getByLabel('New program').fill('../first.py');
  await page.getByRole('button', { name: 'Write' }).click();
  await page.getByText('A name of at most').waitFor();
  await page.getByLabel('New program').fill('first.py');
  await page.keyboard.press('Enter');
  const text = editor(page, 'Text of first.py');
  await text.click();
  await page.keyboard.press('Control+A');
  await page.keyboard.press('Delete');
  // A space in a text stops nothing, and is there.
  there.robot.write('motors/M3/value', 20);
  await page.keyboard.type("print('first  line')\nprint(1 / 0)\n");
  expect(there.robot.read('motors/M3/value')).toBe('20');
  await page.getByRole('button', { name: 'Save and run' }).click();
  await page.getByText('first  line', { exact: true }).waitFor();
  await page.getByRole('list', { name: 'Errors' }).getByText('ZeroDivisionError').waitFor();
  expect(await barriers(page)).toEqual([]);
  await page.getByRole('button', { name: 'Line 2' }).click();
  await page.keyboard.press('Control+End');
  await page.keyboard.press('Shift+ArrowUp');
  await page.keyboard.type("print('mended')\n");
  await page.keyboard.press('Control+S');
  await page.getByText('as on the robot').waitFor();
  await page.getByRole('button', { name: 'Run', exact: true }).click();
  await page.getByText('mended', { exact: true }).waitFor();
  await expect.poll(() => page.getByRole('list', { name: 'Errors' }).count()).toBe(0);
  // Somebody else replaces it: that is said before it is overwritten.
  await text.click();
  await page.keyboard.press('Control+End');
  await page.keyboard.type("print('mine')\n");
  const theirs = { name: 'first.py', mimeType: 'text/x-python', buffer: Buffer.from("print('theirs')\n") };
  await page.setInputFiles('input[type=file]', theirs);
  const onRobot = () => page.evaluate(async () => (await fetch('/program/first.py')).text());
  await expect.poll(onRobot).toBe("print('theirs')\n");
  await page.keyboard.press('Control+S');
  await page.getByText('Somebody else has replaced this program').waitFor();
  expect(await onRobot()).toBe("print('theirs')\n");
  await page.keyboard.press('Control+S');
  await page.getByText('as on the robot').waitFor();
  expect(await onRobot()).toContain("print('mine')");
  await page.getByRole('link', { name: 'Close' }).click();
  await page.getByRole('link', { name: 'Edit first.py' }).click();
  await expect.poll(() => text.textContent()).toContain("print('mended')");
  await page.context().close();
});

test('a program from Windows is as it came, and keeps its ends of lines', async () => {
  const page = await there.look.open(`${there.robot.url}#program`);
  const buffer = Buffer.from("print('a')\r\nprint('b')\r\n");
  await page.setInputFiles('input[type=file]', { name: 'windows.py', mimeType: 'text/x-python', buffer });
  await page.getByRole('link', { name: 'Edit windows.py' }).click();
  const text = editor(page, 'Text of windows.py');
  await text.click();
  await page.getByText('as on the robot').waitFor();
  await page.keyboard.press('Control+End');
  await page.keyboard.type("print('c')");
  await page.keyboard.press('Enter');
  await page.getByText('changed', { exact: true }).waitFor();
  await page.keyboard.press('Control+S');
  await page.getByText('as on the robot').waitFor();
  const onRobot = await page.evaluate(async () => (await fetch('/program/windows.py')).text());
  expect(onRobot).toBe("print('a')\r\nprint('b')\r\nprint('c')\r\n");
  await page.context().close();
});

test('a program that was never saved is in the list, and is renamed and deleted when it is', async () => {
  const page = await there.look.open(`${there.robot.url}#program`);
  await page.getByLabel('New program').fill('draft.py');
  await page.keyboard.press('Enter');
  await editor(page, 'Text of draft.py').waitFor();
  await page.getByRole('link', { name: 'Close' }).click();
  await page.getByText('not on the robot').waitFor();
  await page.getByRole('button', { name: 'Discard draft.py' }).click();
  await page.getByText('not on the robot').waitFor({ state: 'detached' });
  for (const name of ['one.py', 'two.py']) {
    const file = { name, mimeType: 'text/x-python', buffer: Buffer.from(`print('${name}')\n`) };
    await page.setInputFiles('input[type=file]', file);
  }
  await page.getByRole('link', { name: 'Edit one.py' }).click();
  const text = editor(page, 'Text of one.py');
  await text.click();
  await page.keyboard.press('Control+End');
  await page.keyboard.type('# mine\n');
  await page.getByRole('button', { name: 'Rename or delete one.py' }).click();
  const name = page.getByLabel('New name');
  const rename = page.getByRole('button', { name: 'Rename', exact: true });
  for (const bad of ['two.py', 'a:b.py', '../one.py', '.py']) {
    await name.fill(bad);
    expect(await rename.isDisabled(), bad).toBe(true);
  }
  expect(await barriers(page)).toEqual([]);
  // The robot has the last word.
  await name.fill('none/one.py');
  await rename.click();
  await page.getByText("'none/one.py' is no name for a program").waitFor();
  await page.getByRole('button', { name: 'Dismiss' }).click();
  await page.getByRole('button', { name: 'Rename or delete one.py' }).click();
  await name.fill('best.py');
  await page.keyboard.press('Enter');
  // What was changed in it goes along.
  await expect.poll(() => editor(page, 'Text of best.py').textContent()).toContain('# mine');
  const list = () =>
    page.evaluate(async () => {
      const programs = (await (await fetch('/programs')).json()) as { name: string }[];
      return programs.map(({ name }) => name).filter((name) => /^(one|two|best)/.test(name));
    });
  expect(await list()).toEqual(['best.py', 'two.py']);
  await page.getByRole('button', { name: 'Rename or delete best.py' }).click();
  await page.getByRole('button', { name: 'Delete', exact: true }).click();
  expect(await list()).toContain('best.py');
  await page.getByRole('button', { name: 'Delete best.py for good' }).click();
  await page.getByRole('button', { name: 'Run best.py' }).waitFor({ state: 'detached' });
  expect(await list()).toEqual(['two.py']);
  await page.context().close();
});

test('what cannot be done is said, and not offered', async () => {
  const page = await there.look.open(`${there.robot.url}#configuration`);
  const other = await there.look.open(`${there.robot.url}#program`);
  await other.getByRole('button', { name: 'Take control' }).click();
  await page.getByText('is in control: take control first').waitFor();
  expect(await page.getByRole('button', { name: 'Apply' }).isDisabled()).toBe(true);
  await page.getByRole('link', { name: 'Program' }).click();
  await page.getByText('is in control: take control first').waitFor();
  expect(await page.getByLabel(/^Send a program/).isDisabled()).toBe(true);
  await other.context().close();
  await page.getByText('is in control: take control first').waitFor({ state: 'detached' });
  await page.getByRole('link', { name: 'Configuration' }).click();
  const open = page.getByLabel('Open a file:');
  const before = await editor(page, 'Configuration').textContent();
  const file = (name: string, buffer: Buffer) => ({ name, mimeType: 'text/plain', buffer });
  await open.setInputFiles(file('disk.img', Buffer.alloc((1 << 20) + 1, 'x')));
  await page.getByText('disk.img is larger than 1 MiB').waitFor();
  await open.setInputFiles(file('photo.lua', Buffer.from([0xff, 0xd8, 0, 1])));
  await page.getByText('photo.lua is no text').waitFor();
  expect(await editor(page, 'Configuration').textContent()).toBe(before);
  await open.setInputFiles(file('robot.lua', Buffer.from('-- from a file\n')));
  await expect.poll(() => editor(page, 'Configuration').textContent()).toContain('-- from a file');
  await page.getByRole('button', { name: 'Discard changes' }).click();
  await page.context().close();
});

test('a configuration is refused at its line, replaced, and comes back by undo', async () => {
  const page = await there.look.open(`${there.robot.url}#configuration`);
  const before = there.robot.read('config');
  const text = editor(page, 'Configuration');
  await text.click();
  await page.keyboard.press('Control+End');
  await page.keyboard.type('trikfs.lamp = = 1\n');
  await page.getByRole('button', { name: 'Apply' }).click();
  await page.getByText('Refused, the robot goes on').waitFor();
  await page.getByRole('button', { name: /^Line \d+$/ }).click();
  expect(there.robot.read('config')).toBe(before);
  expect(await barriers(page)).toEqual([]);
  // What was written stays while another view is open.
  await page.getByRole('link', { name: 'Log' }).click();
  await page.getByRole('link', { name: 'Configuration' }).click();
  await expect.poll(() => text.textContent()).toContain('trikfs.lamp = = 1');
  await page.getByRole('button', { name: 'Discard changes' }).click();
  await page.keyboard.press('Tab');
  await text.click();
  await page.keyboard.press('Control+End');
  await page.keyboard.type(
    "trikfs.lamp = { src = fake { data = '123', period_ms = 50, loop = true }, input_tuple_size = 1, output_tuple_size = 1, on_event = true, " +
      'converter = function(x) return x.none.such end }\n',
  );
  await page.keyboard.press('Control+S');
  await page.getByText(/^config ok: \d+ nodes$/).waitFor();
  await eventually('it is in force', () => there.robot.read('config').includes('trikfs.lamp'));
  // Its converter fails as soon as the page shows the node, and the line is marked.
  await page.getByRole('list', { name: 'Errors' }).getByText('attempt to index').waitFor();
  await page.getByRole('button', { name: 'Undo' }).click();
  await eventually('the one before is in force', () => there.robot.read('config') === before);
  await expect.poll(() => text.textContent()).not.toContain('trikfs.lamp');
  // What failed is not there any more.
  await expect.poll(() => page.getByRole('list', { name: 'Errors' }).count()).toBe(0);
  await page.getByRole('button', { name: 'Redo' }).click();
  await eventually('the new one is in force again', () => there.robot.read('config').includes('lamp'));
  await page.getByRole('button', { name: 'Undo' }).click();
  await eventually('all is as it was', () => there.robot.read('config') === before);
  const [download] = await Promise.all([
    page.waitForEvent('download'),
    page.getByRole('button', { name: 'Save as a file' }).click(),
  ]);
  expect(readFileSync(await download.path(), 'utf8').trim()).toBe(before);
  await page.context().close();
});

test('what somebody else has put in force meanwhile is not overwritten without a question', async () => {
  const page = await there.look.open(`${there.robot.url}#configuration`);
  const before = there.robot.read('config');
  const text = editor(page, 'Configuration');
  await text.click();
  await page.keyboard.press('Control+Home');
  await page.keyboard.type('-- mine\n');
  there.robot.write('config', `-- theirs\n${before}\n`);
  await page.getByRole('button', { name: 'Apply' }).click();
  await page.getByText('Somebody else has replaced the configuration').waitFor();
  expect(there.robot.read('config')).toContain('theirs');
  await page.getByRole('button', { name: 'Apply' }).click();
  await eventually('mine is in force', () => there.robot.read('config').startsWith('-- mine'));
  there.robot.write('config', `${before}\n`);
  await page.context().close();
});

test('no page has complained', () => {
  expect(there.look.complaints).toEqual([]);
});
