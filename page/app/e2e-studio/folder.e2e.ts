// A person opens a folder of the computer: projects of it are opened by a click and saved where they are.
//
// The questions of the browser cannot be answered by a test: folders are those of the page's own place on the disk, which are real.

import type { Page } from 'playwright-core';
import { expect, test } from 'vitest';
import { barriers, eventually } from '../e2e/robot.js';
import { begin, button } from './begin';
import { library } from './site';

const here = begin();

/** Answers the browser's questions: the folder `lessons`, and the file `one.qrs` in it. */
const PICKERS = `
  globalThis.lessons = async () =>
    (await navigator.storage.getDirectory()).getDirectoryHandle('lessons', { create: true });
  globalThis.showDirectoryPicker = lessons;
  globalThis.showOpenFilePicker = async () => [await (await lessons()).getFileHandle('one.qrs')];
  globalThis.put = async (name, text) => {
    const handle = await (await lessons()).getFileHandle(name, { create: true });
    const stream = await handle.createWritable();
    await stream.write(Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)));
    await stream.close();
  };
  globalThis.get = async (name) => {
    const file = await (await (await lessons()).getFileHandle(name)).getFile();
    let text = '';
    for (const byte of new Uint8Array(await file.arrayBuffer())) text += String.fromCharCode(byte);
    return btoa(text);
  };
`;

async function opened(): Promise<Page> {
  const page = await here.look.open(here.site.url, {}, (begun: Page) => void begun.addInitScript(PICKERS));
  page.setDefaultTimeout(20_000);
  await node(page, 'Initial Node').waitFor();
  const made = (await library()).blank('lesson.qrs');
  const save = made.ok ? made.value.save() : made;
  if (!save.ok) throw new Error('no project');
  const text = Buffer.from(save.value).toString('base64');
  for (const name of ['one.qrs', 'two.qrs', 'ten.qrs', 'notes.txt'])
    await page.evaluate(`put(${JSON.stringify(name)}, ${JSON.stringify(text)})`);
  await page.evaluate(`put('broken.qrs', btoa('no project'))`);
  return page;
}

const node = (page: Page, name: string) =>
  page.locator('.svelte-flow__node').filter({ has: page.locator('strong', { hasText: name }) });

async function addTimer(page: Page): Promise<void> {
  const before = await node(page, 'Timer').count();
  await button(page, 'Add Timer').click();
  await eventually('it is there', async () => (await node(page, 'Timer').count()) === before + 1);
}

/** How many blocks a file of the folder has; while the browser puts a new one in the place of the old one there may be none. */
async function blocks(page: Page, name: string): Promise<number> {
  const text = String(await page.evaluate(`get(${JSON.stringify(name)}).catch(() => '')`));
  const draft = (await library()).edit(name, new Uint8Array(Buffer.from(text, 'base64')));
  if (!draft.ok) return -1;
  return draft.value.sheet(draft.value.about().diagrams[0]?.id ?? '')?.blocks.length ?? -1;
}

test('projects of a folder are opened by a click and saved where they are', async () => {
  const page = await opened();
  await button(page, 'Open a folder').click();
  const folder = page.getByRole('navigation', { name: 'Folder lessons' });
  await folder.waitFor();
  const names = await folder.getByRole('button').allTextContents();
  expect(names.slice(0, 4)).toEqual(['broken.qrs', 'one.qrs', 'ten.qrs', 'two.qrs']);
  await button(page, 'one.qrs').click();
  await page.getByRole('heading', { name: 'one.qrs' }).waitFor();
  expect(await folder.locator('[aria-current]').textContent()).toBe('one.qrs');
  expect(await barriers(page)).toEqual([]);
  await addTimer(page);
  await page.keyboard.press('Control+s');
  await page.getByText('one.qrs was saved where it was opened.').waitFor();
  expect(await blocks(page, 'one.qrs')).toBe(3);
  expect(await blocks(page, 'two.qrs')).toBe(2);
  // What is not saved is asked for before another one is opened.
  await addTimer(page);
  await button(page, 'two.qrs').click();
  await button(page, 'Discard the changes').click();
  await page.getByRole('heading', { name: 'two.qrs' }).waitFor();
  expect(await node(page, 'Timer').count()).toBe(0);
  await button(page, 'broken.qrs').click();
  await page.getByText('broken.qrs is not opened').waitFor();
  await page.getByRole('heading', { name: 'two.qrs' }).waitFor();
  // What has come since is there after another here.look.
  await page.evaluate(`get('one.qrs').then((text) => put('new.qrs', text))`);
  await button(page, 'Look again').click();
  await button(page, 'new.qrs').waitFor();
  expect(await folder.locator('[aria-current]').textContent()).toBe('two.qrs');
  await button(page, 'Close the folder').click();
  expect(await folder.count()).toBe(0);
  await page.context().close();
});

test('a file that somebody else has changed is not written over unasked', async () => {
  const page = await opened();
  await button(page, 'Open').click();
  await page.getByRole('heading', { name: 'one.qrs' }).waitFor();
  await addTimer(page);
  await page.evaluate(`put('one.qrs', btoa('of somebody else'))`);
  await button(page, 'Save').click();
  const question = page.getByRole('alertdialog', { name: 'It is not saved' });
  await question.getByText('Somebody else has changed one.qrs').waitFor();
  expect(await barriers(page)).toEqual([]);
  expect(await page.evaluate(`get('one.qrs').then(atob)`)).toBe('of somebody else');
  await question.getByRole('button', { name: 'Cancel' }).click();
  await page.getByText('not saved', { exact: true }).waitFor();
  await button(page, 'Save').click();
  await question.getByRole('button', { name: 'Write over it' }).click();
  await page.getByText('one.qrs was saved where it was opened.').waitFor();
  expect(await blocks(page, 'one.qrs')).toBe(3);
  // It is the page's own again.
  await addTimer(page);
  await button(page, 'Save').click();
  await eventually('it is written', async () => (await blocks(page, 'one.qrs')) === 4);
  await page.context().close();
});

test('a file that may not be written, or is gone, is given as a copy; so is one with another name', async () => {
  const page = await opened();
  await page.evaluate(`
    const { showOpenFilePicker } = globalThis;
    globalThis.showOpenFilePicker = async () => {
      const [handle] = await showOpenFilePicker();
      handle.queryPermission = async () => 'prompt';
      handle.requestPermission = async () => globalThis.answer ?? 'denied';
      return [handle];
    };
  `);
  await button(page, 'Open').click();
  await page.getByRole('heading', { name: 'one.qrs' }).waitFor();
  await addTimer(page);
  await button(page, 'Save').click();
  const question = page.getByRole('alertdialog', { name: 'It is not saved' });
  await question.getByText('The browser may not write one.qrs').waitFor();
  expect(await question.getByRole('button', { name: 'Write over it' }).count()).toBe(0);
  const download = page.waitForEvent('download');
  await question.getByRole('button', { name: 'Save a copy' }).click();
  expect((await download).suggestedFilename()).toBe('one.qrs');
  expect(await blocks(page, 'one.qrs')).toBe(2);
  await page.evaluate(`
    globalThis.answer = 'granted';
    lessons().then((folder) => folder.removeEntry('one.qrs'));
  `);
  await addTimer(page);
  await button(page, 'Save').click();
  await question.getByText('one.qrs is no longer where it was opened').waitFor();
  await question.getByRole('button', { name: 'Cancel' }).click();
  await button(page, 'Rename').click();
  await page.getByLabel('Name', { exact: true }).first().fill('other');
  await page.keyboard.press('Enter');
  const other = page.waitForEvent('download');
  await button(page, 'Save').click();
  expect((await other).suggestedFilename()).toBe('other.qrs');
  await page.context().close();
});

test('a browser without folders has none of it', async () => {
  const without = 'delete globalThis.showOpenFilePicker; delete globalThis.showDirectoryPicker;';
  const page = await here.look.open(here.site.url, {}, (begun: Page) => void begun.addInitScript(without));
  await node(page, 'Initial Node').waitFor();
  expect(await button(page, 'Open a folder').count()).toBe(0);
  const chooser = page.waitForEvent('filechooser');
  await button(page, 'Open').click();
  await chooser;
  const download = page.waitForEvent('download');
  await button(page, 'Save').click();
  expect((await download).suggestedFilename()).toBe('untitled.qrs');
  await page.context().close();
});
