// Programs of data flow: their picture while they run, their tokens, breakpoints and steps.

import { expect, test } from 'vitest';
import { barriers } from './robot.js';
import { scene } from './scene.js';

const WALLS = '../../examples/dataflow/walls.flow';
/** A window of three readings that nobody ever pairs, a variable that counts, and a text that is longer than a picture has room. */
const BACKLOG = `diagram "Backlog"
  tick: Sensor(VarName = sensorA1)
  count: "Text programming"(IO0 = \`n = n + 1\`)
  n: Variable(variable = "n = 0; k = 7")
  never: "Message receiver"
  pairs: "Zip flows"
  long: Say(text = "${'long '.repeat(400)}")
  tick.OUT -> count.I0
  tick.OUT -> pairs.DATA1 fifo 3
  never.OUT -> pairs.DATA2
`;

/** They are long, and axe looks at many blocks. */
const PATIENCE_MS = 180_000;

const there = scene();

/** A page that shows a program of the robot. */
async function shows(name: string, content: string | undefined, options = {}) {
  const page = await there.look.open(`${there.robot.url}#program`, options);
  const file = { name, mimeType: 'text/plain', buffer: Buffer.from(content ?? '') };
  await page.setInputFiles('input[type=file]', content === undefined ? WALLS : file);
  await page.getByRole('link', { name: `Show the diagram ${name}` }).click();
  await page.locator('.box svg').first().waitFor();
  return page;
}

test(
  'a program of data flow shows its tokens and blocks, stops by a key, and goes on step by step',
  async () => {
    const page = await shows('walls.flow', undefined);
    await page.getByRole('button', { name: 'Run', exact: true }).click();
    await page.locator('g.lit[aria-label^=wheels]').waitFor();
    await page.locator('g.lit[aria-label^=front]').waitFor();
    await page.locator('.box text.last').first().waitFor();
    const front = page.getByRole('row', { name: /^front/ });
    expect(await front.getByRole('cell').first().textContent()).toMatch(/^\d+$/);
    expect(await page.getByRole('heading', { name: 'Threads' }).count()).toBe(0);
    // By keyboard alone: to the block, a breakpoint, a step, on, and away with it.
    await page.locator('g[data-id][aria-label^=wheels]').focus();
    await page.keyboard.press('b');
    await page.locator('g.break.stopped[aria-label^=wheels]').waitFor();
    await page.getByText(/at a breakpoint\. .+ is about to reach wheels, port M[34]/).waitFor();
    expect(await barriers(page)).toEqual([]);
    await page.keyboard.press('Enter');
    await page.getByRole('heading', { name: 'Ports of wheels' }).waitFor();
    await page.keyboard.press('b');
    await page.locator('g.break').waitFor({ state: 'detached' });
    await page.getByRole('button', { name: 'Next reaction' }).press('Enter');
    await page.getByText(/after a step/).waitFor();
    await page.getByRole('button', { name: 'Next instant' }).press('Enter');
    await page.locator('g.stopped:not([aria-label^=wheels])').first().waitFor();
    await page.getByRole('button', { name: 'Continue' }).press('Enter');
    await page.getByText(/^Runs/).waitFor();
    await page.getByRole('button', { name: 'Pause' }).press('Enter');
    await page.getByText(/Stopped, motors at rest.*paused/).waitFor();
    await page.getByRole('button', { name: 'Step back' }).press('Enter');
    await page.getByText(/^In the past/).waitFor();
    await page.getByText('The past has no tokens at ports.').waitFor();
    await page.getByRole('button', { name: 'To the present' }).press('Enter');
    await page.getByText(/^Stopped, motors at rest/).waitFor();
    await page.getByRole('button', { name: 'Without debugger' }).press('Enter');
    await page.getByText(/^Runs/).waitFor();
    // Another sheet has its own blocks.
    await page.getByRole('button', { name: 'Turn away' }).click();
    await page.locator('g.lit[aria-label^=ahead]').waitFor();
    await page.getByRole('button', { name: 'Stop', exact: true }).click();
    await page.locator('g.lit').first().waitFor({ state: 'detached' });
    await page.context().close();
  },
  PATIENCE_MS,
);

test(
  'what waits and what was lost is told, variables change, and a breakpoint is there before the run',
  async () => {
    const page = await shows('backlog.flow', BACKLOG, { viewport: { width: 390, height: 800 } });
    await page.locator('g[data-id][aria-label^=count] rect').click();
    await page.getByRole('button', { name: 'Breakpoint', exact: true }).click();
    await page.locator('g.break[aria-label^=count]').waitFor();
    await page.getByRole('button', { name: 'Run', exact: true }).click();
    await page.locator('g.stopped[aria-label^=count]').waitFor();
    await page.getByRole('button', { name: 'Breakpoint', exact: true }).click();
    await page.getByRole('button', { name: 'Continue' }).click();
    await page.locator('.box text.lost', { hasText: /^3 wait, \d+ lost$/ }).waitFor();
    await page.getByRole('button', { name: 'k is 7; change it' }).click();
    await page.getByLabel('New value of k').fill('8');
    await page.keyboard.press('Enter');
    await page.getByRole('button', { name: 'k is 8; change it' }).waitFor();
    // Nothing stands beside the window, however long a text is.
    await page.locator('g[data-id][aria-label^=long]').focus();
    await page.keyboard.press('Enter');
    await page.getByRole('heading', { name: 'Ports of long' }).waitFor();
    expect(await page.evaluate(() => document.documentElement.scrollWidth - innerWidth)).toBeLessThanOrEqual(
      0,
    );
    expect(await barriers(page)).toEqual([]);
    await page.getByRole('button', { name: 'Stop', exact: true }).click();
    await page.context().close();
  },
  PATIENCE_MS,
);

test(
  'a program of thousands of blocks is drawn or refused in words, and nothing stands still',
  async () => {
    const of = (count: number) => {
      const chain = Array.from({ length: count }, (_, at) => `  b${at}: "Value generator"\n`);
      return `diagram "Many"\n  s: Sensor(VarName = sensorA1)\n${chain.join('')}`;
    };
    const page = await there.look.open(`${there.robot.url}#program`);
    for (const [name, count] of [
      ['many.flow', 1500],
      ['more.flow', 6000],
    ] as const)
      await page.setInputFiles('input[type=file]', {
        name,
        mimeType: 'text/plain',
        buffer: Buffer.from(of(count)),
      });
    // What cannot run says so beside its picture.
    await page.setInputFiles('input[type=file]', {
      name: 'wrong.flow',
      mimeType: 'text/plain',
      buffer: Buffer.from('diagram "Wrong"\n  f: "Text programming"(IO0 = `zzz + 1`)\n'),
    });
    await page.getByRole('link', { name: 'Show the diagram wrong.flow' }).click();
    await page.getByRole('button', { name: 'Run', exact: true }).click();
    await page.getByRole('alert').getByText('zzz is never given a value').waitFor();
    await page.goto(`${there.robot.url}#program`);
    await page.getByRole('link', { name: 'Show the diagram more.flow' }).click();
    await page.getByRole('alert').getByText('at most 5000 are drawn').waitFor();
    await page.goto(`${there.robot.url}#diagram:many.flow`);
    await page.locator('.box g[data-id]').first().waitFor();
    await page.getByRole('button', { name: 'Run', exact: true }).click();
    await page.getByText(/^(Runs|Ended)/).waitFor();
    // It goes on to draw, and answers a click.
    await page.evaluate(() => new Promise((drawn) => requestAnimationFrame(drawn)));
    await page.getByRole('button', { name: 'Stop', exact: true }).click();
    await page.context().close();
  },
  PATIENCE_MS,
);

for (const colorScheme of ['light', 'dark'] as const) {
  test(`everybody can use it, ${colorScheme}`, async () => {
    const page = await shows('walls.flow', undefined, { colorScheme });
    await page.locator('g[data-id][aria-label^=high]').focus();
    await page.keyboard.press('Enter');
    await page.getByRole('heading', { name: 'high', exact: true }).waitFor();
    expect(await barriers(page)).toEqual([]);
    await page.context().close();
  });
}

test('no page has complained', () => {
  // Of a program that was refused the browser says so too.
  expect(there.look.complaints.filter((one) => !/status of 422/.test(one))).toEqual([]);
});
