// The package for Node: the module is read from its file and is ready at once.
import { readFileSync } from 'node:fs';
import { initSync } from './studio.js';

initSync({ module: readFileSync(new URL('studio_bg.wasm', import.meta.url)) });

export * from './studio.js';
