// The pictures of a class in the documents, made of robots that run, and of programs that are judged.
//
//   TRIK=target/debug/trik node e2e/class-shots.js
//
// They are written to docs/user/pictures; look at them before they are committed.
import { rmSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { ClassPage, Judging, Look, Robot, newHome } from './robot.js';
import { ENDLESS, school } from './school.js';

const folder = resolve(import.meta.dirname, '../../../docs/user/pictures');
const DRIVE = "brick.motor('M3').setPower(40)\nscript.wait(60000)\n";

const home = newHome();
const robots = [await Robot.startIn(home, 'a'), await Robot.startIn(home, 'b')];
const room = await ClassPage.start(home, 'anna ./a red\nboris ./b blue\nclara 127.0.0.77 blue\n');
const eyes = await Look.start();
try {
  const page = await eyes.open(room.url, { viewport: { width: 1000, height: 480 } });
  await page.getByText('2 of 3 reached').waitFor();
  await page.getByRole('button', { name: 'Group red' }).click();
  const file = { name: 'drive.py', mimeType: 'text/x-python', buffer: Buffer.from(DRIVE) };
  await page.setInputFiles('input[type=file]', [file]);
  await page.getByRole('button', { name: 'Send to 1 and run' }).click();
  await page.getByText('2 of 3 reached, 1 running').waitFor();
  await page.screenshot({ path: join(folder, 'class.png') });
} finally {
  await eyes.end();
  await room.end();
  for (const robot of robots) await robot.leave();
  rmSync(home, { recursive: true, force: true });
}

const pupils = { anna: 'good', boris: 'bad', clara: 'good', dmitri: '', vera: 'good', zhenya: ENDLESS };
const classroom = newHome();
const words = school(classroom, pupils);
const judging = await Judging.start(
  classroom,
  ...words,
  '--wall-limit',
  '3000',
  '--time-limit',
  '3000',
  '--pass-mark',
  '1',
);
const others = await Look.start();
try {
  const page = await others.open(judging.url, { viewport: { width: 1000, height: 480 } });
  await page.getByText('9 of 10 judged').waitFor();
  await page.screenshot({ path: join(folder, 'marks.png') });
} finally {
  await others.end();
  await judging.end();
  rmSync(classroom, { recursive: true, force: true });
}
