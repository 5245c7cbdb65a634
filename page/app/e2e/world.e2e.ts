// The script `world.js`, which stands alone, as a test among the others.

import { execFile } from 'node:child_process';
import { promisify } from 'node:util';
import { expect, test } from 'vitest';

const PATIENCE_MS = 300_000;

test(
  'the world of a virtual robot is seen and takes orders',
  async () => {
    const { stdout } = await promisify(execFile)('node', ['e2e/world.js']);
    expect(stdout).toContain('the world is as it should be');
  },
  PATIENCE_MS,
);
