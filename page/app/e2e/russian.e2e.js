// The page of a person whose browser speaks Russian: what the robot says is in Russian too.

import assert from 'node:assert/strict';
import { join } from 'node:path';
import { test } from 'vitest';
import { ru } from '../src/words/ru';
import { barriers, eventually } from './robot.js';
import { scene } from './scene.js';

const there = scene();

/** A sentence of the robot in Russian, as a pattern; `{name}` of it is any text. */
function heard(english) {
  const found = ru.heard.find(([one]) => one === english);
  assert.ok(found, english);
  const parts = found[1].split(/\{\w+\}/).map((part) => part.replace(/[.*+?^${}()|[\]\\]/g, '\\$&'));
  return new RegExp(parts.join('.+?'));
}

const russian = (hash, options = {}) =>
  there.look.open(`${there.robot.url}${hash}`, { locale: 'ru-RU', ...options });

async function usable(page, name) {
  assert.deepEqual(await barriers(page), [], name);
  if (process.env.SHOTS) await page.screenshot({ path: join(process.env.SHOTS, `${name}.png`) });
}

test('starts, failures and stops of programs are said in Russian', async () => {
  const page = await russian('#program');
  const send = async (name, text) => {
    const file = { name, mimeType: 'text/x-python', buffer: Buffer.from(text) };
    await page.setInputFiles('input[type=file]', file);
    await page.getByRole('button', { name: ru.runName(name) }).click();
  };
  await send('bad.py', "print('first')\nraise ValueError('x')\n");
  await page.getByText(heard('{name} has started')).first().waitFor();
  await page.getByText(/bad\.py: .*\u043e\u0448\u0438\u0431\u043a/).waitFor();
  // What the program itself says stays.
  await page.getByText('first', { exact: true }).waitFor();
  await send('long.py', 'script.wait(60000)\n');
  await page.getByText(ru.runs('long.py')).waitFor();
  await page.keyboard.press('Space');
  await page.getByText(heard('{name} was stopped by a client after {seconds} s')).waitFor();
  assert.equal(await page.getByText(/has (started|failed|ended)|was stopped/).count(), 0);
  await usable(page, 'russian-program');
  await page.context().close();
});

test('a refusal of the server and a fault of a sensor are said in Russian', async () => {
  const page = await russian('#instruments');
  const other = await russian('#world');
  await other.getByRole('button', { name: ru.takeControl }).click();
  await other.getByRole('button', { name: ru.leaveControl }).waitFor();
  // A page that does not know better yet, such as an older one, asks all the same.
  const refused = await page.evaluate(
    () =>
      new Promise((done) => {
        const socket = new WebSocket(`ws://${location.host}/socket?language=ru`);
        socket.onopen = () => socket.send('{"do":"world","order":"pause"}');
        socket.onmessage = ({ data }) => {
          const news = typeof data === 'string' ? JSON.parse(data) : {};
          if (news.is === 'refused') done(news.why);
        };
      }),
  );
  assert.match(String(refused), /[\u0430-\u044f]{4}/);
  await other.locator('summary').click();
  await other.getByRole('combobox', { name: ru.faultDevice }).selectOption('D1');
  await other.getByRole('button', { name: ru.faultAdd }).click();
  const fault = page.getByRole('article', { name: 'sensors/D1', exact: true }).locator('.fault');
  await fault.waitFor();
  await eventually('the fault in Russian', async () =>
    /[\u0430-\u044f]{4}.*: /.test((await fault.textContent()) ?? ''),
  );
  await fault.scrollIntoViewIfNeeded();
  await usable(page, 'russian-fault');
  await page.context().close();
  await other.context().close();
});

test('no page has complained', () => {
  assert.deepEqual(there.look.complaints, []);
});
