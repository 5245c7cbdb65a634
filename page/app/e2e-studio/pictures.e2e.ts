// A person puts pictures into a world, by a button, dropped and pasted, and draws by hand.

import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import type { Locator, Page } from 'playwright-core';
import { expect, test } from 'vitest';
import { barriers, eventually } from '../e2e/robot.js';
import { stored } from '../src/studio/world/pictures';
import { begin, button } from './begin';
import { drafted } from './site';

const here = begin();

const item = (page: Page, key: string): Locator => page.locator(`.item[data-key="${key}"]`);

/** A page with a world. */
async function opened(): Promise<Page> {
  const page = await here.open();
  await page.locator('.svelte-flow__node').first().waitFor();
  await button(page, 'World').click();
  await button(page, 'Make a world').click();
  await item(page, 'robot 0').waitFor();
  return page;
}

/** The world of the project as a file, and its images. */
async function savedOf(page: Page): Promise<{ world: string; images: ReturnType<typeof stored> }> {
  const download = page.waitForEvent('download');
  await button(page, 'Save').click();
  const file = join(here.home, 'pictures.qrs');
  await (await download).saveAs(file);
  const draft = await drafted(new Uint8Array(readFileSync(file)));
  return { world: draft.world() ?? '', images: stored(draft.images() ?? '') };
}

/** A picture of these pixels, half black, as the browser writes it. */
async function painted(page: Page, width: number, height: number, type: string): Promise<Buffer> {
  const address = await page.evaluate(
    ([across, down, kind]) => {
      const canvas = document.createElement('canvas');
      [canvas.width, canvas.height] = [across, down];
      const pen = canvas.getContext('2d');
      pen?.fillRect(0, 0, across / 2, down);
      return canvas.toDataURL(kind);
    },
    [width, height, type] as const,
  );
  return Buffer.from(address.split(',')[1] ?? '', 'base64');
}

async function choose(page: Page, name: string, mimeType: string, buffer: Buffer): Promise<void> {
  const asked = page.waitForEvent('filechooser');
  await button(page, 'Add: Picture').click();
  await (await asked).setFiles({ name, mimeType, buffer });
}

/** What begins every file in PNG. */
const isPng = (text: string): boolean => text.startsWith('iVBORw0KGgo');
const rectOf = (world: string): number[] =>
  (/<image [^>]*rect="([^"]*)"/.exec(world)?.[1] ?? '').split(':').map(Number);

test('a picture is chosen, seen, moved, changed and removed, and each of these is taken back', async () => {
  const page = await opened();
  await choose(page, 'my line.jpeg', 'image/jpeg', await painted(page, 400, 200, 'image/jpeg'));
  await item(page, 'image 0').waitFor();
  // It is on the floor of the run, too.
  await page.locator('image[href^="data:image/png"]').first().waitFor({ state: 'attached' });
  const first = await savedOf(page);
  expect(first.images.map(({ path, text }) => [path, isPng(text)])).toEqual([['my line.png', true]]);
  expect(first.world).toContain(`imageId="${first.images[0]?.id}"`);
  const [, , width = 0, height = 0] = rectOf(first.world);
  expect(width / height).toBeCloseTo(2, 1);
  if (process.env['SHOTS']) await page.screenshot({ path: join(process.env['SHOTS'], 'studio-picture.png') });
  expect(await barriers(page)).toEqual([]);

  const form = page.getByLabel('Properties of the thing');
  const [shown] = await Promise.all([form.locator('img').getAttribute('src')]);
  expect(shown).toBe(`data:image/png;base64,${first.images[0]?.text}`);
  const asked = page.waitForEvent('filechooser');
  await form.getByRole('button', { name: 'Choose another picture' }).click();
  const svg =
    '<?xml version="1.0"?><svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 30 30"><rect width="9" height="9"/></svg>';
  await (await asked).setFiles({ name: 'a & b.svg', mimeType: 'image/svg+xml', buffer: Buffer.from(svg) });
  await form.locator('img[src^="data:image/svg"]').waitFor();
  const second = await savedOf(page);
  expect(second.images.map(({ path, text }) => [path, text])).toEqual([
    ['a & b.svg', svg.slice(svg.indexOf('<svg'))],
  ]);
  expect(rectOf(second.world)[2]).toBeCloseTo(width, 1);
  expect(rectOf(second.world)[3]).toBeCloseTo(width, 1);

  await item(page, 'image 0').focus();
  await page.keyboard.press('ArrowRight');
  await eventually(
    'it has moved',
    async () => rectOf((await savedOf(page)).world)[0] !== rectOf(second.world)[0],
  );
  await item(page, 'image 0').focus();
  await page.keyboard.press('Delete');
  await eventually('it is gone', async () => (await item(page, 'image 0').count()) === 0);
  expect((await savedOf(page)).images).toEqual([]);

  for (let back = 0; back < 3; back += 1) await page.keyboard.press('Control+z');
  await item(page, 'image 0').waitFor();
  expect(await savedOf(page)).toEqual(first);
  await page.keyboard.press('Control+z');
  await eventually('there is none', async () => (await savedOf(page)).images.length === 0);
  await page.context().close();
});

test('pictures are dropped and pasted', async () => {
  const page = await opened();
  const bytes = (await painted(page, 40, 40, 'image/png')).toString('base64');
  const give = (kind: 'drop' | 'paste') =>
    page.evaluate(
      ([letters, how]) => {
        const data = new DataTransfer();
        const content = Uint8Array.from(atob(letters), (one) => one.charCodeAt(0));
        data.items.add(new File([content], 'spot.png', { type: 'image/png' }));
        const sheet = document.querySelector('.sheet > svg');
        const { left, top } = sheet?.getBoundingClientRect() ?? { left: 0, top: 0 };
        const event =
          how === 'drop'
            ? new DragEvent('drop', {
                dataTransfer: data,
                bubbles: true,
                cancelable: true,
                clientX: left + 90,
                clientY: top + 90,
              })
            : new ClipboardEvent('paste', { clipboardData: data, bubbles: true, cancelable: true });
        sheet?.dispatchEvent(event);
      },
      [bytes, kind] as const,
    );
  await give('drop');
  await item(page, 'image 0').waitFor();
  await give('paste');
  await item(page, 'image 1').waitFor();
  // Another one of the same place is seen beside it; what is no picture is named.
  await give('drop');
  await item(page, 'image 2').waitFor();
  const { images, world } = await savedOf(page);
  expect(images.map(({ text }) => isPng(text))).toEqual([true, true, true]);
  const rects = [...world.matchAll(/<image [^>]*rect="([^"]*)"/g)].map(([, rect]) => rect);
  expect(new Set(rects).size).toBe(3);
  // A project that is dropped is still opened: nothing else takes it.
  expect(page.url()).toContain(here.site.url);
  await page.context().close();
});

test('what is no picture, or too large, is refused in words and changes nothing', async () => {
  const page = await opened();
  const before = await savedOf(page);
  await choose(page, 'letter.png', 'image/png', Buffer.from('no picture at all'));
  await page.getByText('letter.png is not added: this browser knows no picture in it').waitFor();
  await choose(page, 'huge.png', 'image/png', Buffer.alloc(33 << 20));
  await page.getByText('huge.png is not added: it is too large').waitFor();
  const long = `<svg xmlns="http://www.w3.org/2000/svg">${' '.repeat(3 << 20)}</svg>`;
  await choose(page, 'long.svg', 'image/svg+xml', Buffer.from(long));
  await page.getByText('long.svg is not added: it is too large').waitFor();
  expect(await savedOf(page)).toEqual(before);
  // A photograph of many megabytes becomes a picture of few.
  const noise = await page.evaluate(() => {
    const canvas = document.createElement('canvas');
    [canvas.width, canvas.height] = [2600, 1500];
    const pen = canvas.getContext('2d');
    const data = pen?.createImageData(2600, 1500);
    if (!pen || !data) throw new Error('no pen');
    let seed = 1;
    for (let at = 0; at < data.data.length; at += 1) {
      seed = (seed * 48271) % 2147483647;
      data.data[at] = at % 4 === 3 ? 255 : seed;
    }
    pen.putImageData(data, 0, 0);
    return canvas.toDataURL('image/jpeg', 0.95);
  });
  await choose(page, 'photo.jpg', 'image/jpeg', Buffer.from(noise.split(',')[1] ?? '', 'base64'));
  await item(page, 'image 0').waitFor();
  const [kept] = (await savedOf(page)).images;
  expect(kept?.text.length).toBeGreaterThan(1000);
  expect(kept?.text.length).toBeLessThan(((2 << 20) * 4) / 3 + 4);
  await page.context().close();
});

test('a hand draws a line, which moves as a whole', async () => {
  const page = await opened();
  await button(page, 'Add: Drawn by hand').click();
  const sheet = page.getByRole('application', { name: 'The world to be edited' });
  const box = await sheet.boundingBox();
  if (!box) throw new Error('no sheet');
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (let step = 1; step <= 12; step += 1) await page.mouse.move(x + 8 * step, y + 30 * Math.sin(step / 2));
  await page.mouse.up();
  await item(page, 'stylus 0').waitFor({ state: 'attached' });
  // Escape in the midst of another one leaves nothing of it.
  await button(page, 'Add: Drawn by hand').click();
  await page.mouse.move(x, y + 80);
  await page.mouse.down();
  await page.mouse.move(x + 60, y + 120, { steps: 6 });
  await page.keyboard.press('Escape');
  await page.mouse.move(x + 90, y + 90, { steps: 3 });
  await page.mouse.up();
  await page.getByText('Drawn by hand: drag').waitFor({ state: 'detached' });
  expect(await item(page, 'stylus 1').count()).toBe(0);
  // A number that was typed is taken back as everything else.
  await item(page, 'stylus 0').focus();
  await page.keyboard.press('Enter');
  const wide = page.getByLabel('Properties of the thing').getByLabel('Line width, cm');
  const width = () => item(page, 'stylus 0').locator('path').last().getAttribute('stroke-width');
  const before = await width();
  await wide.fill('5');
  await wide.press('Enter');
  await expect.poll(width).not.toBe(before);
  await page.keyboard.press('Control+z');
  await expect.poll(width).toBe(before);
  const { world } = await savedOf(page);
  expect(world.match(/<stylusLine /g)?.length).toBeGreaterThan(8);
  await item(page, 'stylus 0').focus();
  await page.keyboard.press('ArrowDown');
  await eventually('it has moved', async () => {
    const now = (await savedOf(page)).world;
    return now !== world && now.match(/<stylusLine /g)?.length === world.match(/<stylusLine /g)?.length;
  });
  if (process.env['SHOTS']) await page.screenshot({ path: join(process.env['SHOTS'], 'studio-stylus.png') });
  await page.context().close();
});
