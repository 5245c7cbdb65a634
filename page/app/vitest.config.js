// Tests of what needs no browser.
import { svelte } from '@sveltejs/vite-plugin-svelte';
import { defineConfig } from 'vitest/config';

export default defineConfig({
  plugins: [svelte()],
  // A recording that tests read.
  assetsInclude: ['**/*.mcap'],
  // Some compute, on machines that are busy.
  test: { include: ['src/**/*.test.ts'], testTimeout: 60_000 },
});
