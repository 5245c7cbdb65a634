// What the studio costs, each as a share of its limit: figures for docs/maintainer/performance.md.
//
//   STUDIO=target/web/site node e2e-studio/figures.js [NAME...]
//
// Names choose what; without any all is measured.
import { readFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { join, resolve } from 'node:path';
import { Look, eventually } from '../e2e/robot.js';

const ROOT = resolve(import.meta.dirname, '../../..');
const SITE = resolve(process.env.STUDIO ?? join(ROOT, 'target/web/site'));
const PACKAGE = resolve(process.env.TRIK_STUDIO_PACKAGE ?? join(ROOT, 'target/web/package'));
const TYPES = {
  html: 'text/html',
  js: 'text/javascript',
  css: 'text/css',
  wasm: 'application/wasm',
  svg: 'image/svg+xml',
};
/** As the original is on a slow line: 4 Mbit/s and 20 ms. */
const SLOW = { offline: false, downloadThroughput: 500_000, uploadThroughput: 500_000, latency: 20 };

const { blank, open } = await import(join(PACKAGE, 'node.js'));

/** Files as a server has them that compresses. */
async function serve() {
  const { gzipSync } = await import('node:zlib');
  const packed = new Map();
  const server = createServer((request, response) => {
    const name = new URL(request.url, 'http://site').pathname.slice(1) || 'index.html';
    try {
      if (!packed.has(name)) packed.set(name, gzipSync(readFileSync(join(SITE, name)), { level: 9 }));
      const type = TYPES[name.split('.').at(-1)] ?? 'application/octet-stream';
      response.writeHead(200, { 'content-type': type, 'content-encoding': 'gzip' }).end(packed.get(name));
    } catch {
      response.writeHead(404).end();
    }
  });
  await new Promise((done) => server.listen(0, '127.0.0.1', done));
  return { url: `http://127.0.0.1:${server.address().port}/`, end: () => server.close() };
}

/** A program of so many blocks that drives round and round, as a draft. */
function program(count) {
  const draft = blank('many.qrs').value;
  const diagram = draft.about().diagrams[0].id;
  const [start] = draft.sheet(diagram).blocks;
  const kinds = [
    { kind: 'TrikV6EnginesForward', properties: { Ports: 'M3, M4', Power: '40 + x % 20' } },
    { kind: 'Timer', properties: { Delay: '10' } },
    { kind: 'Function', properties: { Body: 'x = x + 1; y = sensorA1 * 2 + x' } },
  ];
  const blocks = [{ kind: 'Function', properties: { Body: 'x = 0' }, at: [200, 100] }];
  for (let at = 1; at < count; at++)
    blocks.push({ ...kinds[at % 3], at: [100 + (at % 25) * 100, 100 + Math.floor(at / 25) * 125] });
  const links = blocks.slice(1).map((_, at) => ({ from: at, to: at + 1 }));
  const made = draft.apply({ do: 'add', diagram, blocks, links: [...links, { from: count - 1, to: 1 }] });
  if (!made.ok) throw new Error(made.error.problems[0].message);
  draft.apply({ do: 'connect', from: start.id, to: made.value[0] });
  return { draft, diagram, ids: made.value.slice(0, count) };
}

function rank(times, share) {
  times.sort((one, other) => one - other);
  return times[Math.min(times.length - 1, Math.floor(share * times.length))];
}

function told(name, value, unit, limit) {
  console.info(`${name.padEnd(44)} ${value.toFixed(1)} ${unit}, ${(value / limit).toFixed(2)} of ${limit}`);
}

function timed(rounds, what) {
  const times = [];
  for (let round = 0; round < rounds; round++) {
    const began = performance.now();
    what(round);
    times.push(performance.now() - began);
  }
  return times;
}

const FIGURES = {
  /** After a change of one of 500 blocks: mistakes found, and the sheet told anew. */
  draft() {
    const { draft, diagram, ids } = program(500);
    const change = (round) =>
      draft.apply({ do: 'set', id: ids[3], property: 'Ports', value: `M${1 + (round % 4)}` });
    told(
      '500 blocks: mistakes, p95',
      rank(
        timed(40, (round) => (change(round), draft.lint())),
        0.95,
      ),
      'ms',
      50,
    );
    const look = (round) => (change(round), draft.about(), draft.sheet(diagram));
    told('500 blocks: a change and its sheet, p95', rank(timed(40, look), 0.95), 'ms', 16.7);
    told(
      '500 blocks: the file, p95',
      rank(
        timed(20, () => draft.save()),
        0.95,
      ),
      'ms',
      500,
    );
  },
  /** A change of one of 300 blocks while they run: the new version in the run, and all that leads there. */
  patch() {
    const { draft, ids } = program(300);
    const run = open('many.qrs', draft.save().value).value.run({ debug: true }).value;
    const [patches, whole] = [[], []];
    for (let round = 0; round < 40; round++) {
      run.tick(5);
      draft.apply({ do: 'set', id: ids[2], property: 'Body', value: `x = x + ${round}` });
      const began = performance.now();
      const next = open('many.qrs', draft.stored().value).value;
      const opened = performance.now();
      const patched = run.patch(next);
      if (!patched.ok) throw new Error(patched.error.problems[0].message);
      next.free();
      patches.push(performance.now() - opened);
      whole.push(performance.now() - began);
    }
    told('300 blocks that run: a patch, p95', rank(patches, 0.95), 'ms', 16.7);
    const name = 'the same, with its file written and read, p95';
    console.info(`${name.padEnd(44)} ${rank(whole, 0.95).toFixed(1)} ms`);
  },
  async first(look, site) {
    const paints = [];
    const ready = [];
    for (let round = 0; round < 5; round++) {
      const page = await look.open('about:blank');
      const session = await page.context().newCDPSession(page);
      await session.send('Network.enable');
      await session.send('Network.emulateNetworkConditions', SLOW);
      await page.goto(site.url);
      await page.locator('.svelte-flow__node').first().waitFor();
      ready.push(await page.evaluate(() => performance.now()));
      const paint = () =>
        page.evaluate(() => performance.getEntriesByName('first-contentful-paint')[0]?.startTime);
      paints.push(await eventually('the first paint', paint));
      await page.context().close();
    }
    told('first paint at 4 Mbit/s, slowest of 5', rank(paints, 1), 'ms', 1500);
    console.info(`${'ready to draw there, slowest of 5'.padEnd(44)} ${rank(ready, 1).toFixed(0)} ms`);
  },
  async frames(look, site) {
    const { draft } = program(300);
    const page = await look.open(site.url);
    const buffer = Buffer.from(draft.save().value);
    await page
      .locator('input[type=file][accept^=".qrs"]')
      .setInputFiles({ name: 'many.qrs', mimeType: 'application/zip', buffer });
    await page.getByRole('heading', { name: 'many.qrs' }).waitFor();
    await page.getByRole('button', { name: 'Run', exact: true }).click();
    await page.locator('.lit').first().waitFor();
    const gaps = await page.evaluate(
      () =>
        new Promise((done) => {
          const all = [];
          let last = performance.now();
          const next = (now) => {
            all.push(now - last);
            last = now;
            if (all.length < 300) requestAnimationFrame(next);
            else done(all.slice(1));
          };
          requestAnimationFrame(next);
        }),
    );
    told('300 blocks and a running world: a frame, median', rank(gaps, 0.5), 'ms', 16.7);
    told('the same, p95', rank(gaps, 0.95), 'ms', 16.7);
    // A change is in force at the next tick: how long until the page has told it to the run.
    await page.locator('.svelte-flow__node').nth(5).click();
    const times = [];
    for (let round = 0; round < 20; round++) {
      const began = performance.now();
      const field = page.getByLabel('Properties').getByRole('textbox').first();
      const value = `${10 + round}`;
      await field.fill(value);
      await field.press('Enter');
      await page.locator('.svelte-flow__node', { hasText: value }).first().waitFor();
      times.push(performance.now() - began);
    }
    console.info(
      `${'a property typed and shown, median of 20'.padEnd(44)} ${rank(times, 0.5).toFixed(0)} ms`,
    );
    await page.context().close();
  },
  async hour(look, site, minutes = 60) {
    const { draft } = program(100);
    const page = await look.open('about:blank');
    await page.waitForTimeout(2000);
    const empty = await look.memory_mib();
    await page.goto(site.url);
    const session = await page.context().newCDPSession(page);
    const heap = async () => {
      await session.send('HeapProfiler.collectGarbage');
      return (await session.send('Runtime.getHeapUsage')).usedSize / 2 ** 20;
    };
    const buffer = Buffer.from(draft.save().value);
    await page
      .locator('input[type=file][accept^=".qrs"]')
      .setInputFiles({ name: 'many.qrs', mimeType: 'application/zip', buffer });
    await page.getByRole('button', { name: 'Run', exact: true }).click();
    const heaps = [];
    const processes = [];
    const end = Date.now() + minutes * 60_000;
    while (Date.now() < end) {
      heaps.push(await heap());
      processes.push(await look.memory_mib());
      await page.waitForTimeout(Math.min(30_000, minutes * 1_500));
    }
    told(`heap of the page, most of ${minutes} minutes of a run`, Math.max(...heaps), 'MiB', 150);
    // With the Workers, the module and its code.
    told('its process beyond an empty page, most', Math.max(...processes) - empty, 'MiB', 150);
    told('the same at the end', processes.at(-1) - empty, 'MiB', 150);
    await page.context().close();
  },
};

const wanted = process.argv.slice(2);
const look = await Look.start();
const site = await serve();
try {
  for (const [name, measure] of Object.entries(FIGURES)) {
    const word = wanted.find((one) => one.split('=')[0] === name);
    if (wanted.length > 0 ? word === undefined : name === 'hour') continue;
    await measure(look, site, ...(word?.split('=').slice(1).map(Number) ?? []));
  }
} finally {
  await look.end();
  site.end();
}
