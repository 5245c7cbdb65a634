// A diagram that asks a person: the page shows the question, sends the answer, and gives up when the diagram does.

import assert from 'node:assert/strict';
import { join } from 'node:path';
import { test } from 'vitest';
import { barriers, eventually } from './robot.js';
import { scene } from './scene.js';
import { sketch } from './sketch.js';

// What a diagram waits for is told to trikd by `trik up`: long enough to look at the question on a busy machine.
process.env.TRIKD_ANSWER_S = '40';
const there = scene();

/** Asks for a number, 7 unless it is told another one, and says ten times that. */
const ASK = sketch([
  ['InitialNode', {}],
  ['Input', { variable: 'n', prompt: 'How many?', default: '7' }],
  ['Function', { Body: 'print(n * 10)' }],
  ['FinalNode', {}],
]);

async function runs(page) {
  const row = page.getByRole('button', { name: 'Run ask.qrs' });
  if ((await row.count()) === 0) {
    const file = { name: 'ask.qrs', mimeType: 'application/octet-stream', buffer: ASK };
    await page.setInputFiles('input[type=file]', file);
  }
  await row.click();
  const question = page.getByRole('dialog', { name: 'How many?' });
  await question.waitFor();
  return question;
}

const ended = (page) => page.getByText(/ask\.qrs has ended/).last();

test('a person answers a diagram by the keyboard, and it goes on with the answer', async () => {
  const page = await there.look.open(`${there.robot.url}#program`);
  const question = await runs(page);
  const field = question.getByRole('textbox', { name: 'n' });
  assert.equal(await field.inputValue(), '7');
  // The focus is there, and a space in a text is no stop.
  await page.keyboard.press('End');
  await page.keyboard.type(' + 5');
  assert.equal(await field.inputValue(), '7 + 5');
  await question.getByText(/In \d+ s the program goes on/).waitFor();
  for (const colorScheme of /** @type {const} */ (['light', 'dark'])) {
    await page.emulateMedia({ colorScheme });
    assert.deepEqual(await barriers(page), [], colorScheme);
    if (process.env.SHOTS)
      await page.screenshot({ path: join(process.env.SHOTS, `question-${colorScheme}.png`) });
  }
  await page.keyboard.press('Enter');
  await page.getByText('120', { exact: true }).waitFor();
  await ended(page).waitFor();
  assert.equal(await question.count(), 0);
  await page.context().close();
});

test('no answer is an answer, and the default counts', async () => {
  const page = await there.look.open(`${there.robot.url}#program`);
  const question = await runs(page);
  await question.getByRole('button', { name: 'No answer' }).click();
  await page.getByText('70', { exact: true }).waitFor();
  await ended(page).waitFor();
  await page.context().close();
});

test('when nobody answers, the diagram goes on with its default and the question is gone', async () => {
  const page = await there.look.open(`${there.robot.url}#program`);
  const begin = Date.now();
  const question = await runs(page);
  await page.getByText('70', { exact: true }).waitFor();
  assert.ok(Date.now() - begin > 39_000, 'it has waited');
  await eventually('the question is gone', async () => (await question.count()) === 0);
  await page.context().close();
});

test('a stop ends the question too', async () => {
  const page = await there.look.open(`${there.robot.url}#program`);
  const question = await runs(page);
  await page.getByRole('button', { name: 'Stop', exact: true }).click();
  await page.getByText(/ask\.qrs was stopped by a client/).waitFor();
  await eventually('the question is gone', async () => (await question.count()) === 0);
  await page.context().close();
});

test('no page has complained', () => {
  assert.deepEqual(there.look.complaints, []);
});
