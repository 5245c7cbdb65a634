// The studio without a network, and what it asks the network for.

import { afterAll, beforeAll, expect, test } from 'vitest';
import { Look } from '../e2e/robot.js';
import { button } from './begin';
import { Site } from './site';

let look: Look;

beforeAll(async () => {
  look = await Look.start();
});
afterAll(() => look?.end());

test('once it was open it works without its server', async () => {
  const site = await Site.start();
  const own = site.url;
  const outside: string[] = [];
  const page = await look.open(site.url, {}, (made) =>
    made.on('request', (request) => {
      const url = request.url();
      if (!url.startsWith(own) && !/^(data|blob):/.test(url)) outside.push(url);
    }),
  );
  const blocks = page.locator('.svelte-flow__node');
  await expect.poll(() => blocks.count()).toBe(2);
  await page.evaluate('navigator.serviceWorker.ready.then(() => undefined)');
  // The worker is there once all of it is kept.
  await expect.poll(() => page.evaluate('caches.keys().then((names) => names.length)')).toBe(1);
  await site.end();
  await page.reload();
  await expect.poll(() => blocks.count()).toBe(2);
  await button(page, 'Add Timer').click();
  await expect.poll(() => blocks.count()).toBe(3);
  await button(page, 'Run').click();
  await page.getByText('The program has ended by a mistake.').waitFor();
  expect(outside).toEqual([]);
  await page.context().close();
});
