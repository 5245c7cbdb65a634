// Tests of the studio in Chromium, over the static files that STUDIO names.
import { defineConfig } from 'vitest/config';

export default defineConfig({
  test: {
    include: ['e2e-studio/*.e2e.ts'],
    testTimeout: 180_000,
    hookTimeout: 60_000,
    expect: { poll: { timeout: 60_000 } },
    fileParallelism: false,
    retry: 0,
  },
});
