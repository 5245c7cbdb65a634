// The figures of the page that have a limit, each with its share of it: for docs/maintainer/performance.md.
//
//   TRIK=target/release/trik node e2e/figures.js [idle] [first] [channels] [viewers] [tall] [hour[=MINUTES]]
//
// Without names it measures all but the hour. Everything is on this machine, so nothing of it is the network's, and the browser takes
// its share of the processor too.
import { readFileSync, readdirSync } from 'node:fs';
import { eventually, Look, Robot } from './robot.js';
import { Viewer } from './viewer.js';

const SECONDS = 10;
const ROUNDS = 100;
const CHANNELS = 60;
const PERIOD_MS = 20;
const VIEWERS = 30;
/** A node whose values are written here. */
const NODE = 'motors/M3';
const TICKS = 100;

/** @param {string} what @param {number} value @param {string} unit @param {number} limit */
function tell(what, value, unit, limit) {
  const share =
    limit === 0 ? (value === 0 ? 'met' : 'NOT met') : `${(value / limit).toFixed(2)} of the limit`;
  console.info(`${what}: ${value.toFixed(value < 10 ? 2 : 0)} ${unit}, ${share}, ${limit} ${unit}`);
}

const pause = (ms) => new Promise((done) => setTimeout(done, ms));
const ranked = (times, share) =>
  times.toSorted((one, other) => one - other)[Math.min(times.length - 1, Math.floor(share * times.length))];

/** The threads of the robot's processes that serve pages, as folders of /proc. */
function pageThreads(robot) {
  const threads = robot.pids.flatMap((pid) =>
    readdirSync(`/proc/${pid}/task`).map((thread) => `/proc/${pid}/task/${thread}`),
  );
  return threads.filter((thread) => readFileSync(`${thread}/comm`, 'utf8').trim() === 'page');
}

/** Seconds of the processor, and how often it has waited. */
function taken(thread) {
  const fields = readFileSync(`${thread}/stat`, 'utf8').split(') ')[1].split(' ');
  const waits = /^voluntary_ctxt_switches:\s*(\d+)/m.exec(readFileSync(`${thread}/status`, 'utf8'));
  return { cpu_s: (Number(fields[11]) + Number(fields[12])) / TICKS, waits: Number(waits?.[1] ?? 0) };
}

/** What the threads that serve take in some seconds: percent of a core, and how often they wake up. */
async function serving(robot, seconds = SECONDS) {
  const threads = pageThreads(robot);
  const before = threads.map(taken);
  await pause(seconds * 1000);
  const after = threads.map(taken);
  const sum = (key) => after.reduce((all, one, at) => all + one[key] - before[at][key], 0);
  return { percent: (100 * sum('cpu_s')) / seconds, wakes: sum('waits') };
}

async function idle() {
  const robot = await Robot.start();
  try {
    await pause(3000);
    const nobody = await serving(robot);
    tell('the server, nobody looks', nobody.percent, '% of a core', 1);
    tell(`wake-ups of the server in ${SECONDS} s, nobody looks`, nobody.wakes, 'times', 0);
    const viewer = await Viewer.open(robot.url);
    await eventually('values come', () => viewer.pieces > 0);
    viewer.close();
    await pause(5000);
    const gone = await serving(robot);
    tell(`wake-ups of the server in ${SECONDS} s, after the last one has left`, gone.wakes, 'times', 0);
  } finally {
    await robot.end();
  }
}

async function first() {
  const robot = await Robot.start();
  const eyes = await Look.start();
  try {
    const page = await (await fetch(robot.url)).text();
    const files = [...page.matchAll(/(?:src|href)="\.?(\/[^"]+\.js)"/g)].map(([, file]) => file);
    let bytes = 0;
    for (const file of files) {
      // As it is sent: fetch would unpack it.
      const answer = await fetch(new URL(file, robot.url), { headers: { 'accept-encoding': 'gzip' } });
      bytes += Number(answer.headers.get('content-length') ?? 0);
      await answer.arrayBuffer();
    }
    tell('the first script, compressed', bytes / 1024, 'KB', 250);
    const paints = [];
    for (let at = 0; at < 10; at++) {
      const fresh = await eyes.open(`${robot.url}#world`);
      const paint = () =>
        fresh.evaluate(() => performance.getEntriesByName('first-contentful-paint')[0]?.startTime);
      paints.push(await eventually('the first paint', paint));
      await fresh.context().close();
    }
    tell('first paint with an empty cache, the slowest of 10', ranked(paints, 1), 'ms', 1000);
  } finally {
    await eyes.end();
    await robot.end();
  }
}

/** Nodes whose values change all the time. */
function channels() {
  const line = (at) => {
    const heights = Array.from({ length: 50 }, (_, step) => `\\${(at * 7 + step * 5) % 256}\\1`).join('');
    const name = `c${String(at).padStart(2, '0')}`;
    return `trikfs.${name} = { src = fake { data = '${heights}', period_ms = ${PERIOD_MS}, loop = true }, on_event = true,
  input_tuple_size = 2, format = 'u16 height', units = 'mm' }`;
  };
  return Array.from({ length: CHANNELS }, (_, at) => line(at)).join('\n');
}

/** A robot whose channels change fifty times a second. */
async function busyRobot() {
  const robot = await Robot.start();
  robot.write('config', `${robot.read('config')}\n${channels()}\n`);
  return robot;
}

/** Remembers the moment at which each value of a slider was on the screen, by the clock that this script has too. */
async function remember(slider) {
  await slider.evaluate((element) => {
    globalThis.seen = [];
    const look = () => {
      const text = element.getAttribute('aria-valuetext');
      // The picture follows the change.
      requestAnimationFrame(() => globalThis.seen.push([text, Date.now()]));
    };
    new MutationObserver(look).observe(element, { attributes: true, attributeFilter: ['aria-valuetext'] });
  });
}

/** How soon a value is on a screen of this size, with all channels on the page. */
async function busyChannels(viewport) {
  const robot = await busyRobot();
  const eyes = await Look.start();
  try {
    const page = await eyes.open(`${robot.url}#instruments`, { viewport });
    const last = `c${CHANNELS - 1}`;
    await page.getByRole('article', { name: last, exact: true }).waitFor();
    const slider = page.getByRole('slider', { name: `${NODE}, duty_cycle` });
    await slider.waitFor();
    await slider.scrollIntoViewIfNeeded();
    await remember(slider);
    const times = [];
    for (let at = 1; at <= ROUNDS; at++) {
      const text = `${(at % 50) + 1} %`;
      const begin = Date.now();
      robot.write(`${NODE}/value`, (at % 50) + 1);
      const shown = (wanted) => globalThis.seen.findLast(([said]) => said === wanted)?.[1];
      times.push((await eventually('the value is shown', () => page.evaluate(shown, text))) - begin);
      await page.evaluate(() => (globalThis.seen = []));
      await pause(50 + Math.random() * 100);
    }
    const size = `${viewport.width} by ${viewport.height} pixels`;
    const what = `a value from the tree to a screen of ${size} beside ${CHANNELS} channels at ${1000 / PERIOD_MS} Hz`;
    console.info(`${what}, median of ${ROUNDS}: ${ranked(times, 0.5)} ms`);
    tell(`${what}, p95 of ${ROUNDS}`, ranked(times, 0.95), 'ms', 50);
    tell('the server meanwhile', (await serving(robot)).percent, '% of a core', 10);
  } finally {
    await eyes.end();
    await robot.end();
  }
}

async function viewers() {
  const robot = await busyRobot();
  try {
    const all = [];
    for (let at = 0; at < VIEWERS; at++) all.push(await Viewer.open(robot.url));
    await eventually('all are told', () => all.every((viewer) => viewer.pieces > 10), 60_000);
    tell(
      `the server, ${VIEWERS} viewers of ${CHANNELS} channels`,
      (await serving(robot)).percent,
      '% of a core',
      10,
    );
    const rates = async () => {
      const before = all.slice(1).map((viewer) => viewer.pieces);
      await pause(SECONDS * 1000);
      return Math.min(...all.slice(1).map((viewer, at) => viewer.pieces - before[at])) / SECONDS;
    };
    const well = await rates();
    all[0]?.sleep();
    const beside = await rates();
    console.info(
      `pieces a second of the slowest viewer: ${well.toFixed(1)}, and ${beside.toFixed(1)} beside one that reads nothing: ` +
        `${(beside / well).toFixed(2)}`,
    );
    for (const viewer of all) viewer.close();
  } finally {
    await robot.end();
  }
}

/** Bytes of the page's own objects, after all that nobody holds has been thrown away. */
async function heap(page) {
  const session = await page.context().newCDPSession(page);
  await session.send('Performance.enable');
  await session.send('HeapProfiler.collectGarbage');
  const { metrics } = await session.send('Performance.getMetrics');
  await session.detach();
  const used = metrics.find(({ name }) => name === 'JSHeapUsedSize')?.value;
  if (!used) throw new Error('the browser does not say what its heap has');
  return used;
}

async function hour(minutes) {
  const robot = await busyRobot();
  const eyes = await Look.start();
  try {
    const page = await eyes.open(`${robot.url}#instruments`);
    await page.getByRole('article', { name: NODE, exact: true }).waitFor();
    const sizes = [];
    const steps = 12;
    for (let step = 0; step <= steps; step++) {
      sizes.push(await heap(page));
      console.info(
        `after ${((minutes * step) / steps).toFixed(1)} min: ${(sizes[step] / 2 ** 20).toFixed(1)} MiB`,
      );
      if (step < steps) await pause((minutes * 60_000) / steps);
    }
    // What the page keeps of the past is full after its first quarter.
    const quarter = sizes.slice(3, 6);
    const end = sizes.slice(-3);
    const mean = (some) => some.reduce((sum, one) => sum + one, 0) / some.length;
    tell(
      `the page's memory at the end of ${minutes} min`,
      mean(end) / 2 ** 20,
      'MiB',
      (1.1 * mean(quarter)) / 2 ** 20,
    );
  } finally {
    await eyes.end();
    await robot.end();
  }
}

const measures = {
  idle,
  first,
  /** The screen of a usual computer, on which some of the channels are. */
  channels: () => busyChannels({ width: 1920, height: 1080 }),
  viewers,
  /** A window that no screen has: all channels are drawn at once, by the processor where there is no graphics card. */
  tall: () => busyChannels({ width: 1800, height: 8000 }),
};
const wanted = process.argv.slice(2);
for (const name of wanted.length > 0 ? wanted : Object.keys(measures)) {
  const [what, minutes] = name.split('=');
  if (what === 'hour') await hour(Number(minutes ?? 60));
  else if (measures[what]) await measures[what]();
  else
    throw new Error(`no such figure: ${name}; there are ${Object.keys(measures).join(', ')}, hour=MINUTES`);
}
