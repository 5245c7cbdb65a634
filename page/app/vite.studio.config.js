// How the studio is built: static files for any web server, in any folder of it. TRIK_STUDIO_PACKAGE is the package of web/build.sh.
import { svelte } from '@sveltejs/vite-plugin-svelte';
import { renameSync } from 'node:fs';
import { resolve } from 'node:path';
import { defineConfig } from 'vite';
import { licences } from './licences.js';
import { offline } from './offline.js';
import { robotScripts } from './robot-scripts.js';

const built = process.env.TRIK_STUDIO_PACKAGE ?? resolve(import.meta.dirname, '../../target/web/package');

/** The page is what a folder shows. */
function index() {
  let out = '';
  return {
    name: 'index',
    configResolved: (config) => void (out = config.build.outDir),
    closeBundle: () => renameSync(resolve(out, 'studio.html'), resolve(out, 'index.html')),
  };
}

export default defineConfig({
  base: './',
  plugins: [svelte(), robotScripts(), licences(), offline('public'), index()],
  resolve: { alias: { 'trik-studio-web': resolve(built, 'studio.js') } },
  worker: { format: 'es', plugins: () => [robotScripts()] },
  build: {
    target: 'es2023',
    assetsInlineLimit: 0,
    modulePreload: { polyfill: false },
    rollupOptions: { input: 'studio.html' },
  },
});
