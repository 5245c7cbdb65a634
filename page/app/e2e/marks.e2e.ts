// The page of marks, over a class that is judged meanwhile.

import { existsSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { afterAll, afterEach, beforeAll, beforeEach, expect, test } from 'vitest';
import { ru } from '../src/marks/ru';
import { Judging, Look, Robot, barriers, eventually, newHome } from './robot.js';
import { ENDLESS, HOSTILE, school } from './school.js';

const PATIENT = ['--wall-limit', '3000', '--time-limit', '3000'];
const CLASS = { anna: 'good', boris: ENDLESS, [HOSTILE]: 'bad', vera: '' };

/** Two browsers and three processes that judge share a machine. */
const TIME_MS = 240_000;

let home: string;
let look: Look;
let judging: Judging | undefined;

beforeAll(async () => {
  look = await Look.start();
});
beforeEach(() => {
  home = newHome();
});
afterEach(async () => {
  await judging?.end();
  judging = undefined;
  rmSync(home, { recursive: true, force: true });
});
afterAll(() => look?.end());

async function shot(page: Awaited<ReturnType<Look['open']>>, name: string): Promise<void> {
  if (process.env.SHOTS) {
    await page.screenshot({ path: join(process.env.SHOTS, `marks-${name}.png`), fullPage: true });
  }
}

/** All is judged but for one run, whose program computes without end. */
async function begun(): Promise<Judging> {
  judging = await Judging.start(home, ...school(home, CLASS), ...PATIENT, '--pass-mark', '1');
  return judging;
}

/** Folders of replays that nobody has named. */
const replays = () => readdirSync(home).filter((name) => name.startsWith('trik-marks-'));

test(
  'marks come while others are judged, and a click opens the replay of a run',
  async () => {
    const one = await begun();
    const page = await look.open(one.url);
    // The run of boris that has no end stands before some of the others.
    await page.getByText('5 of 6 judged').waitFor();
    const anna = page.getByRole('row', { name: /^anna/ });
    await anna.getByText('accomplished', { exact: true }).first().waitFor();
    await anna.getByText('out of time').waitFor();
    await anna.getByRole('cell', { name: 'yes' }).waitFor();
    const boris = page.getByRole('row', { name: /^boris/ });
    expect(await boris.getByText('not judged yet').count()).toBe(1);
    expect(await boris.getByText('not yet', { exact: true }).count()).toBe(1);
    expect(await page.getByRole('row', { name: /^vera/ }).getByText('missing').count()).toBe(2);
    await shot(page, 'begun');
    expect(await barriers(page)).toEqual([]);

    const opened = page.context().waitForEvent('page');
    await anna.getByRole('link', { name: 'accomplished: replay of anna, road/long' }).press('Enter');
    const replay = await opened;
    await replay.waitForLoadState();
    // Its script runs, and reaches nothing of this server.
    await replay.getByText('The task was accomplished', { exact: false }).first().waitFor();
    const reached = await replay.evaluate(() =>
      fetch('/marks').then(
        () => 'reached',
        () => 'refused',
      ),
    );
    expect(reached).toBe('refused');
    expect(await replay.evaluate(() => window.origin)).toBe('null');
    await shot(replay, 'replay');
    await replay.close();

    // The other process has done its work, so the one that is left is his.
    await eventually('one process is left', () => one.workers.length === 1);
    for (const worker of one.workers) {
      process.kill(worker, 'SIGKILL');
    }
    await page.getByText('6 of 6 judged').waitFor();
    await boris.getByText('was killed by signal 9').first().waitFor();
    await page.getByText('All is judged.').waitFor();
    expect(await page.locator('img').count()).toBe(0);
    const hostile = page.getByRole('row', { name: HOSTILE });
    await hostile.getByText('not accomplished').first().waitFor();
    await hostile.getByRole('cell', { name: 'no', exact: true }).waitFor();
    await shot(page, 'judged');
    expect(await barriers(page)).toEqual([]);
    expect(replays()).toHaveLength(1);

    // The page stays until the person ends it, and then says so; replays go with the command.
    expect(await one.end()).toBe(2);
    await page.getByText('The command that judges has ended').waitFor();
    await anna.getByText('accomplished', { exact: true }).first().waitFor();
    expect(replays()).toEqual([]);
    await page.context().close();
  },
  TIME_MS,
);

test(
  'on a telephone, in the dark and in Russian nothing is missing and nothing bars the way',
  async () => {
    const words = school(home, { anna: 'good', [HOSTILE]: 'bad' });
    judging = await Judging.start(home, ...words, '--grades', 'g.html');
    const page = await look.open(judging.url, {
      locale: 'ru-RU',
      colorScheme: 'dark',
      viewport: { width: 390, height: 800 },
    });
    await page.getByText(ru.over).waitFor();
    await page.getByText(ru.judged({ done: 4, all: 4, over: true })).waitFor();
    await page
      .getByRole('link', { name: /road\/long/ })
      .first()
      .waitFor();
    await shot(page, 'phone');
    expect(await barriers(page)).toEqual([]);
    const wide = await page.evaluate(() => document.documentElement.scrollWidth > innerWidth);
    expect(wide).toBe(false);
    // The table is moved by the keys.
    const region = page.getByRole('region', { name: ru.scroll });
    await region.focus();
    await page.keyboard.press('ArrowRight');
    await eventually('it is moved', () => region.evaluate((element) => element.scrollLeft > 0));
    await page.context().close();
    // Replays in a folder that has a name stay.
    expect(await judging.end('SIGTERM')).toBe(1);
    expect(existsSync(join(home, 'g.html'))).toBe(true);
    expect(existsSync(join(home, 'g-replays/anna'))).toBe(true);
    expect(replays()).toEqual([]);
  },
  TIME_MS,
);

test(
  'with a class the robots stand above the marks, and a stop reaches them while others are judged',
  async () => {
    const robot = await Robot.startIn(home, 'a');
    try {
      writeFileSync(join(home, 'room.txt'), 'anna ./a red\n');
      const words = school(home, { anna: 'good', boris: ENDLESS });
      judging = await Judging.start(home, ...words, ...PATIENT, '--class', join(home, 'room.txt'));
      const page = await look.open(judging.url);
      await page.getByText('1 of 1 reached, 0 running').waitFor();
      const anna = page.getByRole('row', { name: /^anna/ });
      await anna.getByRole('link', { name: 'accomplished: replay of anna, road/long' }).waitFor();
      robot.write('motors/M3/value', '40');
      await shot(page, 'class');
      expect(await barriers(page)).toEqual([]);
      await page.keyboard.press('Space');
      await page.getByText('1 at rest, the last after').waitFor();
      expect(robot.read('motors/M3/value')).toBe('0');

      // Marks alone, for a screen that the class sees.
      const alone = await look.open(judging.url.replace('/class', '/marks'));
      await alone.getByRole('row', { name: /^anna/ }).getByText('out of time').waitFor();
      expect(await alone.getByRole('button').count()).toBe(0);
      await alone.context().close();
      await page.context().close();
      expect(await judging.end()).toBe('SIGINT');
    } finally {
      await robot.leave();
    }
  },
  TIME_MS,
);

test(
  'Ctrl-C while runs are judged ends all of them',
  async () => {
    const one = await begun();
    const page = await look.open(one.url);
    await page.getByText('5 of 6 judged').waitFor();
    const { workers } = one;
    expect(workers.length).toBeGreaterThan(0);
    expect(await one.end()).toBe('SIGINT');
    await page.getByText('is not connected to the command').waitFor();
    for (const worker of workers) {
      await eventually('it is gone', () => !existsSync(`/proc/${worker}`));
    }
    expect(replays()).toEqual([]);
    await page.context().close();
  },
  TIME_MS,
);

test('no page has complained', () => {
  expect(look.complaints).toEqual([]);
});
