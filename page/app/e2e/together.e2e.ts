// Several people, a robot that goes and comes back, and pages of others.

import { createServer, type Server } from 'node:http';
import type { AddressInfo } from 'node:net';
import { expect, test } from 'vitest';
import { eventually } from './robot.js';
import { scene } from './scene.js';

const there = scene();

test('one is in control, the other one takes it', async () => {
  const [first, second] = [await there.look.open(there.robot.url), await there.look.open(there.robot.url)];
  await first.getByRole('button', { name: 'Take control' }).click();
  await first.getByText('You are in control').waitFor();
  await second.getByText('127.0.0.1 is in control').waitFor();
  await second.getByRole('button', { name: 'Take control' }).click();
  await second.getByText('You are in control').waitFor();
  await first.getByText('127.0.0.1 is in control').waitFor();
  await second.context().close();
  await first.getByText('Nobody is in control').waitFor();
  await first.context().close();
});

test('a robot that was started again is there again without a reload', async () => {
  const page = await there.look.open(`${there.robot.url}#log`);
  await page.getByText('Nobody is in control').waitFor();
  // A robot may be back sooner than anybody looks, so it stays away until the page has said so.
  await there.robot.restart(() => page.getByText('The page is not connected').waitFor());
  await page.getByText('The page is not connected').waitFor({ state: 'detached' });
  await page.getByRole('button', { name: 'Take control' }).click();
  await page.getByText('You are in control').waitFor();
  await page.context().close();
});

test('a page of somebody else in the same browser gets at nothing', async () => {
  const other: Server = createServer((_, answer) => answer.end('<p>other</p>'));
  await new Promise<void>((listens) => other.listen(0, '127.0.0.1', listens));
  const port = (other.address() as AddressInfo).port;
  // The browser has the cookie of the robot.
  const page = await there.look.open(there.robot.url);
  await page.getByText('Nobody is in control').waitFor();
  await page.goto(`http://127.0.0.1:${port}/`);
  const opened = await page.evaluate(
    (url) =>
      new Promise<string>((done) => {
        const socket = new WebSocket(url);
        socket.onopen = () => done('open');
        socket.onerror = () => done('refused');
      }),
    `${there.robot.url.replace('http', 'ws')}socket`,
  );
  expect(opened).toBe('refused');
  const read = await page.evaluate(async (url) => {
    try {
      return await (await fetch(url, { credentials: 'include' })).text();
    } catch {
      return 'refused';
    }
  }, `${there.robot.url}programs`);
  expect(read).toBe('refused');
  await page.setContent(`<iframe src="${there.robot.url}"></iframe>`);
  await eventually('the frame is refused', async () => {
    const frame = page.frames()[1];
    return frame !== undefined && !(await frame.content()).includes('id="page"');
  });
  await page.context().close();
  other.close();
  there.look.complaints.length = 0;
});
