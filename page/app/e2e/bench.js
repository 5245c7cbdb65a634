// How long a value takes from the tree to the picture, and what a page costs that looks: figures for docs/maintainer/performance.md.
//
//   TRIK=target/release/trik node e2e/bench.js
//
// The page is in a browser of this machine, so nothing of it is the network's.
import { readFileSync } from 'node:fs';
import { eventually, Look, Robot } from './robot.js';

const ROUNDS = 100;
const NODE = 'motors/M3';
const SECONDS = 10;

/** Seconds of the processor that a process has taken, with all its threads. */
function cpu(pid) {
  const fields = readFileSync(`/proc/${pid}/stat`, 'utf8').split(') ')[1].split(' ');
  return (Number(fields[11]) + Number(fields[12])) / 100;
}

/** Percent of a core that each of the robot's processes takes. */
async function costs(robot) {
  const before = robot.pids.map(cpu);
  await new Promise((done) => setTimeout(done, SECONDS * 1000));
  const shares = robot.pids.map((pid, at) => (100 * (cpu(pid) - before[at])) / SECONDS);
  return shares.reduce((sum, one) => sum + one, 0).toFixed(1);
}

const robot = await Robot.start();
const eyes = await Look.start();
try {
  console.info(`nobody looks: ${await costs(robot)} % of a core for all processes of the robot`);
  const page = await eyes.open(`${robot.url}#instruments`);
  const slider = page.getByRole('slider', { name: `${NODE}, duty_cycle` });
  await slider.waitFor();
  await slider.scrollIntoViewIfNeeded();
  // The moment at which what is shown has changed, by the clock that this script has too.
  await slider.evaluate((element) => {
    globalThis.seen = [];
    const look = () => globalThis.seen.push([element.getAttribute('aria-valuetext'), Date.now()]);
    new MutationObserver(look).observe(element, { attributes: true, attributeFilter: ['aria-valuetext'] });
  });
  const times = [];
  for (let at = 1; at <= ROUNDS; at++) {
    const value = (at % 50) + 1;
    const begin = Date.now();
    robot.write(`${NODE}/value`, value);
    const found = await eventually('the value is shown', () =>
      page.evaluate((text) => globalThis.seen.findLast(([shown]) => shown === text)?.[1], `${value} %`),
    );
    times.push(found - begin);
    await page.evaluate(() => (globalThis.seen = []));
    await new Promise((done) => setTimeout(done, 50 + Math.random() * 100));
  }
  times.sort((one, other) => one - other);
  const rank = (share) => times[Math.min(times.length - 1, Math.floor(share * times.length))];
  console.info(
    `a value from the tree to the page, ${ROUNDS} times: median ${rank(0.5)} ms, p95 ${rank(0.95)} ms`,
  );
  console.info(`one page looks at instruments: ${await costs(robot)} % of a core`);
  const paints = [];
  for (let at = 0; at < 10; at++) {
    const fresh = await eyes.open(`${robot.url}#world`);
    const paint = () =>
      fresh.evaluate(() => performance.getEntriesByName('first-contentful-paint')[0]?.startTime);
    paints.push(await eventually('the first paint', paint));
    await fresh.context().close();
  }
  paints.sort((one, other) => one - other);
  console.info(
    `first paint with an empty cache, 10 times: ${Math.round(paints[5])} ms, slowest ${Math.round(paints[9])} ms`,
  );
  const others = [];
  for (let at = 1; at < 10; at++) others.push(await eyes.open(`${robot.url}#log`));
  console.info(`ten pages: ${await costs(robot)} % of a core`);
} finally {
  await eyes.end();
  await robot.end();
}
