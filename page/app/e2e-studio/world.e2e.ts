// A person draws a world with its rules, by mouse and by keys, and has a program judged in it.

import { execFileSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import type { Locator, Page } from 'playwright-core';
import { expect, test } from 'vitest';
import { barriers, eventually } from '../e2e/robot.js';
import { begin, button } from './begin';
import { SITE, Site, drafted, library } from './site';

const ROOT = resolve(import.meta.dirname, '../../..');
const TRIK = process.env['TRIK'] ?? join(ROOT, 'target/debug/trik');

const here = begin();

const item = (page: Page, key: string): Locator => page.locator(`.item[data-key="${key}"]`);

/** The text of the world, from the project as a file. */
async function worldOf(page: Page): Promise<string> {
  const download = page.waitForEvent('download');
  await button(page, 'Save').click();
  const file = join(here.home, 'world.qrs');
  await (await download).saveAs(file);
  const draft = await drafted(new Uint8Array(readFileSync(file)));
  return draft.world() ?? '';
}

/** A save of a program that drives ahead for some seconds. */
async function ahead(world?: string): Promise<Uint8Array> {
  const made = (await library()).blank('ahead.qrs');
  if (!made.ok) throw new Error('no draft');
  const draft = made.value;
  const [{ id: diagram } = { id: '' }] = draft.about().diagrams;
  const start = draft.sheet(diagram)?.blocks[0]?.id ?? '';
  const change: Parameters<typeof draft.apply>[0] = {
    do: 'add',
    diagram,
    blocks: [
      { kind: 'TrikV6EnginesForward', at: [200, 100], properties: { Ports: 'M3, M4', Power: '100' } },
      { kind: 'Timer', at: [300, 100], properties: { Delay: '4000' } },
      { kind: 'FinalNode', at: [400, 100] },
    ],
    links: [
      { from: 0, to: 1 },
      { from: 1, to: 2 },
    ],
  };
  const added = draft.apply(change);
  if (!added.ok) throw new Error(added.error.problems[0]?.message);
  const connected = draft.apply({ do: 'connect', from: start, to: added.value[0] ?? '', guard: '' });
  if (world !== undefined) draft.apply({ do: 'world', text: world });
  const saved = draft.save();
  if (!connected.ok || !saved.ok) throw new Error('no save');
  return saved.value;
}

async function opened(options = {}, world?: string): Promise<Page> {
  const page = await here.look.open(here.site.url, options);
  await page.locator('.svelte-flow__node').first().waitFor();
  const buffer = Buffer.from(await ahead(world));
  const chosen = { name: 'ahead.qrs', mimeType: 'application/zip', buffer };
  await page.locator('input[type=file][accept^=".qrs"]').setInputFiles(chosen);
  await page.getByRole('heading', { name: 'ahead.qrs' }).waitFor();
  return page;
}

/** Where a place of the world is seen, in cm, by a wall from -30 to 150 cm. */
async function spots(page: Page): Promise<(x: number, y: number) => [number, number]> {
  const [left, right] = await Promise.all(
    [3, 1].map((at) => item(page, `wall ${at}`).locator('path').last().boundingBox()),
  );
  if (!left || !right) throw new Error('no room is seen');
  const middle = (one: typeof left) => one.x + one.width / 2;
  const scale = (middle(right) - middle(left)) / 180;
  const down = left.y + left.height / 2;
  return (x, y) => [middle(left) + (x + 30) * scale, down + (y - 30) * scale];
}

/** Where the middle of the world is seen, once lines above and below the sheet have come and gone. */
async function settled(page: Page): Promise<[number, number]> {
  let before: [number, number] = [0, 0];
  return eventually('the sheet stands still', async () => {
    await page.waitForTimeout(300);
    const [x, y] = (await spots(page))(0, 0);
    const isSame = x === before[0] && y === before[1];
    before = [x, y];
    return isSame ? before : undefined;
  });
}

async function stroke(page: Page, from: [number, number], to: [number, number]): Promise<void> {
  await page.mouse.move(...from);
  await page.mouse.down();
  await page.mouse.move((from[0] + to[0]) / 2, (from[1] + to[1]) / 2, { steps: 3 });
  await page.mouse.move(...to, { steps: 3 });
  await page.mouse.up();
}

test('a world, its rules and a run, with the mouse', async () => {
  const page = await opened();
  await button(page, 'World').click();
  await page.getByText('This project has no world').waitFor();
  await button(page, 'Make a world').click();
  await item(page, 'robot 0').waitFor();
  const at = await spots(page);

  await button(page, 'Add: Wall').click();
  await stroke(page, at(20, 60), at(80, 60));
  // A box without a height is not seen as one.
  await item(page, 'wall 4').waitFor({ state: 'attached' });
  await page.getByText('not saved').waitFor();
  const sheet = page.getByRole('application', { name: 'The world to be edited' });
  await sheet.getByRole('button', { name: 'Nearer' }).click();
  const near = await settled(page);
  const wall = page.getByLabel('Properties of the thing').getByLabel('Begin: x');
  await wall.fill('-200');
  await wall.press('Enter');
  await eventually('it is longer', async () => (await worldOf(page)).includes('begin="-200:60"'));
  await wall.fill('20');
  await wall.press('Enter');
  // What is looked at stays where it is.
  expect(await settled(page)).toEqual(near);
  await sheet.getByRole('button', { name: 'Farther' }).click();
  await button(page, 'Add: Region').click();
  await stroke(page, at(90, 10), at(130, 50));
  await item(page, 'regionRectangle 0').waitFor();
  const settings = page.getByLabel('Properties of the thing');
  await settings.getByLabel('Name').fill('goal');
  await settings.getByLabel('Name').press('Enter');
  await settings.getByLabel('Width, cm').waitFor();
  expect(await settings.getByLabel('Width, cm').inputValue()).toBe('40');

  // A drag is one change: it is taken back at once.
  await stroke(page, at(5, 30), at(15, 40));
  await eventually('the robot has gone', async () => (await worldOf(page)).includes('position="1.25:31.25"'));
  await page.keyboard.press('Control+z');
  await eventually('it is back', async () => (await worldOf(page)).includes('position="-8.75:21.25"'));
  const world = await worldOf(page);
  expect(world).toContain('<wall id="wall1" begin="20:60" end="80:60"/>');
  expect(world).toContain('<region id="goal" x="90" y="10" width="40" height="40" type="rectangle"');

  await button(page, 'Rules').click();
  await button(page, 'Event').click();
  const event = page.locator('details', { hasText: 'Event: event1' });
  await event.getByLabel('Always').selectOption('inside');
  await event.getByRole('combobox', { name: /^Region/ }).waitFor();
  expect(await event.getByRole('combobox', { name: /^Region/ }).inputValue()).toBe('goal');
  expect(await event.getByLabel('The task is done').count()).toBe(1);

  await page.getByLabel('Speed').selectOption('fastest');
  await button(page, 'Run').click();
  await page.locator('.verdict').getByText('The task is done.').waitFor();
  if (process.env['SHOTS']) await page.screenshot({ path: join(process.env['SHOTS'], 'studio-rules.png') });
  await page.context().close();
});

test('rules as text are taken when they can be read, and mistakes lead to their lines', async () => {
  const page = await opened();
  await button(page, 'World').click();
  await button(page, 'Make a world').click();
  await button(page, 'Rules').click();
  await page.getByText('This world has no rules').waitFor();
  await button(page, 'Make rules').click();
  await button(page, 'As text').click();
  const text = page.locator('.cm-content');
  await text.click();
  await page.keyboard.press('Control+a');
  await page.keyboard.insertText('<constraints>\n<timelimit value="1000"/>\n<event id="a">\n</constraints>');
  await page.getByText('Not taken yet. Line 4').waitFor();
  expect(await worldOf(page)).toContain('value="60000"');
  // What only the draft refuses stays to be mended, too.
  await text.click();
  await page.keyboard.press('Control+a');
  await page.keyboard.insertText('<constraints>\n<timelimit value="&nothing;"/>\n</constraints>');
  await page.getByText('Not taken yet. Line 1').waitFor();
  expect(await text.textContent()).toContain('&nothing;');
  expect(await worldOf(page)).toContain('value="60000"');
  await text.click();
  await page.keyboard.press('Control+a');
  await page.keyboard.insertText(
    '<constraints>\n<timelimit value="1000"/>\n<!-- kept -->\n<constraint failMessage="x"><inside objectId="robot1" regionId="nowhere"/></constraint>\n<ts:timer-success-event timeout="300"/>\n</constraints>',
  );
  await page.getByText('Not taken yet').waitFor({ state: 'detached' });
  await page.getByText('No such region: nowhere').first().waitFor();
  // Letters that are deleted in the text are not blocks.
  await page.keyboard.press('Backspace');
  await page.keyboard.press('Control+z');
  await button(page, 'Program').click();
  expect(await page.locator('.svelte-flow__node').count()).toBe(5);
  await page.getByText('Mistakes:').click();
  await page.locator('li', { hasText: 'nowhere' }).getByRole('button').click();
  await text.waitFor();
  // What the forms do not know is shown, and stays.
  await button(page, 'As forms').click();
  await page.getByText('Not known here: kept as it is.').waitFor();
  await page.getByLabel('Value, ms').fill('2000');
  await page.getByLabel('Value, ms').press('Enter');
  await eventually('it is changed', async () => (await worldOf(page)).includes('value="2000"'));
  expect(await worldOf(page)).toContain('<!-- kept -->\n<constraint failMessage="x">');
  expect(await worldOf(page)).toContain('<ts:timer-success-event timeout="300"/>');
  await page.context().close();
});

test('a mistake of the world leads to its thing', async () => {
  const page = await opened(
    {},
    `<root version="20251219"><settings sizeUnit="cm"/><world><walls>
      <wall id="a" begin="0:0" end="50:0"/>
      <wall id="a" begin="0:20" end="50:20"/></walls></world><robots><robot id="trikKitRobot"/></robots></root>`,
  );
  await page.getByText('Mistakes:').click();
  await page.locator('li', { hasText: "has the id 'a' too" }).getByRole('button').click();
  const form = page.getByLabel('Properties of the thing');
  await form.getByText("has the id 'a' too").waitFor();
  expect(await form.getByLabel('Begin: y').inputValue()).toBe('20');
  await form.getByLabel('Name').fill('b');
  await form.getByLabel('Name').press('Enter');
  await form.getByText("has the id 'a' too").waitFor({ state: 'detached' });
  await page.context().close();
});

test('all of it by keys alone', async () => {
  const page = await opened();
  await button(page, 'World').focus();
  await page.keyboard.press('Enter');
  await button(page, 'Make a world').focus();
  await page.keyboard.press('Enter');
  await item(page, 'robot 0').waitFor();
  await button(page, 'Add: Ball').focus();
  await page.keyboard.press('Enter');
  await item(page, 'ball 0').waitFor();
  const before = (await worldOf(page)).match(/<ball id="ball1" x="(\S+)" y="(\S+)"/);
  await item(page, 'ball 0').focus();
  await page.keyboard.press('ArrowRight');
  await page.keyboard.press('Shift+ArrowDown');
  const [x, y] = [Number(before?.[1]) + 1, Number(before?.[2]) + 10];
  await eventually('it is moved', async () =>
    (await worldOf(page)).includes(`<ball id="ball1" x="${x}" y="${y}"`),
  );
  await item(page, 'ball 0').focus();
  await page.keyboard.press('Delete');
  await item(page, 'ball 0').waitFor({ state: 'detached' });
  await page.keyboard.press('Control+z');
  await item(page, 'ball 0').waitFor();
  await item(page, 'robot 0').focus();
  await page.keyboard.press('Enter');
  await button(page, 'Add a sensor').focus();
  await page.keyboard.press('Enter');
  await item(page, 'sensor 0').waitFor();
  const grip = page.getByRole('button', { name: 'Robot trikKitRobot: Direction' });
  await grip.focus();
  await page.keyboard.press('Shift+ArrowRight');
  await eventually('it is turned', async () => (await worldOf(page)).includes('direction="15"'));
  await page.context().close();
});

test('a finger looks around, and moves what it has chosen', async () => {
  const page = await opened({ hasTouch: true, viewport: { width: 420, height: 900 } });
  await button(page, 'World').tap();
  await button(page, 'Make a world').tap();
  await item(page, 'robot 0').tap();
  await page.getByLabel('Properties of the thing').waitFor();
  const box = await item(page, 'robot 0').boundingBox();
  if (!box) throw new Error('no robot is seen');
  const [x, y] = [box.x + box.width / 3, box.y + box.height / 2];
  const touch = await page.context().newCDPSession(page);
  const send = (type: 'touchStart' | 'touchMove' | 'touchEnd', points: [number, number][]) =>
    touch.send('Input.dispatchTouchEvent', {
      type,
      touchPoints: points.map(([at, down]) => ({ x: at, y: down })),
    });
  await send('touchStart', [[x, y]]);
  for (const far of [10, 20, 30, 40]) await send('touchMove', [[x, y + far]]);
  await send('touchEnd', []);
  await eventually(
    'the robot has moved',
    async () => !(await worldOf(page)).includes('position="-8.75:21.25"'),
  );
  const moved = await worldOf(page);
  // Beside it the finger moves the sheet, and two make it larger.
  const place = async () => (await item(page, 'robot 0').boundingBox())?.x ?? 0;
  const before = await place();
  await send('touchStart', [[x + 100, y]]);
  for (const far of [10, 20, 30]) await send('touchMove', [[x + 100 + far, y]]);
  await send('touchEnd', []);
  expect(await place()).toBeGreaterThan(before + 15);
  const width = async () => (await item(page, 'robot 0').boundingBox())?.width ?? 0;
  const small = await width();
  await send('touchStart', [
    [x + 60, y],
    [x + 100, y],
  ]);
  for (const far of [10, 20, 30])
    await send('touchMove', [
      [x + 60 - far, y],
      [x + 100 + far, y],
    ]);
  await send('touchEnd', []);
  expect(await width()).toBeGreaterThan(small * 1.3);
  expect(await worldOf(page)).toBe(moved);
  expect(await page.evaluate('document.documentElement.scrollWidth <= innerWidth')).toBe(true);
  await page.context().close();
});

test('a world that cannot be read is told, and mended as text', async () => {
  const page = await opened({}, '<root><walls/></root>');
  await button(page, 'World').click();
  await page.getByText('The world cannot be read. Line 1, column 1').waitFor();
  await button(page, 'Rules').click();
  await page.locator('.cm-content').click();
  await page.keyboard.press('Control+a');
  await page.keyboard.insertText('<root><world/><robots><robot id="trikKitRobot"/></robots></root>');
  await page.getByText('This world has no rules').waitFor();
  await button(page, 'World').click();
  await item(page, 'robot 0').waitFor();
  expect(await worldOf(page)).toContain('<world/>');
  await page.context().close();
});

test('thousands of things of a stranger, and names with scripts, do no harm', async () => {
  const page = await opened();
  await button(page, 'World').click();
  await button(page, 'Make a world').click();
  await item(page, 'robot 0').waitFor();
  await page.getByLabel('Load a world', { exact: true }).setInputFiles({
    name: 'evil.xml',
    mimeType: 'text/xml',
    buffer: Buffer.from(
      `<root><world><walls>${Array.from({ length: 4000 }, (_, at) => `<wall id="&lt;img src=x onerror=alert(1)>${at}" begin="${at}:0" end="1e9:NaN"/>`).join('')}</walls></world></root>`,
    ),
  });
  await page.getByText('more things are not drawn here').or(page.getByRole('alert')).first().waitFor();
  expect(await page.locator('img').count()).toBe(0);
  await page.context().close();
});

test.each(['light', 'dark'] as const)('there are no barriers in %s', async (colorScheme) => {
  const page = await opened({ colorScheme });
  await button(page, 'World').click();
  expect(await barriers(page)).toEqual([]);
  await button(page, 'Make a world').click();
  await item(page, 'robot 0').waitFor();
  expect(await barriers(page)).toEqual([]);
  await button(page, 'Add: Region').focus();
  await page.keyboard.press('Enter');
  await item(page, 'regionRectangle 0').waitFor();
  await page.getByText('Things of the world').click();
  await item(page, 'robot 0').click();
  await button(page, 'Add a sensor').click();
  await page.getByLabel('Properties of the thing').getByText('Physics', { exact: true }).click();
  expect(await barriers(page)).toEqual([]);
  await button(page, 'Rules').click();
  await button(page, 'Points for a region').click();
  await page.getByText('Event: points1').waitFor();
  expect(await barriers(page)).toEqual([]);
  await button(page, 'As text').click();
  await page.locator('.cm-content').waitFor();
  expect(await barriers(page)).toEqual([]);
  await page.context().close();
});

test('the world of a task is shown and stays', async () => {
  const draft = await drafted(await ahead());
  const text = readFileSync(join(ROOT, 'examples/dataflow/line.xml'), 'utf8');
  draft.apply({ do: 'world', text });
  const saved = draft.save();
  if (!saved.ok) throw new Error('no save');
  writeFileSync(join(here.home, 'task.qrs'), saved.value);
  const folder = join(here.home, 'out');
  execFileSync(TRIK, ['site', folder, '--studio', SITE, '--task', join(here.home, 'task.qrs')]);
  const tasks = await Site.start(folder);
  const page = await here.look.open(tasks.url);
  await page.getByRole('heading', { name: 'task.qrs' }).waitFor();
  await button(page, 'World').click();
  await page.getByText('are those of the task').waitFor();
  expect(await button(page, 'Add: Wall').count()).toBe(0);
  await item(page, 'robot 0').focus();
  await page.keyboard.press('Delete');
  await page.keyboard.press('ArrowRight');
  await item(page, 'robot 0').click();
  expect(await page.getByLabel('Direction, degrees').isDisabled()).toBe(true);
  expect(await barriers(page)).toEqual([]);
  await button(page, 'Rules').click();
  expect(await page.getByLabel('Value, ms').isDisabled()).toBe(true);
  expect(await button(page, 'Take back').isDisabled()).toBe(true);
  expect(await worldOf(page)).toBe(text);
  await page.context().close();
  await tasks.end();
});
