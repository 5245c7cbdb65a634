// What tests in a real browser share: a robot of `trik up`, browsers that look at its page, and waiting.
//
//   TRIK=target/debug/trik node e2e/NAME.js [DIST]
//
// With DIST the page is the one in this folder instead of the one in the program; it is given with the headers of the server, so
// that its policy for scripts and styles counts. CHROMIUM is the browser.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { chromium } from 'playwright-core';

const program = process.env.TRIK ?? resolve(import.meta.dirname, '../../../target/debug/trik');
const dist = process.argv[2];
const axe = createRequire(import.meta.url).resolve('axe-core/axe.min.js');
const folder = mkdtempSync(join(tmpdir(), 'trik-page-'));
const tree = join(folder, 'robot');
const TYPES = { html: 'text/html', js: 'text/javascript', css: 'text/css', svg: 'image/svg+xml' };
const faults = [];

export function value(node) {
  return readFileSync(join(tree, node, 'value'), 'utf8').trim();
}

/** Waits until something is as it should be, and says what it was. */
export async function until(what, read, wanted) {
  let last;
  for (let left = 100; left > 0; left--) {
    last = await read();
    if (last === wanted) return;
    await new Promise((done) => setTimeout(done, 50));
  }
  assert.fail(`${what}: ${last} instead of ${wanted}`);
}

/** Starts a robot; gives the address of its page. */
async function robot() {
  const options = ['up', '--no-view', '--page-port', '0', '--trikd-ports', '0', tree];
  const child = spawn(program, options, { env: { ...process.env, XDG_RUNTIME_DIR: folder } });
  const address = await new Promise((done, fail) => {
    let said = '';
    const hear = (bytes) => {
      said += bytes;
      const found = /In a browser: (\S+)/.exec(said);
      if (found) done(found[1].replace(/\/$/, ''));
    };
    child.stdout.on('data', hear);
    child.stderr.on('data', hear);
    child.on('exit', () => fail(new Error(said)));
  });
  return { child, address };
}

/** A browser of its own that looks at the page. */
export async function look(browser, address, scheme = 'light') {
  const context = await browser.newContext({
    viewport: { width: 1400, height: 900 },
    colorScheme: scheme,
    locale: 'en',
  });
  const page = await context.newPage();
  page.on('pageerror', (error) => faults.push(error.stack));
  page.on('console', (said) => {
    if (said.type() === 'error') faults.push(said.text());
  });
  if (dist !== undefined) await replace(page, address);
  await page.goto(`${address}/#instruments`);
  await page.getByRole('article', { name: 'motors/M3', exact: true }).waitFor();
  return page;
}

async function replace(page, address) {
  const { headers } = await page.request.get(`${address}/`).then((answer) => ({ headers: answer.headers() }));
  delete headers['content-encoding'];
  delete headers['content-length'];
  await page.route(/\/(assets\/.*|icon\.svg)?$/, (route) => {
    const path = new URL(route.request().url()).pathname;
    const name = path === '/' ? 'index.html' : path.slice(1);
    const type = TYPES[name.split('.').at(-1)] ?? 'application/octet-stream';
    return route.fulfill({ path: join(dist, name), headers: { ...headers, 'content-type': type } });
  });
}

export async function accessible(page, what) {
  // By the protocol of the browser, not by a script of the page, which its policy would forbid.
  await page.evaluate(readFileSync(axe, 'utf8'));
  const { violations } = await page.evaluate(() => globalThis.axe.run());
  const found = violations.map(({ id, nodes }) => `${id}: ${nodes.map((node) => node.html).join('\n  ')}`);
  assert.deepEqual(found, [], what);
}

/** Runs a test on a robot of its own, with a browser; gives 1 if something of a page went wrong. */
export async function tried(test) {
  const { child, address } = await robot();
  const browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
    // A page that is given by this script is in no network, so its robot would be in another one.
    args: [
      '--disable-features=LocalNetworkAccessChecks',
      '--no-sandbox',
      '--disable-gpu',
      '--disable-quic',
      '--no-first-run',
      '--disable-background-networking',
    ],
  });
  try {
    await test(browser, address);
  } finally {
    for (const fault of faults) process.stderr.write(`${fault}\n`);
    await browser.close();
    child.kill('SIGINT');
    await new Promise((done) => child.once('exit', done));
    rmSync(folder, { recursive: true, force: true });
  }
  assert.deepEqual(faults, []);
}
