// The past in a browser: the last minutes of a robot, a recording from a disk, and two runs beside each other.

import assert from 'node:assert/strict';
import { join } from 'node:path';
import { test } from 'vitest';
import { barriers, eventually, until } from './robot.js';
import { scene } from './scene.js';

const there = scene();

const motor = () => there.robot.read('motors/M3/value');

/** What the page shows of the motor. */
function shown(page) {
  const text = page
    .getByRole('article', { name: 'motors/M3', exact: true })
    .getByRole('button', { name: /duty_cycle: show it in the graph/ });
  return async () => /^\s*(\S+?),/.exec((await text.textContent()) ?? '')?.[1] ?? '';
}

const slider = (page) => page.getByRole('slider', { name: 'Time of the recording' });
const button = (page, name) => page.getByRole('button', { name, exact: true });

/** Chooses a file as a person does. */
async function give(page, name, file) {
  const asked = page.waitForEvent('filechooser');
  await button(page, name).click();
  await (await asked).setFiles(file);
}

/** A value lasts so long: a recording of it is as long, and has moments within it. */
const lasts = (ms) => new Promise((done) => setTimeout(done, ms));

/** Until the browser has drawn what came of the keys. */
const drawn = (page) =>
  page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));

/** Nobody is kept from it. */
async function isUsable(page, what) {
  for (const colorScheme of /** @type {const} */ (['light', 'dark'])) {
    await page.emulateMedia({ colorScheme });
    assert.deepEqual(await barriers(page), [], `${what}, ${colorScheme}`);
  }
}

/** The motor gets 10, then 20, and goes on with it. */
async function drive() {
  there.robot.write('motors/M3/value', 10);
  await lasts(1500);
  there.robot.write('motors/M3/value', 20);
  await lasts(1500);
}

async function goesBack(page) {
  await button(page, 'The last minutes').click();
  await slider(page).waitFor();
  await until('the focus', () => slider(page).evaluate((one) => one === document.activeElement), true);
  await until('the end', shown(page), '20');
  assert.match((await slider(page).getAttribute('aria-valuetext')) ?? '', /s ago, 0:\d\d\.\d of 0:\d\d\.\d/);
  await page.keyboard.press('Home');
  await until('the beginning', shown(page), '0');
  await page.keyboard.press('End');
  // Out of sight it would follow every two seconds.
  await page.getByRole('article', { name: 'motors/M3', exact: true }).scrollIntoViewIfNeeded();
  // How long ago that was depends on the browser. What is shown may be some steps late, but not the 15 that it lasted.
  const isThere = async () => {
    await page.keyboard.press('ArrowLeft');
    await drawn(page);
    return (await shown(page)()) === '10';
  };
  await eventually('what it was then', isThere, 60_000);
  // The robot goes on.
  there.robot.write('motors/M3/value', 25);
  // In this time the page would show it.
  await lasts(700);
  assert.equal(await shown(page)(), '10');
  const set = page.getByRole('slider', { name: 'motors/M3, duty_cycle' });
  assert.ok(await set.isDisabled(), 'nothing can be moved');
  const card = page.getByRole('article', { name: 'motors/M3', exact: true });
  await card.getByText('This is the past: only Stop reaches the robot.').waitFor();
  await isUsable(page, 'the past');
}

async function stopsFromThere(page) {
  assert.equal(motor(), '25');
  await slider(page).focus();
  await page.keyboard.press('Space');
  await until('the stop', motor, '0');
  assert.equal(await shown(page)(), '10', 'the past stays');
}

async function plays(page) {
  const at = () => slider(page).evaluate((one) => Number(one.value));
  const before = await at();
  await button(page, 'Play').click();
  await eventually('it plays', async () => (await at()) > before);
  await button(page, 'Pause the recording').click();
  await button(page, 'Back by 5 seconds').click();
  await page.getByRole('link', { name: 'Log' }).click();
  await page.locator('main table').waitFor();
  await page.getByRole('link', { name: 'Configuration' }).click();
  await page.getByText('A recording does not have what "Configuration" shows').waitFor();
  assert.equal(await page.locator('main > *').count(), 1);
  await page.getByRole('link', { name: 'Instruments' }).click();
}

test('the last minutes are at any moment, a stop works there, and now is now', async () => {
  await drive();
  const page = await there.look.open(`${there.robot.url}#instruments`);
  await until('the motor', shown(page), '20');
  await goesBack(page);
  await stopsFromThere(page);
  await plays(page);
  await button(page, 'Now').click();
  await slider(page).waitFor({ state: 'detached' });
  await until('the motor now', shown(page), '0');
  await page.context().close();
});

test('a recording that was saved is opened, and compared with the robot', async () => {
  there.robot.write('motors/M3/value', 30);
  await lasts(1200);
  const page = await there.look.open(`${there.robot.url}#instruments`);
  await button(page, 'The last minutes').click();
  const saved = page.waitForEvent('download');
  await button(page, 'Save the recording').click();
  const file = join(there.robot.home, 'saved.mcap');
  await (await saved).saveAs(file);
  await button(page, 'Now').click();
  await give(page, 'Open a recording', file);
  await page.getByText('saved.mcap').waitFor();
  await page.keyboard.press('End');
  await until('its end', shown(page), '30');
  await page.getByRole('button', { name: 'motors/M3, duty_cycle: show it in the graph' }).first().click();
  await button(page, 'Compare').click();
  await button(page, 'The robot now').click();
  await page.getByText('Compared with: The robot now').waitFor();
  there.robot.write('motors/M3/value', -5);
  await page.getByRole('button', { name: /Go to .*, where motors\/M3 begins/ }).waitFor();
  await page.getByRole('rowheader', { name: 'motors/M3.duty_cycle (The robot now)' }).waitFor();
  const offset = page.getByRole('spinbutton', { name: 'Shown later by' });
  await offset.focus();
  await page.keyboard.press('ArrowUp');
  await until('the offset', () => offset.inputValue(), '0.1');
  await page.keyboard.press('PageDown');
  await until('the offset by a second', () => offset.inputValue(), '-0.9');
  await isUsable(page, 'two runs');
  await button(page, 'Compare no more').click();
  await give(page, 'Another recording', file);
  await page.getByText('Nodes that differ: 0').waitFor();
  await page.context().close();
});

test('what is no recording is refused with its place', async () => {
  const page = await there.look.open(`${there.robot.url}#instruments`);
  const bad = (bytes) => {
    const buffer = Buffer.from(bytes);
    return give(page, 'Open a recording', { name: 'bad.mcap', mimeType: 'application/octet-stream', buffer });
  };
  await bad([1, 2, 3]);
  await page.getByText('This is no recording').waitFor();
  await bad([0x89, 0x4d, 0x43, 0x41, 0x50, 0x30, 0x0d, 0x0a, 1]);
  await page.getByText('cut off or damaged at byte 8').waitFor();
  await isUsable(page, 'what is wrong');
  await page.context().close();
});

test('no page has complained', () => {
  assert.deepEqual(there.look.complaints, []);
});
