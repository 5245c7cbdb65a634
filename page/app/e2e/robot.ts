// A virtual robot with its page, and a browser that looks at it.
//
// Owns the processes and their end. What is looked at is known to the tests.

import AxeBuilder from 'axe-core';
import { type Browser, type BrowserContextOptions, chromium, type Page } from 'playwright-core';
import { type ChildProcess, spawn } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

/** The program under test. */
const TRIK = process.env['TRIK'] ?? '../../target/debug/trik';
const CHROMIUM = process.env['CHROMIUM'] ?? '/usr/bin/chromium';
const START_MS = 20_000;

/** A virtual robot that runs. */
export class Robot {
  readonly home = mkdtempSync(join(tmpdir(), 'trik-page-'));
  readonly tree = join(this.home, 'robot');
  #said = '';
  #child: ChildProcess;

  private constructor(private readonly args: string[]) {
    this.#child = this.#start();
  }

  static async start(...args: string[]): Promise<Robot> {
    const robot = new Robot(args);
    await robot.#ready();
    return robot;
  }

  /** Where its page is. */
  get url(): string {
    return /In a browser: (\S+)/.exec(this.#said)?.[1] ?? '';
  }

  /** What a file of its tree says. */
  read(file: string): string {
    return readFileSync(join(this.tree, file), 'utf8').trim();
  }

  /** Ends it as a person does. */
  async end(): Promise<void> {
    await this.#kill('SIGINT');
    rmSync(this.home, { recursive: true, force: true });
  }

  /** Ends it and starts it again at the same port. */
  async restart(): Promise<void> {
    const port = new URL(this.url).port;
    await this.#kill('SIGINT');
    this.#said = '';
    this.args.push('--page-port', port);
    this.#child = this.#start();
    await this.#ready();
  }

  #start(): ChildProcess {
    const args = ['up', '--no-view', '--trikd-ports', '0', ...this.args, this.tree];
    const env = { ...process.env, XDG_RUNTIME_DIR: this.home };
    const child = spawn(TRIK, args, { env, stdio: ['ignore', 'pipe', 'pipe'] });
    child.stdout.on('data', (text: Buffer) => (this.#said += text.toString()));
    child.stderr.on('data', (text: Buffer) => (this.#said += text.toString()));
    return child;
  }

  async #ready(): Promise<void> {
    await eventually('the robot is ready', () => this.url !== '' || this.#child.exitCode !== null, START_MS);
    if (this.url === '') throw new Error(`there is no robot: ${this.#said}`);
  }

  async #kill(signal: NodeJS.Signals): Promise<void> {
    if (this.#child.exitCode !== null) return;
    const ended = new Promise((end) => this.#child.once('exit', end));
    this.#child.kill(signal);
    await ended;
  }
}

/** Waits until something holds. */
export async function eventually(what: string, holds: () => unknown, patience_ms = 15_000): Promise<void> {
  const end = Date.now() + patience_ms;
  while (!(await holds())) {
    if (Date.now() > end) throw new Error(`not in ${patience_ms} ms: ${what}`);
    await new Promise((again) => setTimeout(again, 20));
  }
}

/** A browser; complaints of its pages are kept. */
export class Look {
  readonly complaints: string[] = [];

  private constructor(private readonly browser: Browser) {}

  static async start(): Promise<Look> {
    const quiet = ['quic', 'background-networking', 'component-update', 'sync'].map(
      (what) => `--disable-${what}`,
    );
    const args = ['--no-sandbox', '--disable-gpu', '--no-first-run', ...quiet];
    return new Look(await chromium.launch({ executablePath: CHROMIUM, args }));
  }

  /** Another person: no cookies and nothing stored is shared with the others. */
  async open(url: string, options: BrowserContextOptions = {}): Promise<Page> {
    const context = await this.browser.newContext({ locale: 'en-US', ...options });
    const page = await context.newPage();
    page.on('pageerror', (error) => this.complaints.push(error.message));
    page.on('console', (message) => {
      // A connection that is lost on purpose is said here by the browser itself.
      const isOurs =
        message.type() === 'error' && !/WebSocket connection|ERR_CONNECTION/.test(message.text());
      if (isOurs) this.complaints.push(message.text());
    });
    await page.goto(url);
    return page;
  }

  async end(): Promise<void> {
    await this.browser.close();
  }
}

/** What axe finds wrong, each with its elements. */
export async function barriers(page: Page): Promise<string[]> {
  // As a function of ours: the page forbids scripts that are put into it.
  await page.evaluate(AxeBuilder.source);
  const found = await page.evaluate(async () => {
    const axe = (
      window as unknown as {
        axe: { run: () => Promise<{ violations: { id: string; nodes: { html: string }[] }[] }> };
      }
    ).axe;
    return (await axe.run()).violations;
  });
  return found.map(({ id, nodes }) => `${id}: ${nodes.map((node) => node.html).join(' | ')}`);
}
