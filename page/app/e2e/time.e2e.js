// A recording in a browser: its clock, and a value at a moment that is gone to.

import assert from 'node:assert/strict';
import { join } from 'node:path';
import { test } from 'vitest';
import { Look, Robot, eventually, until } from './robot.js';

test('a slider goes through a recording, and the instruments show its values', async () => {
  const robot = await Robot.start();
  const file = join(robot.home, 'run.mcap');
  const { begun, recorded } = robot.record(file, 4);
  await begun;
  robot.write('motors/M3/value', 33);
  await recorded;
  const player = await Robot.replay(file);
  const eyes = await Look.start();
  try {
    const page = await eyes.open(`${player.url}#instruments`);
    const slider = page.getByRole('slider', { name: 'Time of the recording' });
    await slider.waitFor();
    const motor = () => player.read('motors/M3/value');
    await until('the motor at the beginning', motor, '0');
    await slider.focus();
    await page.keyboard.press('End');
    await eventually('the end', async () =>
      /^0:(0[3-9]|[1-5]\d)/.test((await slider.getAttribute('aria-valuetext')) ?? ''),
    );
    await until('the motor at the end', motor, '33');
    await page.keyboard.press('Home');
    await until('the motor at the beginning again', motor, '0');
    const before = await slider.getAttribute('aria-valuetext');
    await page.getByRole('button', { name: 'Play', exact: true }).click();
    await eventually('it plays', async () => (await slider.getAttribute('aria-valuetext')) !== before);
    await page.getByRole('button', { name: 'Pause the recording' }).click();
    await page.getByRole('button', { name: 'Play', exact: true }).waitFor();
    assert.deepEqual(eyes.complaints, []);
  } finally {
    await eyes.end();
    await player.end();
    await robot.end();
  }
});
