// The world at a moment of the past, and around a robot of which nobody knows the world. SHOTS is a folder for pictures.

import assert from 'node:assert/strict';
import { join } from 'node:path';
import { test } from 'vitest';
import { barriers, eventually, Robot, until } from './robot.js';
import { scene } from './scene.js';

const there = scene();

/** The middle of all pixels of the robot's colour, in pixels of the page, and how many there are; null without any. */
function robotAt(page) {
  return page.evaluate(() => {
    const canvas = document.querySelector('.stage canvas');
    if (!canvas) return null;
    const { width, height } = canvas;
    const { data } = canvas.getContext('2d').getImageData(0, 0, width, height);
    let [count, x, y] = [0, 0, 0];
    for (let at = 0; at < data.length; at += 4) {
      const [red, green, blue] = [data[at], data[at + 1], data[at + 2]];
      // A thin line is paler.
      if (red - green > 60 && blue - green > 20) {
        count += 1;
        x += (at / 4) % width;
        y += Math.floor(at / 4 / width);
      }
    }
    const scale = canvas.clientWidth / width;
    return count < 20 ? null : { x: (x / count) * scale, y: (y / count) * scale, count };
  });
}

const slider = (page) => page.getByRole('slider', { name: 'Time of the recording' });
const button = (page, name) => page.getByRole('button', { name, exact: true });

/** Where the robot is in words, which come once a second: x in metres. */
async function said(page) {
  const pattern = /at x (-?[\d.]+) m/;
  await page.getByText(pattern).waitFor();
  const text = (await page.locator('#world-said').textContent()) ?? '';
  return Number(pattern.exec(text)?.[1]);
}

async function isUsable(page, name) {
  for (const colorScheme of /** @type {const} */ (['light', 'dark'])) {
    await page.emulateMedia({ colorScheme });
    assert.deepEqual(await barriers(page), [], `${name}, ${colorScheme}`);
    if (process.env.SHOTS)
      await page.screenshot({ path: join(process.env.SHOTS, `${name}-${colorScheme}.png`) });
  }
}

/** The robot drives ahead until something holds. */
async function drive(what, holds, power = 60) {
  for (const motor of ['M3', 'M4']) there.robot.write(`motors/${motor}/value`, power);
  await eventually(what, holds);
  for (const motor of ['M3', 'M4']) there.robot.write(`motors/${motor}/value`, 0);
}

/** Whether the trail is in the picture: without it there are fewer pixels of its colour. */
async function hasTrail(page) {
  const box = page.getByRole('checkbox', { name: 'Trail' });
  const drawn = (await robotAt(page))?.count ?? 0;
  await box.uncheck();
  await eventually('the trail is hidden', async () => ((await robotAt(page))?.count ?? 0) < drawn);
  await box.check();
  await until('the trail is back', async () => (await robotAt(page))?.count, drawn);
}

test('the world is as it was at any moment, with the way until then', async () => {
  const page = await there.look.open(`${there.robot.url}#world`);
  const begun = await eventually('the robot', () => robotAt(page));
  const first = await said(page);
  await drive('it has moved', async () => (await said(page)) > first + 0.3);
  const moved = await said(page);
  await button(page, 'The last minutes').click();
  await slider(page).waitFor();
  await page.keyboard.press('Home');
  await until('where it was', () => said(page), first);
  // A picture comes a moment after the words beside it.
  const at = async (is) => {
    const there = await robotAt(page);
    return there && is(there) ? there : null;
  };
  const near = ({ x }) => Math.abs(x - begun.x) < 15;
  const before = await eventually('the picture of then', () => at(near));
  await page.keyboard.press('End');
  await eventually('the end', async () => (await said(page)) > first + 0.25);
  await eventually('the picture of the end', () => at(({ x }) => x > before.x + 30));
  await hasTrail(page);
  // Nothing of the past is ordered.
  assert.equal(await button(page, 'Reset').count(), 0);
  assert.equal(await page.getByText('Nothing is broken.').count(), 0);
  await isUsable(page, 'world-past');
  await page.getByRole('application').focus();
  await page.keyboard.press('Shift+ArrowRight');
  await page.keyboard.press('+');
  await button(page, 'Now').click();
  await button(page, 'Reset').waitFor();
  const carried = await said(page);
  assert.ok(Math.abs(carried - moved) < 0.04, 'nobody has carried it');
  await page.context().close();
});

/** A recording that was paused stands still. */
async function stands(page) {
  await button(page, 'Play').waitFor();
  await eventually('it stands', async () => {
    const at = (await robotAt(page))?.count;
    await page.waitForTimeout(300);
    return at === (await robotAt(page))?.count;
  });
}

/** Drives ahead while it is recorded, from back from what it has touched, and not from where the recording ends. */
async function driven(name, hasWorld) {
  const file = join(there.robot.home, name);
  const { begun, recorded } = there.robot.record(file, 8, hasWorld);
  await begun;
  const far = () => Number(there.robot.read('encoders/E3/value'));
  const before = far();
  await drive('a way', () => far() < before - 800, -60);
  await recorded;
  return file;
}

test('over a replay the world is the recorded one, at the moment of the player', async () => {
  const file = await driven('world.mcap', true);
  const live = await there.look.open(`${there.robot.url}#world`);
  const end = await said(live);
  await live.context().close();
  const player = await Robot.replay(file);
  try {
    const page = await there.look.open(`${player.url}#world`);
    await eventually('the robot', () => robotAt(page));
    assert.equal(await page.getByText('a square of the grid').count(), 0, 'it is a world');
    const first = await said(page);
    assert.ok(first > end + 0.25, `${first} ${end}`);
    await button(page, 'Play').click();
    await eventually('it drives', async () => (await said(page)) < first - 0.2);
    await button(page, 'Pause the recording').click();
    await stands(page);
    await hasTrail(page);
    await slider(page).focus();
    await page.keyboard.press('End');
    await until('where it was at the end', () => said(page), end);
    await page.keyboard.press('Home');
    await until('where it began', () => said(page), first);
    // Nothing that was recorded is ordered.
    assert.equal(await button(page, 'Reset').count(), 0);
    await page.getByRole('application').focus();
    await page.keyboard.press('Shift+ArrowRight');
    await isUsable(page, 'world-replay');
    assert.equal(await said(page), first);
    await page.context().close();
  } finally {
    await player.end();
  }
});

test('over the replay of a recording without a world the place is that of the wheels', async () => {
  const file = await driven('run.mcap', false);
  const player = await Robot.replay(file);
  try {
    const page = await there.look.open(`${player.url}#world`);
    // It is no world: the robot says where it is.
    await page.getByText('a square of the grid is half a metre').waitFor();
    await eventually('the robot', () => robotAt(page));
    const first = await said(page);
    await button(page, 'Play').click();
    await eventually('it drives', async () => (await said(page)) < first - 0.28);
    await button(page, 'Pause the recording').click();
    await stands(page);
    await hasTrail(page);
    await isUsable(page, 'world-ground');
    await page.getByRole('application').focus();
    await page.keyboard.press('0');
    const asked = page.waitForEvent('filechooser');
    await button(page, 'Open a recording').click();
    await (await asked).setFiles(join(there.robot.home, 'world.mcap'));
    await slider(page).waitFor();
    await page.keyboard.press('End');
    await until('it is a world', () => page.getByText('a square of the grid').count(), 0);
    await eventually('the robot of the file', () => robotAt(page));
    await page.context().close();
  } finally {
    await player.end();
  }
});

test('no page has complained', () => {
  assert.deepEqual(there.look.complaints, []);
});
