// A look into the converters of a node: its bytes, its value, and what a number of a filter does to a signal.

import { expect, test } from 'vitest';
import { barriers, eventually } from './robot.js';
import { scene } from './scene.js';

const there = scene();

/** A sawtooth of two bytes that is made an i32 and smoothed by a filter whose number can be turned. */
const NODE = `
trikfs.saw = {
  src = fake { data = DATA, period_ms = 20, loop = true }, input_tuple_size = 2, on_event = true,
  format = 'i32 height', units = 'mm', params = { alpha = { 0.25, min = 0.01, max = 1 } },
  converter = {
    { converter = function(a_s, a, b_s, b) ba.i32(b, 0, ba.u16(a, 0)) end, output_tuple_size = 4 },
    (function()
      local last
      return function(a_s, a, b_s, b)
        local now = ba.i32(a, 0)
        last = (last or now) + params.alpha * (now - (last or now))
        ba.i32(b, 0, last)
      end
    end)(),
  },
}
`;
const data = Array.from({ length: 50 }, (_, at) => `\\${(at * 5) % 256}\\1`).join('');

test('bytes and values of a node are seen, and a number of its filter is turned and comes back', async () => {
  const before = there.robot.read('config');
  there.robot.write('config', `${before}\n${NODE.replace('DATA', `'${data}'`)}`);
  const page = await there.look.open(`${there.robot.url}#configuration`);
  await page.getByText('Look into a converter').click();
  await page.getByLabel('Node:').selectOption('saw');
  const rows = page.locator('.passage table').first().locator('tbody tr');
  await expect.poll(() => rows.count()).toBe(3);
  await expect.poll(() => rows.nth(0).textContent()).toMatch(/raw\s*[0-9a-f]{2} 01/);
  await expect.poll(() => rows.nth(2).textContent()).toMatch(/value.*\d+ mm.*i32 height/);
  await page.getByLabel('Read as, raw').selectOption('>u16');
  // The low byte goes up by five, and is the high one now.
  const raw = async () => Number(await rows.nth(0).locator('.numbers').textContent());
  await expect.poll(async () => (await raw()) % 256).toBe(1);
  await page.getByLabel('Input and output of').selectOption('converter 2 of 2');
  const spread = async () => {
    const cells = await page.locator('.passage table').last().locator('td.number').allTextContents();
    const numbers = cells.map(Number);
    const [, inMin = 0, , inMax = 0, , outMin = 0, , outMax = 0] = numbers;
    return { input: inMax - inMin, output: outMax - outMin };
  };
  await eventually('both lines are there', async () => (await spread()).input > 200);
  expect(await barriers(page)).toEqual([]);
  // With so little of each new value the output hardly moves.
  await page.getByLabel('New value of alpha').fill('0.02');
  await page.keyboard.press('Enter');
  await expect.poll(() => there.robot.read('saw/params/alpha')).toBe('0.02');
  await eventually('the filter calms', async () => {
    const { input, output } = await spread();
    return input > 200 && output < input / 2;
  });
  await page.getByRole('slider', { name: 'Number alpha' }).focus();
  await page.keyboard.press('End');
  await expect.poll(() => there.robot.read('saw/params/alpha')).toBe('1');
  await page.getByLabel('New value of alpha').fill('7');
  await page.keyboard.press('Enter');
  await page.getByText('params/alpha is a number from 0.01 to 1').waitFor();
  expect(there.robot.read('saw/params/alpha')).toBe('1');
  const undo = page.getByRole('button', { name: 'Take the last turn back' });
  await undo.click();
  await expect.poll(() => there.robot.read('saw/params/alpha')).toBe('0.02');
  await undo.click();
  await expect.poll(() => there.robot.read('saw/params/alpha')).toBe('0.25');
  expect(await undo.isDisabled()).toBe(true);
  // What was chosen stays, however often the node is told anew.
  expect(await page.getByLabel('Read as, raw').inputValue()).toBe('>u16');
  // A viewer sees it too, and turns nothing.
  const other = await there.look.open(`${there.robot.url}#configuration`, { locale: 'ru-RU' });
  await other
    .getByText(
      '\u0417\u0430\u0433\u043b\u044f\u043d\u0443\u0442\u044c \u0432 \u043a\u043e\u043d\u0432\u0435\u0440\u0442\u0435\u0440',
    )
    .click();
  await other.getByLabel('\u0423\u0437\u0435\u043b:').selectOption('saw');
  await other
    .getByText('\u0437\u043d\u0430\u0447\u0435\u043d\u0438\u0435', { exact: true })
    .first()
    .waitFor();
  expect(await other.getByRole('slider', { name: '\u0427\u0438\u0441\u043b\u043e alpha' }).isDisabled()).toBe(
    true,
  );
  await other.context().close();
  there.robot.write('config', `${before}\n`);
  await page.context().close();
});

test('no page has complained', () => {
  expect(there.look.complaints).toEqual([]);
});
