// How the page is built: one script, one sheet of styles, and what is loaded when it is opened.
import { svelte } from '@sveltejs/vite-plugin-svelte';
import { defineConfig } from 'vite';
import { licences } from './licences.js';

export default defineConfig({
  plugins: [svelte(), licences()],
  build: { target: 'es2023', assetsInlineLimit: 0, modulePreload: { polyfill: false } },
  // During work on the page: `npx vite` beside a running `trik up`.
  server: {
    proxy: Object.fromEntries(
      ['/socket', '/programs', '/program', '/configuration', '/diagram', '/plain'].map((path) => [
        path,
        { target: process.env.TRIK_PAGE ?? 'http://127.0.0.1:8000', ws: true },
      ]),
    ),
  },
});
