// The instruments in a browser: values, graphs, and what moves.

import { readFileSync } from 'node:fs';
import assert from 'node:assert/strict';
import { test } from 'vitest';
import { barriers, eventually, until } from './robot.js';
import { scene } from './scene.js';

const there = scene();

/**
 * What a node says; a servo that is off says nothing.
 * @param {string} node
 */
function value(node) {
  try {
    return there.robot.read(`${node}/value`);
  } catch (error) {
    return error.code;
  }
}

/** Another person who looks at the instruments. */
async function look(colorScheme = 'light') {
  const page = await there.look.open(`${there.robot.url}#instruments`, { colorScheme });
  await page.getByRole('article', { name: 'motors/M3', exact: true }).waitFor();
  return page;
}

/**
 * Types a value until the node has it. A stop rests the tree at once and goes to the robot's daemon too, which rests everything
 * once more a moment later: a value between the two is lost, as a stop has to win.
 */
async function enter(text, node, wanted) {
  await eventually(`${wanted} in ${node}`, async () => {
    await text.fill(wanted);
    await text.press('Enter');
    const isThere = () => value(node) === wanted;
    return eventually(wanted, isThere, 1000).catch(() => false);
  });
}

async function sliders(page) {
  const slider = page.getByRole('slider', { name: 'motors/M3, duty_cycle' });
  await slider.focus();
  for (let at = 0; at < 30; at++) await page.keyboard.press('ArrowRight');
  await until('the motor', () => value('motors/M3'), '30');
  await until('what is said of it', () => slider.getAttribute('aria-valuetext'), '30 %');
  await page.keyboard.press('End');
  await until('the motor at the end', () => value('motors/M3'), '100');
  await page.keyboard.press('0');
  await until('the motor at zero', () => value('motors/M3'), '0');
  await page.keyboard.press('Home');
  await until('the motor at the beginning', () => value('motors/M3'), '-100');
  await page.keyboard.press('Space');
  await until('the motor after a stop', () => value('motors/M3'), '0');
  const text = page.getByRole('textbox', { name: 'New value of motors/M3, duty_cycle' });
  await enter(text, 'motors/M3', '25');
  // The focus is in the field still.
  await page.keyboard.press('Space');
  await until('the motor after a stop from its field', () => value('motors/M3'), '0');
  await enter(text, 'motors/M3', '25');
  await page.getByRole('button', { name: 'Bring motors/M3 to rest' }).click();
  await until('rest', () => value('motors/M3'), '0');
}

async function refusals(page) {
  const text = page.getByRole('textbox', { name: 'New value of servos/S6, position' });
  await text.fill('101');
  await text.press('Enter');
  await page.getByText('It was refused: position is 0 to 100, not 101').waitFor();
  for (const wrong of ['1e99', 'NaN', '1.5']) {
    await text.fill(wrong);
    await text.press('Enter');
    await page.getByText(/A number from .* is needed/).waitFor();
  }
}

async function pads(page) {
  await page.locator('summary', { hasText: 'Drive by hand' }).click();
  const pad = page.getByRole('button', { name: 'Pad for motors/M3 and motors/M4' });
  await pad.scrollIntoViewIfNeeded();
  // It moves down when something above it comes later.
  const at = async (x, y) => {
    const box = await pad.boundingBox();
    await page.mouse.move(box.x + box.width * x, box.y + box.height * y);
  };
  const isMoving = async () => value('motors/M3') !== '0';
  const touch = async () => {
    await at(0.5, 0.1);
    await page.mouse.down();
    await at(0.5, 0.06);
    await until('the pad', isMoving, true);
  };
  await touch();
  await page.mouse.up();
  await until('the pad that was let go', isMoving, false);
  await touch();
  await page.keyboard.press('Space');
  await until('the pad after a stop', isMoving, false);
  await at(0.5, 0.2);
  // In this time it would.
  await page.waitForTimeout(300);
  assert.equal(value('motors/M3'), '0', 'a pad that is held on after a stop moves nothing');
  await page.mouse.up();
  await touch();
  // Somebody else stops: what is held here must be let go first. For 400 ms a zero would be taken for the pad's own.
  await page.waitForTimeout(600);
  there.robot.write('stop', 1);
  await until('the pad after a stop from elsewhere', isMoving, false);
  // In these times it would move again, while it is held still and when it is moved.
  await page.waitForTimeout(300);
  assert.equal(value('motors/M3'), '0', 'a pad that is held still after a stop from elsewhere moves nothing');
  await at(0.5, 0.2);
  await page.waitForTimeout(300);
  assert.equal(value('motors/M3'), '0', 'a pad that is held on after a stop from elsewhere moves nothing');
  await page.mouse.up();
  await touch();
  await page.evaluate(() => globalThis.dispatchEvent(new Event('blur')));
  await until('the pad of a window without focus', isMoving, false);
  await page.mouse.up();
  await touch();
  await page.evaluate(() => {
    Object.defineProperty(document, 'hidden', { value: true, configurable: true });
    document.dispatchEvent(new Event('visibilitychange'));
    delete document.hidden;
  });
  await until('the pad of a hidden page', isMoving, false);
  await page.mouse.up();
  await pad.focus();
  await page.keyboard.down('ArrowUp');
  await until('a key', isMoving, true);
  await page.keyboard.up('ArrowUp');
  await until('a key that was let go', isMoving, false);
}

/** The second pad and a button, after somebody has said what they move. */
async function choices(page) {
  await page.locator('summary', { hasText: 'What pads' }).click();
  await page.getByLabel('Second pad, across').selectOption('motors/M1');
  await page.getByLabel('Button 1', { exact: true }).selectOption('servos/S6');
  const much = page.getByLabel('value while button 1 is held');
  await much.fill('40');
  await much.press('Enter');
  const second = page.getByRole('button', { name: 'Second pad: across motors/M1, up nothing' });
  await second.focus();
  await page.keyboard.down('ArrowLeft');
  await until('the second pad', () => value('motors/M1'), '-36');
  await page.keyboard.up('ArrowLeft');
  await until('the second pad that was let go', () => value('motors/M1'), '0');
  const button = page.getByRole('button', { name: 'Button 1: servos/S6 to 40 while it is held' });
  await button.focus();
  await page.keyboard.down('Enter');
  await until('a button', () => value('servos/S6'), '40');
  await page.keyboard.up('Enter');
  const gripper = page.getByRole('slider', { name: 'servos/S6, position' });
  await until('a button that was let go', () => gripper.getAttribute('aria-valuetext'), 'off');
  await page.locator('summary', { hasText: 'What pads' }).click();
}

/** Until the browser has drawn so many pictures: a gamepad is looked at once for each. */
async function pictures(page, count) {
  for (let at = 0; at < count; at++) await page.evaluate(() => new Promise(globalThis.requestAnimationFrame));
}

async function gamepad(page) {
  const isMoving = async () => value('motors/M3') !== '0';
  const held = (axes) =>
    page.evaluate((now) => {
      globalThis.navigator.getGamepads = () =>
        now ? [{ connected: true, id: 'test', axes: now, buttons: [] }] : [];
    }, axes);
  const rests = async (what) => {
    // In this time it would move.
    await page.waitForTimeout(300);
    assert.equal(value('motors/M3'), '0', what);
  };
  const [middle, ahead] = [
    [0, 0],
    [0, -1],
  ];
  const moves = async (what) => {
    await held(middle);
    await pictures(page, 3);
    await held(ahead);
    await until(what, isMoving, true);
  };
  await held(ahead);
  await page.getByRole('button', { name: 'Use a gamepad of this computer' }).click();
  await rests('a stick that was held before moves nothing');
  await moves('a stick');
  await held(middle);
  await until('a stick in the middle', isMoving, false);
  await moves('a stick again');
  await page.keyboard.press('Space');
  await until('a stick after a stop', isMoving, false);
  await rests('a stick that is held on after a stop moves nothing');
  await moves('a stick after it was let go');
  await held(undefined);
  await until('a gamepad that is unplugged', isMoving, false);
  await page.getByRole('button', { name: 'Use a gamepad of this computer' }).click();
}

async function graphs(page) {
  await page.getByRole('button', { name: 'sensors/A5, darkness: show it in the graph' }).click();
  await page.getByRole('button', { name: 'encoders/E3, position: show it in the graph' }).click();
  const table = page.getByRole('table');
  await table.getByText('%', { exact: true }).waitFor();
  await until('rows of the table', () => table.getByRole('row').count(), 3);
  const file = page.waitForEvent('download');
  await page.getByRole('button', { name: 'Save CSV' }).click();
  const text = readFileSync(await (await file).path(), 'utf8');
  assert.match(text, /^time_s,sensors\/A5.darkness \(%\),encoders\/E3.position \(deg\)\n0\.000000,/);
  const picture = page.waitForEvent('download');
  await page.getByRole('button', { name: 'Save PNG' }).click();
  assert.match((await picture).suggestedFilename(), /^two-wheels-sensors-A5.*\.png$/);
  await page.getByRole('button', { name: 'Pin the graph' }).click();
  await page.getByRole('button', { name: 'Pin battery to the dashboard' }).click();
  await page.getByRole('button', { name: 'battery: further up' }).click();
  await page.reload();
  const pinned = page.getByRole('region', { name: 'Dashboard' }).getByRole('listitem');
  await until('what is pinned', () => pinned.count(), 2);
  await pinned.first().getByRole('article', { name: 'battery' }).waitFor();
}

async function control(page, other) {
  const slider = other.getByRole('slider', { name: 'motors/M3, duty_cycle' });
  await page.getByRole('button', { name: 'Take control' }).click();
  await until('the slider of a browser that looks', () => slider.isDisabled(), true);
  await page.getByRole('button', { name: 'Pad for motors/M3 and motors/M4' }).focus();
  await page.keyboard.down('ArrowUp');
  await until('a key', () => value('motors/M3'), '36');
  await other
    .getByText(/is in control/)
    .first()
    .waitFor();
  await other.getByRole('button', { name: 'Take control' }).click();
  await until('the slider of the one in control', () => slider.isDisabled(), false);
  await until('what was held by the one before', () => value('motors/M3'), '0');
  await page.keyboard.up('ArrowUp');
  const mine = page.getByRole('slider', { name: 'motors/M3, duty_cycle' });
  await until('the slider of the one before', () => mine.isDisabled(), true);
  await until('what is said of it', () => slider.getAttribute('aria-valuetext'), '0 %');
  await slider.focus();
  await other.keyboard.press('ArrowRight');
  await until('the motor', () => value('motors/M3'), '1');
  await other.context().close();
  await until('the motor of a browser that is gone', () => value('motors/M3'), '0');
}

test('what moves is moved by sliders, numbers, pads, keys and gamepads, and rests', async () => {
  const page = await look();
  await sliders(page);
  await refusals(page);
  await pads(page);
  await choices(page);
  await gamepad(page);
  await page.context().close();
}, 180_000);

test('numbers are drawn and saved, everybody can use them, and one is in control', async () => {
  const page = await look();
  await graphs(page);
  await page.locator('summary', { hasText: 'Drive by hand' }).click();
  await page.locator('summary', { hasText: 'What pads' }).click();
  assert.deepEqual(await barriers(page), [], 'light');
  const other = await look('dark');
  await other.getByRole('button', { name: 'heading, heading: show it in the graph' }).click();
  assert.deepEqual(await barriers(other), [], 'dark');
  await control(page, other);
}, 180_000);

test('a lidar is drawn from above, and says what is nearest', async () => {
  const page = await there.look.open(`${there.robot.url}#instruments`);
  const lidar = page.getByRole('article', { name: 'lidar', exact: true });
  await lidar.scrollIntoViewIfNeeded();
  await lidar
    .getByText(/The nearest thing is \d+ mm away, .*Something is seen in \d+ of 360 directions\./)
    .waitFor();
  const points = () =>
    lidar.locator('canvas').evaluate((canvas) => {
      const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
      let count = 0;
      for (let at = 3; at < data.length; at += 4) if (data[at] > 200) count++;
      return count;
    });
  await eventually('points', async () => (await points()) > 500);
  for (const colorScheme of ['light', 'dark']) {
    await page.emulateMedia({ colorScheme });
    assert.deepEqual(await barriers(page), [], `lidar, ${colorScheme}`);
    if (process.env.SHOTS) await page.screenshot({ path: `${process.env.SHOTS}/lidar-${colorScheme}.png` });
  }
  await page.context().close();
});

test('no page has complained', () => {
  assert.deepEqual(there.look.complaints, []);
});
