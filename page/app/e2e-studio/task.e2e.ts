// A page with a task, as `trik site --task` makes it.

import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { afterAll, beforeAll, expect, test } from 'vitest';
import { Look } from '../e2e/robot.js';
import { button } from './begin';
import { SITE, Site, library } from './site';

const ROOT = resolve(import.meta.dirname, '../../..');
const TRIK = process.env['TRIK'] ?? join(ROOT, 'target/debug/trik');

let look: Look;
let home: string;
let site: Site;

beforeAll(async () => {
  look = await Look.start();
  home = mkdtempSync(join(tmpdir(), 'trik-task-'));
  const { edit } = await library();
  const line = edit('line.qrs', new Uint8Array(readFileSync(join(ROOT, 'examples/diagrams/line.qrs'))));
  if (!line.ok) throw new Error('no example');
  const text = readFileSync(join(ROOT, 'examples/dataflow/line.xml'), 'utf8');
  expect(line.value.apply({ do: 'world', text })).toMatchObject({ ok: true });
  const saved = line.value.save();
  if (!saved.ok) throw new Error('no save');
  writeFileSync(join(home, 'follow.qrs'), saved.value);
  execFileSync(TRIK, ['site', join(home, 'out'), '--studio', SITE, '--task', join(home, 'follow.qrs')]);
  site = await Site.start(join(home, 'out'));
});
afterAll(async () => {
  await look?.end();
  await site?.end();
  rmSync(home, { recursive: true, force: true });
});

test('the task is open, its world stays, and a program of a pupil is judged in it', async () => {
  const page = await look.open(site.url);
  await page.getByRole('heading', { name: 'follow.qrs' }).waitFor();
  expect(await page.getByRole('button', { name: 'Load a world' }).count()).toBe(0);
  expect(await page.getByRole('button', { name: 'Take back' }).isDisabled()).toBe(true);
  await page.getByLabel('Speed').selectOption('fastest');
  await button(page, 'Run').click();
  await page.getByText('The task is done.').waitFor();
  // Many runs, on all cores.
  await page.getByText('Many runs').click();
  await page.getByLabel('Runs, with the seeds from 1 on').fill('6');
  await page.getByRole('button', { name: 'Run all' }).click();
  await page.getByText('The task is done in 6.').waitFor();
  expect(await page.getByRole('row').count()).toBe(7);
  // What comes from elsewhere is in the world of the task, too, and a new program.
  await page.getByLabel('Open').setInputFiles(join(ROOT, 'examples/diagrams/line.qrs'));
  await page.getByRole('heading', { name: 'line.qrs' }).waitFor();
  await page.getByText('The task is done in 6.').waitFor({ state: 'detached' });
  await button(page, 'Run').click();
  await page.getByText('The task is done.').waitFor();
  await button(page, 'New').click();
  await page.getByRole('heading', { name: 'follow.qrs' }).waitFor();
  // The task from its beginning; without its first link it does nothing.
  await page.getByRole('group', { name: /^Link from Initial Node/ }).focus();
  await page.keyboard.press('Enter');
  await page.keyboard.press('Delete');
  await button(page, 'Run').click();
  await page.locator('.verdict').getByText('The program has ended by a mistake.').waitFor();
  expect(look.complaints).toEqual([]);
  await page.context().close();
});

test('a program with text is judged in the world of the task', async () => {
  const { open } = await library();
  const line = open('line.qrs', new Uint8Array(readFileSync(join(ROOT, 'examples/diagrams/line.qrs'))));
  if (!line.ok) throw new Error('no example');
  const hasPython = existsSync(join(home, 'out/python/pyodide.mjs'));
  expect(hasPython).toBe(existsSync(join(SITE, 'python/pyodide.mjs')));
  const page = await look.open(site.url);
  await page.getByRole('heading', { name: 'follow.qrs' }).waitFor();
  for (const [language, name] of [
    ['javascript', 'line.js'],
    ...(hasPython ? ([['python', 'line.py']] as const) : []),
  ] as const) {
    const written = line.value.generate(language);
    if (!written.ok) throw new Error(`nothing is written in ${language}`);
    const buffer = Buffer.from(written.value.text);
    await page.getByLabel('Open', { exact: true }).setInputFiles({ name, mimeType: 'text/plain', buffer });
    await page.getByRole('heading', { name }).waitFor();
    await page.getByText('World: that of the task').waitFor();
    expect(await page.getByRole('button', { name: 'Load a world' }).count()).toBe(0);
    await page.getByLabel('Speed').selectOption('fastest');
    await button(page, 'Run').click();
    await page.getByText('The task is done.').waitFor();
  }
  line.value.free();
  await page.context().close();
});
