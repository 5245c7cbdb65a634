// A virtual robot with its page, and browsers that look at it: what all tests in a browser share.
//
// Owns the processes and their end. What is looked at is known to the tests. TRIK is the program under test, CHROMIUM the browser.

import axe from 'axe-core';
import { chromium } from 'playwright-core';
import { spawn, spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';

const TRIK = process.env.TRIK ?? resolve(import.meta.dirname, '../../../target/debug/trik');
const CHROMIUM = process.env.CHROMIUM ?? '/usr/bin/chromium';
/** How long anything that must happen may take: beside other work a browser and a robot need many seconds. */
const END_MS = 60_000;

/** A virtual robot that runs. */
export class Robot {
  home;
  tree;
  #said = '';
  /** @type {import('node:child_process').ChildProcess} */
  #child;
  /** @type {string[]} */
  #args;
  #command;

  /**
   * @param {string[]} args
   * @param {'up' | 'replay'} command
   * @param {string} home where it finds other robots, and they it
   * @param {string} name
   */
  constructor(args, command = 'up', home = newHome(), name = 'robot') {
    this.home = home;
    this.tree = join(home, name);
    this.#command = command;
    this.#args = args;
    this.#child = this.#start();
  }

  /**
   * Starts one, with further options of `trik up`.
   * @param {string[]} args
   */
  static async start(...args) {
    const robot = new Robot(args);
    await robot.#ready();
    return robot;
  }

  /**
   * Starts one beside others.
   * @param {string} home
   * @param {string} name
   * @param {string[]} args
   */
  static async startIn(home, name, ...args) {
    const robot = new Robot(args, 'up', home, name);
    await robot.#ready();
    return robot;
  }

  /**
   * Plays a recording, standing still at its beginning.
   * @param {string} file
   */
  static async replay(file) {
    const robot = new Robot(['--paused', file], 'replay');
    await robot.#ready();
    return robot;
  }

  /**
   * Records everything for some seconds: begun once the recorder looks, recorded once the file is whole.
   * @param {string} file
   * @param {number} seconds
   * @param {boolean} hasWorld the world around the robot is recorded too
   */
  record(file, seconds, hasWorld = true) {
    // There it finds the world around the robot.
    const env = { ...process.env, XDG_RUNTIME_DIR: hasWorld ? this.home : join(this.home, 'nothing') };
    const child = spawn(TRIK, ['record', '-o', file, '--seconds', String(seconds), this.tree], { env });
    let said = '';
    const begun = new Promise((done) => {
      for (const stream of [child.stdout, child.stderr]) {
        stream.on('data', (/** @type {Buffer} */ text) => {
          said += text.toString();
          if (said.includes('recording ')) done(undefined);
        });
      }
    });
    const recorded = new Promise((done, fail) => {
      child.once('error', fail);
      child.once('exit', (status) =>
        status === 0 ? done(undefined) : fail(new Error(`trik record: ${said}`)),
      );
    });
    // A recorder that ends at once has not begun.
    return { begun: Promise.race([begun, recorded]), recorded };
  }

  /** Where its page is; it ends with a slash. */
  get url() {
    return /In a browser: (\S+)/.exec(this.#said)?.[1] ?? '';
  }

  /**
   * What a file of its tree says.
   * @param {string} file
   */
  read(file) {
    return readFileSync(join(this.tree, file), 'utf8').trim();
  }

  /**
   * Writes a file of its tree.
   * @param {string} file
   * @param {string | number} value
   */
  write(file, value) {
    writeFileSync(join(this.tree, file), String(value));
  }

  /** Its processes: `trik`, and all that it has started. */
  get pids() {
    /** @type {(pid: number) => number[]} */
    const children = (pid) => {
      const all = readFileSync(`/proc/${pid}/task/${pid}/children`, 'utf8')
        .split(' ')
        .filter(Boolean)
        .map(Number);
      return [pid, ...all.flatMap(children)];
    };
    return children(this.#child.pid ?? 0);
  }

  /** Ends it as a person does. */
  async end() {
    await this.#end();
    rmSync(this.home, { recursive: true, force: true });
  }

  /** Ends it, and leaves its home to others. */
  async leave() {
    await this.#end();
  }

  /** It is there again after that, by the same name. */
  async back() {
    this.#said = '';
    this.#child = this.#start();
    await this.#ready();
  }

  /** Ends it and starts it again at the same port. */
  async restart(whileGone = async () => {}) {
    const port = new URL(this.url).port;
    await this.#end();
    await whileGone();
    this.#said = '';
    this.#args.push('--page-port', port);
    this.#child = this.#start();
    await this.#ready();
  }

  #start() {
    const ports = this.#args.includes('--page-port') ? [] : ['--page-port', '0'];
    const args = [this.#command, '--no-view', '--trikd-ports', '0', ...ports, ...this.#args, this.tree];
    const env = { ...process.env, XDG_RUNTIME_DIR: this.home };
    const child = spawn(TRIK, args, { env, stdio: ['ignore', 'pipe', 'pipe'] });
    for (const stream of [child.stdout, child.stderr]) {
      stream.on('data', (/** @type {Buffer} */ text) => (this.#said += text.toString()));
    }
    return child;
  }

  async #ready() {
    await eventually('the robot is ready', () => this.url !== '' || this.#child.exitCode !== null);
    if (this.url === '') throw new Error(`there is no robot: ${this.#said}`);
  }

  async #end() {
    if (this.#child.exitCode !== null) return;
    const ended = new Promise((end) => this.#child.once('exit', end));
    this.#child.kill('SIGINT');
    await ended;
  }
}

/** A folder of its own, short enough for names of sockets. */
export function newHome() {
  return mkdtempSync(join(tmpdir(), 'trik-page-'));
}

/** The page of a class that is served. */
export class ClassPage {
  #said = '';
  /** @type {import('node:child_process').ChildProcess} */
  #child;

  /** @param {string} home @param {string} lines */
  constructor(home, lines) {
    const file = join(home, 'class.txt');
    writeFileSync(file, lines);
    const env = { ...process.env, XDG_RUNTIME_DIR: home };
    const args = ['class', 'page', '--class', file, '--port', '0'];
    this.#child = spawn(TRIK, args, { env, stdio: ['ignore', 'pipe', 'pipe'] });
    for (const stream of [this.#child.stdout, this.#child.stderr]) {
      stream?.on('data', (/** @type {Buffer} */ text) => (this.#said += text.toString()));
    }
  }

  /**
   * Serves one for the robots that a file with these lines names.
   * @param {string} home
   * @param {string} lines
   */
  static async start(home, lines) {
    const page = new ClassPage(home, lines);
    const child = page.#child;
    await eventually('the class is served', () => page.url !== '' || child.exitCode !== null);
    if (page.url === '') throw new Error(`there is no page: ${page.#said}`);
    return page;
  }

  get url() {
    return /in a browser: (\S+)/.exec(this.#said)?.[1] ?? '';
  }

  async end() {
    if (this.#child.exitCode !== null) return;
    const ended = new Promise((end) => this.#child.once('exit', end));
    this.#child.kill('SIGINT');
    await ended;
  }
}

/** A class that is judged, with its page of marks. */
export class Judging {
  said = '';
  /** @type {import('node:child_process').ChildProcess} */
  child;

  /** @param {string} folder @param {string[]} args */
  constructor(folder, args) {
    // Replays that nobody names a folder for go below this one, so that it can be seen that they go.
    const env = { ...process.env, TMPDIR: folder, XDG_RUNTIME_DIR: folder };
    const words = ['check', ...args, '--page', '--page-port', '0'];
    this.child = spawn(TRIK, words, { cwd: folder, env, stdio: ['ignore', 'pipe', 'pipe'] });
    for (const stream of [this.child.stdout, this.child.stderr]) {
      stream?.on('data', (/** @type {Buffer} */ text) => (this.said += text.toString()));
    }
  }

  /**
   * Begins to judge what these words of `trik check` say, in a folder.
   * @param {string} folder
   * @param {string[]} args
   */
  static async start(folder, ...args) {
    const judging = new Judging(folder, args);
    const { child } = judging;
    await eventually('the marks are served', () => judging.url !== '' || child.exitCode !== null);
    if (judging.url === '') throw new Error(`there is no page: ${judging.said}`);
    return judging;
  }

  get url() {
    return /in a browser: (\S+)/.exec(this.said)?.[1] ?? '';
  }

  /** The processes that judge. */
  get workers() {
    const threads = readdirSync(`/proc/${this.child.pid}/task`);
    /** @param {string} thread */
    const children = (thread) => {
      try {
        return readFileSync(`/proc/${this.child.pid}/task/${thread}/children`, 'utf8').split(' ');
      } catch {
        // It has ended meanwhile.
        return [];
      }
    };
    return threads.flatMap(children).filter(Boolean).map(Number);
  }

  /**
   * Ends it as a person does, and gives its exit code, or the signal that it has ended by.
   * @param {NodeJS.Signals} signal
   */
  async end(signal = 'SIGINT') {
    if (this.child.exitCode === null && this.child.signalCode === null) {
      const ended = new Promise((end) => this.child.once('close', end));
      this.child.kill(signal);
      await ended;
    }
    return this.child.exitCode ?? this.child.signalCode;
  }
}

/**
 * Makes a task for programs in a folder of this name, as `trik new-task` does.
 * @param {string} folder
 * @param {string} name
 */
export function newTask(folder, name) {
  const done = spawnSync(TRIK, ['new-task', name], { cwd: folder, encoding: 'utf8' });
  if (done.status !== 0) throw new Error(`trik new-task: ${done.stdout}${done.stderr}`);
}

/**
 * Waits until something holds, and gives what that was.
 * @template T
 * @param {string} what
 * @param {() => T | undefined | Promise<T | undefined>} holds
 * @returns {Promise<T>}
 */
export async function eventually(what, holds, patience_ms = END_MS) {
  const end = Date.now() + patience_ms;
  for (;;) {
    const now = await holds();
    if (now) return now;
    if (Date.now() > end) throw new Error(`not in ${patience_ms} ms: ${what}`);
    await new Promise((again) => setTimeout(again, 20));
  }
}

/**
 * Waits until something has this value; the error says what it had.
 * @template T
 * @param {string} what
 * @param {() => T | Promise<T>} read
 * @param {T} wanted
 */
export async function until(what, read, wanted) {
  /** @type {T | undefined} */
  let last;
  try {
    await eventually(what, async () => (last = await read()) === wanted);
  } catch (error) {
    throw new Error(`${what}: ${last} instead of ${wanted}`, { cause: error });
  }
}

/** A browser; what its pages complain of is kept. */
export class Look {
  /** @type {string[]} */
  complaints = [];
  #browser;

  /** @param {import('playwright-core').Browser} browser */
  constructor(browser) {
    this.#browser = browser;
  }

  static async start() {
    const quiet = ['gpu', 'quic', 'background-networking', 'component-update', 'sync'];
    const args = ['--no-sandbox', '--no-first-run', ...quiet.map((what) => `--disable-${what}`)];
    return new Look(await chromium.launch({ executablePath: CHROMIUM, args }));
  }

  /**
   * Another person: no cookies and nothing stored is shared with the others. `prepare` sees the page before it goes anywhere.
   * @param {string} url
   * @param {import('playwright-core').BrowserContextOptions} options
   * @param {(page: import('playwright-core').Page) => void} prepare
   */
  async open(url, options = {}, prepare = () => undefined) {
    const viewport = { width: 1400, height: 900 };
    const context = await this.#browser.newContext({ locale: 'en-US', viewport, ...options });
    context.setDefaultTimeout(END_MS);
    const page = await context.newPage();
    page.on('pageerror', (error) => this.complaints.push(error.stack ?? error.message));
    page.on('console', (message) => {
      const text = message.text();
      // A connection that is lost on purpose is said here by the browser itself. So is the style of a selection that is typed
      // over in an editor, which the browser would keep and the policy forbids.
      const isBrowsers =
        /WebSocket connection|ERR_CONNECTION/.test(text) ||
        (text.startsWith('Applying inline style') && message.location().lineNumber === 0);
      if (message.type() === 'error' && !isBrowsers) this.complaints.push(text);
    });
    prepare(page);
    await page.goto(url);
    return page;
  }

  /** The memory of all processes of pages, each page of theirs counted by its share (PSS), in MiB. */
  async memory_mib() {
    const session = await this.#browser.newBrowserCDPSession();
    const { processInfo } = await session.send('SystemInfo.getProcessInfo');
    await session.detach();
    const pages = processInfo.filter(({ type }) => type === 'renderer');
    const shares = pages.map(({ id }) => {
      try {
        return Number(/^Pss:\s+(\d+)/m.exec(readFileSync(`/proc/${id}/smaps_rollup`, 'utf8'))?.[1] ?? 0);
      } catch {
        // It has ended meanwhile.
        return 0;
      }
    });
    return shares.reduce((sum, kib) => sum + kib, 0) / 1024;
  }

  async end() {
    await this.#browser.close();
  }
}

/**
 * What axe finds wrong, each with its elements.
 * @param {import('playwright-core').Page} page
 * @returns {Promise<string[]>}
 */
export async function barriers(page) {
  // By the protocol of the browser, not by a script of the page, which its policy would forbid.
  await page.evaluate(axe.source);
  // Without styles that it would add to roots of their own, which the policy forbids too.
  const { violations } = await page.evaluate('axe.run({ preload: false })');
  return violations.map(
    (/** @type {import('axe-core').Result} */ { id, nodes }) =>
      `${id}: ${nodes.map((node) => node.html).join(' | ')}`,
  );
}
