// The module for models, for Node: read from its file and ready at once.
import { readFileSync } from 'node:fs';
import { initSync } from './dcml.js';

initSync({ module: readFileSync(new URL('dcml_bg.wasm', import.meta.url)) });

export * from './dcml.js';
