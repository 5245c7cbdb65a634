// A robot that runs programs for paired computers only, and a computer that is paired by its code.

import { type ChildProcess, execFileSync, spawn } from 'node:child_process';
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { afterEach, expect, test } from 'vitest';
import { barriers, eventually } from '../e2e/robot.js';
import { begin, button } from './begin';

const TRIKD = resolve(
  process.env['TRIK'] ?? join(import.meta.dirname, '../../../target/debug/trik'),
  '../trikd',
);

/** `trikd` over a small tree, which wants pairing. */
class Guarded {
  readonly home = mkdtempSync(join(tmpdir(), 'trik-pair-'));
  readonly #child: ChildProcess;
  #said = '';

  private constructor() {
    const file = (name: string, text: string) => {
      mkdirSync(join(this.home, name, '..'), { recursive: true });
      writeFileSync(join(this.home, name), text);
    };
    file('tree/motors/M1/value', '0\n');
    file('tree/keys/value', '0 0 0 0 0 0 0\n');
    file('tree/stop', '');
    const folders = ['scripts', 'state', 'run'].flatMap((name) => [`--${name}`, join(this.home, name)]);
    const ports = ['control', 'telemetry', 'mailbox', 'gamepad', 'video', 'variables', 'page'];
    const args = ['serve', '--tree', join(this.home, 'tree'), ...folders, '--pair', '--without', 'discovery'];
    this.#child = spawn(
      TRIKD,
      [
        ...args,
        ...['--address', '127.0.0.1', '--gamepad-fifo', join(this.home, 'fifo')],
        ...ports.flatMap((name) => [`--${name}-port`, '0']),
      ],
      { stdio: ['ignore', 'pipe', 'pipe'] },
    );
    for (const stream of [this.#child.stdout, this.#child.stderr])
      stream?.on('data', (text: Buffer) => (this.#said += text.toString()));
  }

  static async start(): Promise<Guarded> {
    const robot = new Guarded();
    await eventually('trikd is ready', () => robot.port !== '' || robot.#child.exitCode !== null);
    if (robot.port === '') throw new Error(robot.#said);
    return robot;
  }

  get port(): string {
    return /\bpage[= ](\d+)/.exec(this.#said)?.[1] ?? '';
  }

  /** A new pairing code, as a person at the robot gets it. */
  code(): string {
    const words = ['pair', '--code', '--run', join(this.home, 'run')];
    return execFileSync(TRIKD, words, { encoding: 'utf8' }).trim();
  }

  get paired(): string {
    try {
      return readFileSync(join(this.home, 'state/paired'), 'utf8');
    } catch {
      return '';
    }
  }

  async end(): Promise<void> {
    const ended = new Promise((done) => this.#child.once('exit', done));
    this.#child.kill('SIGTERM');
    await ended;
    rmSync(this.home, { recursive: true, force: true });
  }
}

let robot: Guarded;

const here = begin();
afterEach(() => robot.end());

test('the code of the robot pairs this computer, and a wrong one says so', async () => {
  robot = await Guarded.start();
  const page = await here.look.open(`http://127.0.0.1:${robot.port}/`);
  await page.getByText('This computer may only look').waitFor();
  const field = page.getByLabel('Pairing code');
  await field.fill('12 34 5');
  await button(page, 'Pair').click();
  await page.getByText('this is no pairing code of the robot').waitFor();
  expect(await barriers(page)).toEqual([]);
  expect(robot.paired).toBe('');

  const code = robot.code();
  expect(code).toMatch(/^\d{6}$/);
  await field.fill(`${code.slice(0, 3)} ${code.slice(3)}`);
  await field.press('Enter');
  await page.getByRole('button', { name: 'Take control' }).waitFor();
  expect(await field.count()).toBe(0);
  expect(robot.paired).toBe('127.0.0.1\n');
  await page.context().close();
});

test('a studio from elsewhere takes the code along with the project', async () => {
  robot = await Guarded.start();
  const page = await here.open();
  await page.locator('.svelte-flow__node').first().waitFor();
  await button(page, 'Add Timer').click();
  await page.getByText('To a robot').click();
  await page.getByLabel('Address of the robot').fill(`127.0.0.1:${robot.port}`);
  await page.getByLabel('Pairing code, if it wants one').fill(robot.code());
  const [there] = await Promise.all([
    page.context().waitForEvent('page'),
    page.getByRole('button', { name: 'Open there' }).click(),
  ]);
  await there.getByRole('heading', { name: /^Robot / }).waitFor();
  await there.getByText('No program runs.').waitFor();
  await eventually('it is paired', () => robot.paired === '127.0.0.1\n');
  await eventually('it may do things', async () => !(await there.getByText('may only look').isVisible()));
  expect(there.url()).not.toContain('code=');
  expect(await there.locator('.svelte-flow__node').count()).toBe(3);
  await page.context().close();
});
