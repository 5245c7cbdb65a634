// Which blocks a person wants first, kept by the browser.

import { SvelteSet } from 'svelte/reactivity';

const KEY = 'trik-studio-favourites';

function read(): string[] {
  try {
    const all: unknown = JSON.parse(localStorage.getItem(KEY) ?? '[]');
    return Array.isArray(all) ? all.filter((one) => typeof one === 'string') : [];
  } catch {
    return [];
  }
}

export const favourites = new SvelteSet<string>(read());

/** A block becomes a favourite, or is one no longer. */
export function favour(key: string): void {
  if (!favourites.delete(key)) favourites.add(key);
  try {
    localStorage.setItem(KEY, JSON.stringify([...favourites]));
  } catch {
    // Then they are those of this page alone.
  }
}
