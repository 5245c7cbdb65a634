// The pictures of the page in the documents, made of a robot that runs.
//
//   TRIK=target/debug/trik node e2e/shots.js
//
// They are written to docs/user/pictures; look at them before they are committed.
import { mkdirSync, readFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { Look, Robot, eventually } from './robot.js';

const folder = resolve(import.meta.dirname, '../../../docs/user/pictures');
const diagram = resolve(import.meta.dirname, '../../../editors/vscode/test/texts/count.qrs');
const flow = resolve(import.meta.dirname, '../../../examples/dataflow/walls.flow');
const DRIVE = `brick.motor('M3').setPower(45)
brick.motor('M4').setPower(60)
script.wait(60000)
`;

const HEIGHTS = Array.from({ length: 50 }, (_, at) => `\\${(at * 5 + (at % 7) * 6) % 256}\\1`).join('');
/** A noisy sawtooth and a filter whose number can be turned. */
const SAW = `trikfs.saw = {
  src = fake { data = '${HEIGHTS}', period_ms = 20, loop = true }, input_tuple_size = 2, on_event = true,
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

mkdirSync(folder, { recursive: true });

const robot = await Robot.start();
const eyes = await Look.start();
try {
  const page = await eyes.open(robot.url);
  const shot = async (name) => {
    await page.screenshot({
      path: join(folder, `page-${name}.png`),
      clip: { x: 0, y: 0, width: 1200, height: 760 },
    });
  };
  const open = async (view) => {
    await page.goto(`${robot.url}#${view}`);
    await page.locator('main > *').first().waitFor();
  };
  await page.setViewportSize({ width: 1200, height: 760 });
  await open('program');
  const file = { name: 'drive.py', mimeType: 'text/x-python', buffer: Buffer.from(DRIVE) };
  await page.setInputFiles('input[type=file]', [file]);
  await page.setInputFiles('input[type=file]', {
    name: 'count.qrs',
    mimeType: 'application/octet-stream',
    buffer: readFileSync(diagram),
  });
  // The gyroscope is calibrated while the robot stands still.
  await eventually(
    'a heading',
    () => robot.read('heading/fault') === '' && robot.read('heading/value') !== '',
  );
  await page.getByRole('button', { name: 'Run drive.py' }).click();
  await page.getByText('drive.py runs').waitFor();
  await open('world');
  // The picture has the way of six seconds.
  await page.waitForTimeout(6000);
  await shot('world');
  await open('instruments');
  for (const name of ['sensors/D1', 'heading']) {
    const node = page.getByRole('article', { name, exact: true });
    await node.scrollIntoViewIfNeeded();
    await node
      .getByRole('button', { name: /show it in the graph/ })
      .first()
      .click();
  }
  await page.evaluate(() => window.scrollTo(0, 0));
  // The graph has six seconds.
  await page.waitForTimeout(6000);
  await shot('instruments');
  await page.keyboard.press('Space');
  await open('diagram:count.qrs');
  await page.getByRole('button', { name: 'Run, stopped at the first block' }).click();
  await page.locator('g.stopped').waitFor();
  await page.locator('g[data-id*=Timer] rect').first().click();
  await page.keyboard.press('b');
  await page.getByRole('button', { name: 'Continue' }).click();
  await page.locator('g.stopped[data-id*=Timer]').waitFor();
  await shot('diagram');
  await open('program');
  await page.setInputFiles('input[type=file]', flow);
  await open('diagram:walls.flow');
  await page.getByRole('button', { name: 'Run', exact: true }).click();
  await page.locator('g.lit[aria-label^=wheels]').focus();
  await page.keyboard.press('b');
  await page.locator('g.stopped[aria-label^=wheels]').waitFor();
  await shot('flow');
  await open('configuration');
  const text = page.locator('[contenteditable=true]');
  await text.click();
  await page.keyboard.press('Control+End');
  await page.keyboard.type("trikfs.lamp = { src = gpio { chip = 'gpiochip0' line = 5 } }\n");
  await page.keyboard.press('Control+S');
  await page.getByText('Refused').waitFor();
  await shot('configuration');
  await page.getByRole('button', { name: 'Discard changes' }).click();
  robot.write('config', `${robot.read('config')}\n${SAW}`);
  await page.getByText('Look into a converter').click();
  await page.getByLabel('Node:').selectOption('saw');
  await page.locator('.passage tbody tr').first().waitFor();
  await page.getByLabel('Input and output of').selectOption('converter 2 of 2');
  // The graph has six seconds.
  await page.waitForTimeout(6000);
  await page.getByText('Look into a converter').scrollIntoViewIfNeeded();
  await page
    .locator('details')
    .first()
    .screenshot({ path: join(folder, 'page-converter.png') });
  // Over a replay the place is that of the wheels, as on a real robot.
  const run = join(robot.home, 'run.mcap');
  const { begun, recorded } = robot.record(run, 8, false);
  await begun;
  robot.write('motors/M3/value', 45);
  robot.write('motors/M4/value', 60);
  await recorded;
  const player = await Robot.replay(run);
  try {
    await page.goto(`${player.url}#world`);
    await page.locator('.stage canvas').waitFor();
    await page.getByRole('button', { name: 'Play', exact: true }).click();
    // The picture has the way of six seconds.
    await page.waitForTimeout(6000);
    await shot('ground');
  } finally {
    await player.end();
  }
} finally {
  await eyes.end();
  await robot.end();
}
