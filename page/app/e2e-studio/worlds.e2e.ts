// The world editor's tables beside what reads worlds: all that it makes is understood, all that it names is documented, and of all
// real worlds a change keeps all letters but those that it names.

import { existsSync, readFileSync, readdirSync } from 'node:fs';
import { join } from 'node:path';
import { expect, test } from 'vitest';
import { KINDS, SETTINGS } from '../src/studio/world/kinds';
import { SENSORS, sensorPort } from '../src/studio/world/sensors';
import { NEW_WORLD, added, changed, isFault, model, withSensor } from '../src/studio/world/model';
import { RECIPES, RULES, type RuleElement, elementsOf, madeOf, recipe } from '../src/studio/world/rules';
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

test.skipIf(!existsSync(DATA) && process.env['TRIK_REQUIRE_DATA'] !== '1')(
  'of real worlds a change keeps all but what it names',
  async () => {
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
  },
);

/** The world with other rules, or with something more in it. */
function opened(text: string) {
  const world = model(text);
  if (isFault(world)) throw new Error(world.fault);
  return world;
}

/** What is wrong with a world, but for what a teacher has still to do. */
async function mistakes(text: string): Promise<string[]> {
  const found = (await library()).lint('world.xml', new TextEncoder().encode(text));
  if (!found.ok) throw new Error(found.error.problems[0]?.message);
  return found.value.filter(({ level }) => level === 'error').map(({ message }) => message);
}

test('all that is added to a world is understood', async () => {
  let text = NEW_WORLD;
  for (const kind of KINDS.filter(
    ({ creation }) => creation && creation !== 'robot' && creation !== 'start',
  )) {
    text = spliced(text, added(opened(text), kind, [0, 0], [100, 60]).splices);
  }
  for (const [at, { type, ports }] of SENSORS.entries()) {
    const port = ports[at % ports.length];
    if (port) text = spliced(text, withSensor(opened(text), 'robot 0', type, sensorPort(port)));
  }
  const found = (await library()).lint('world.xml', new TextEncoder().encode(text));
  if (!found.ok) throw new Error(found.error.problems[0]?.message);
  expect(found.value.map(({ message }) => message)).toEqual([]);
});

test('each rule that the forms make is understood', async () => {
  const world = NEW_WORLD.replace(
    '<regions/>',
    '<regions><region id="goal" x="0" y="0" width="9" height="9"/></regions>',
  );
  const within = (rules: string): string =>
    world.replace('</root>', `<constraints><timelimit value="60000"/>${rules}</constraints></root>`);
  const event = (condition: string, trigger: string): string =>
    `<event id="goal" settedUpInitially="true">${condition}${trigger}</event>`;
  const done = '<trigger><success/></trigger>';
  const whole = (element: RuleElement): string => {
    const made = madeOf(element, 'goal');
    const [group] = element.groups;
    switch (group) {
      case 'top':
        return element.tag === 'timelimit' ? '' : made;
      case 'conditionOf':
        return event(made, done);
      case 'triggerOf':
        return event('<condition><true/></condition>', made);
      case 'condition':
        return event(`<condition>${made}</condition>`, done);
      case 'trigger':
        return event('<condition><true/></condition>', `<triggers>${made}</triggers>`);
      case 'value':
        return event(`<condition><equals>${made}${made}</equals></condition>`, done);
      case 'return':
        return event(`<condition><using><setter name="x" _1="1"/>${made}</using></condition>`, done);
      default:
        return event(
          '<condition><true/></condition>',
          `<trigger><message text="%x%">${made}</message></trigger>`,
        );
    }
  };
  for (const element of RULES) expect(await mistakes(within(whole(element))), element.tag).toEqual([]);
  for (const name of RECIPES)
    expect(await mistakes(within(recipe(name, 'goal', 'a', 'text'))), name).toEqual([]);
  expect(elementsOf('value').length).toBeGreaterThan(10);
});

test('each attribute of the forms is one of a world', () => {
  const docs = readFileSync(join(import.meta.dirname, '../../../docs/teacher/world.md'), 'utf8');
  const sections = docs.split('\n### ').map((section) => section.split('\n## ')[0] ?? '');
  const of = (path: string): string =>
    sections.find((section) => section.split('\n')[0]?.includes(`\`${path}\``)) ?? '';
  const names = (path: string): string[] =>
    of(path)
      .split('\n')
      .filter((row) => row.startsWith('| `'))
      .flatMap((row) => [...(row.split('|')[1] ?? '').matchAll(/`([^`]+)`/g)].map(([, name]) => name ?? ''));
  for (const kind of KINDS) {
    const path = kind.name === 'sensor' ? 'sensors/sensor' : `${kind.list}/${kind.tag}`;
    for (const { name, within } of kind.attributes)
      expect(names(within ? `robot/${within}` : path), `${path} ${name}`).toContain(name);
  }
  for (const { name } of SETTINGS) expect(names('root/settings')).toContain(name);
});
