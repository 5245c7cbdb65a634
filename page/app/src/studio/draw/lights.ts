// The key under which blocks of a sheet find those that are at work.

import type { SvelteSet } from 'svelte/reactivity';

export const LIGHTS = Symbol('lights');

/** Ids of blocks in which a thread of the running program is. */
export type Lights = SvelteSet<string>;
