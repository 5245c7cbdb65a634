// All real worlds, if they are there, in the world editor's model: a change keeps all letters but those that it names.

import { existsSync, readFileSync, readdirSync } from 'node:fs';
import { join } from 'node:path';
import { expect, test } from 'vitest';
import { isFault, changed, model } from '../src/studio/world/model';
import { read, spliced } from '../src/studio/world/xml';
import { DATA, library } from './site';

/** The texts of worlds, in files of their own and in saves. */
async function worlds(): Promise<[file: string, text: string][]> {
  const { edit } = await library();
  const files = readdirSync(DATA, { recursive: true, encoding: 'utf8' });
  return files.flatMap((file): [string, string][] => {
    if (file.endsWith('.xml')) return [[file, readFileSync(join(DATA, file), 'utf8')]];
    if (!file.endsWith('.qrs')) return [];
    const opened = edit(file, new Uint8Array(readFileSync(join(DATA, file))));
    const text = opened.ok ? opened.value.world() : undefined;
    if (opened.ok) opened.value.free();
    return text === undefined ? [] : [[file, text]];
  });
}

test.skipIf(!existsSync(DATA))('of real worlds a change keeps all but what it names', async () => {
  let count = 0;
  for (const [file, text] of await worlds()) {
    const world = model(text);
    if (isFault(world)) continue;
    for (const { key, kind, values } of world.items) {
      const [first] = kind.attributes.filter(({ name, within }) => values.has(name) && !within);
      if (!first) continue;
      const before = values.text(first.name);
      const there = changed(world, key, { [first.name]: '4711' });
      expect(there.length, `${file}: ${key}`).toBe(before === '4711' ? 0 : 1);
      const [{ from, to } = { from: 0, to: 0 }] = there;
      const after = spliced(text, there);
      expect(after.length).toBe(text.length - (to - from) + 4);
      expect(after.startsWith(text.slice(0, from)) && after.endsWith(text.slice(to)), file).toBe(true);
      expect(read(after)).not.toHaveProperty('fault');
      // What it says already is not written anew.
      expect(spliced(text, changed(world, key, { [first.name]: before }))).toBe(text);
    }
    count += 1;
  }
  expect(count).toBeGreaterThan(100);
});
