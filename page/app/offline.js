// A service worker that keeps all files of a site, so that it works without a network once it was open.
//
// Owns its text, and the list of files in it. A site with other files has another worker, and browsers take it by themselves.
import { createHash } from 'node:crypto';
import { readdirSync } from 'node:fs';

/** What the worker does; FILES and CACHE stand before it. */
const TEXT = `
addEventListener('install', (event) => {
  event.waitUntil(caches.open(CACHE).then((cache) => cache.addAll(FILES)).then(() => skipWaiting()));
});
addEventListener('activate', (event) => {
  const old = (name) => name.startsWith('trik-studio-') && name !== CACHE;
  event.waitUntil(
    caches
      .keys()
      .then((names) => Promise.all(names.filter(old).map((name) => caches.delete(name))))
      .then(() => clients.claim()),
  );
});
addEventListener('fetch', (event) => {
  if (event.request.method !== 'GET' || !event.request.url.startsWith(registration.scope)) return;
  const search = { ignoreSearch: true };
  event.respondWith(caches.match(event.request, search).then((kept) => kept ?? fetch(event.request)));
});
`;

export function offline(publicDir) {
  return {
    name: 'offline',
    // The last one: all others have given their files.
    generateBundle: {
      order: 'post',
      handler(_, bundle) {
        const made = Object.keys(bundle).map((name) => (name === 'studio.html' ? 'index.html' : name));
        const files = ['./', ...made, ...readdirSync(publicDir)].filter((name) => name !== 'licences.txt');
        const all = JSON.stringify([...new Set(files)].sort());
        const cache = createHash('sha256').update(all).digest('hex').slice(0, 16);
        const source = `const CACHE = 'trik-studio-${cache}';\nconst FILES = ${all};\n${TEXT}`;
        this.emitFile({ type: 'asset', fileName: 'sw.js', source });
      },
    },
  };
}
