// The picture of a class in the documents, made of robots that run.
//
//   TRIK=target/debug/trik node e2e/class-shots.js
//
// It is written to docs/user/pictures; look at it before it is committed.
import { rmSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { ClassPage, Look, Robot, newHome } from './robot.js';

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
