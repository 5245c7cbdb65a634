// What a file of tests of the studio shares: a browser, the studio as a site, and a folder of its own.
//
// Owns their beginning and end, and that no page of a test has complained.

import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import type { Locator, Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, expect } from 'vitest';
import { Look } from '../e2e/robot.js';
import { Site } from './site';

/** What `begin` begins; before the first test it is not there. */
interface Shared {
  look: Look;
  site: Site;
  /** A folder that is gone at the end. */
  home: string;
  /** The studio in a new page. */
  open: () => Promise<Page>;
}

/**
 * To be called once, at the top of a file of tests. Where pages are given rubbish they may complain: those tests look at what the page
 * shows instead.
 */
export function begin({ mayComplain = false } = {}): Shared {
  const here = { open: () => here.look.open(here.site.url) } as Shared;
  beforeAll(async () => {
    here.look = await Look.start();
    here.site = await Site.start();
    here.home = mkdtempSync(join(tmpdir(), 'trik-studio-'));
  });
  afterEach(() => {
    if (!mayComplain) expect(here.look.complaints).toEqual([]);
  });
  afterAll(async () => {
    await here.look?.end();
    await here.site?.end();
    if (here.home) rmSync(here.home, { recursive: true, force: true });
  });
  return here;
}

/** The button of exactly this name. */
export const button = (page: Page, name: string): Locator => page.getByRole('button', { name, exact: true });
