// Tests of the whole page: in Chromium, over a virtual robot of the `trik` that TRIK names. One after the other, because each has a
// robot of its own, and two cores are few.
import { defineConfig } from 'vitest/config';

export default defineConfig({
  test: {
    include: ['e2e/*.e2e.{ts,js}'],
    testTimeout: 180_000,
    hookTimeout: 180_000,
    // As long as everything else is waited for; one second is too little on a busy machine.
    expect: { poll: { timeout: 60_000 } },
    fileParallelism: false,
    retry: 0,
  },
});
