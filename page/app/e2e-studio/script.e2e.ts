// A person writes programs in JavaScript and Python, runs them, and goes through what they have done.

import { existsSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import type { Page } from 'playwright-core';
import { expect, test } from 'vitest';
import { barriers, eventually } from '../e2e/robot.js';
import { begin, button } from './begin';
import { SITE } from './site';

const here = begin();

/** The robot has to be 100 pixels ahead within two seconds. */
const WORLD = `<root version="20251219"><world><regions>
<region id="there" type="rectangle" x="100" y="-200" width="5000" height="500"/></regions>
<robot position="0:0" direction="0"/></world>
<robots><robot id="trikKitRobot"/></robots><settings/>
<constraints><timelimit value="2000"/>
<event settedUpInitially="true"><condition><inside objectId="robot1" regionId="there"/></condition>
<trigger><success/></trigger></event></constraints></root>`;

/** All texts that the browser keeps. */
const KEPT = `new Promise((done) => {
  const opened = indexedDB.open('trik-studio', 1);
  opened.onsuccess = () => {
    const all = opened.result.transaction('projects').objectStore('projects').getAll();
    all.onsuccess = () => {
      opened.result.close();
      done(all.result.map(({ bytes }) => new TextDecoder().decode(bytes)).join('\\n'));
    };
  };
})`;

const verdict = (page: Page) => page.locator('.verdict');

/** Opens a program, and runs it as fast as it goes. */
async function run(page: Page, name: string, text: string, world?: string): Promise<void> {
  await page.locator('input[type=file][accept*=".py"]').setInputFiles({
    name,
    mimeType: 'text/plain',
    buffer: Buffer.from(text),
  });
  await page.getByRole('heading', { name }).waitFor();
  if (world !== undefined) {
    await page.locator('input[type=file][accept=".xml,.qrs"]').setInputFiles({
      name: 'world.xml',
      mimeType: 'text/xml',
      buffer: Buffer.from(world),
    });
    await page.getByText('World: world.xml').waitFor();
  }
  await page.getByLabel('Speed').selectOption('fastest');
  await button(page, 'Run').click();
}

async function opened(): Promise<Page> {
  const page = await here.open();
  await page.getByRole('button', { name: 'New in JavaScript' }).waitFor();
  return page;
}

const DRIVE = `var main = function() {
  brick.motor(M3).setPower(100);
  brick.motor(M4).setPower(100);
  print('on my way ', [1, 2]);
  script.wait(5000);
}`;

test('a program in JavaScript solves a task, and can be gone through backwards', async () => {
  const page = await opened();
  await run(page, 'drive.js', DRIVE, WORLD);
  await verdict(page).filter({ hasText: 'The task is done' }).waitFor();
  await page.getByText('on my way [1, 2]').waitFor();
  expect(await barriers(page)).toEqual([]);
  const moment = page.getByLabel('Moment');
  const last = Number(await moment.getAttribute('max'));
  expect(last).toBeGreaterThan(20);
  await moment.fill('3');
  await eventually('a moment is shown', async () =>
    /0\.\d+ s/.test((await page.locator('.moment').textContent()) ?? ''),
  );
  expect(await verdict(page).count()).toBe(0);
  await moment.fill(String(last));
  await verdict(page).waitFor();
  await page.close();
});

test('a mistake stands at its line', async () => {
  const page = await opened();
  await run(page, 'wrong.js', 'var a = 1;\nfunction f() {\n  nothing.at(all);\n}\nf();\n');
  await page.getByRole('button', { name: 'Line 3' }).waitFor();
  await page.locator('.lines .error', { hasText: 'ReferenceError: nothing is not defined' }).waitFor();
  await run(page, 'torn.js', 'print(1);\nvar = 2;\n');
  await page.getByRole('button', { name: 'Line 2' }).waitFor();
  await run(page, 'threads.js', '\nThreading.startThread("a", function() {});\n');
  await page.getByRole('button', { name: 'Line 2' }).waitFor();
  await page.getByText('a program has one thread in the browser').first().waitFor();
  await page.close();
});

// What a program must not reach, and what must not end the page.
const REACH = `
var names = ['fetch', 'XMLHttpRequest', 'WebSocket', 'importScripts', 'indexedDB', 'postMessage', 'navigator', 'caches', 'Worker'];
print(names.filter(function(name) { return typeof globalThis[name] !== 'undefined' || name in globalThis; }).join() || 'nothing');
try { eval('1'); print('eval'); } catch (error) { print('no eval'); }
try { new Function('return 1')(); print('Function'); } catch (error) { print('no Function'); }
Object.prototype.then = function() { throw 1; };
brick.ask = undefined; script.wait(30); print(typeof brick.motor);
`;

test('a program reaches nothing but its robot', async () => {
  const page = await opened();
  await run(page, 'reach.js', REACH);
  for (const text of ['nothing', 'no eval', 'no Function', 'function'])
    await page
      .locator('.lines li', { hasText: new RegExp(`${text}\\s*$`) })
      .first()
      .waitFor();
  // What closes the function around a program is a mistake of its text.
  await run(page, 'out.js', 'print(1);\n}; fetch("/"); {\n');
  await page.getByRole('button', { name: 'Line 2' }).waitFor();
  here.look.complaints.splice(0);
  await page.close();
});

const HOSTILE: [name: string, text: string, seen: RegExp][] = [
  ['endless.js', 'while (true) {}', /computed for 10 s/],
  ['deep.js', 'function f() { return f() + 1; }\nf();', /RangeError: Maximum call stack/],
  ['asks.js', 'while (true) brick.battery().readVoltage();', /stopped after 600 s/],
  ['stubborn.js', 'while (true) { try { script.wait(100000); } catch (e) {} }', /stopped after 600 s/],
  [
    'loud.js',
    'var s = "x".repeat(1000000); for (var i = 0; i < 50; i++) print(s); print("quiet");',
    /The program has ended/,
  ],
  ['long.js', `var text = '${'x'.repeat(1_000_000)}';\nprint(text.length);`, /1000000/],
  [
    'thrown.js',
    'script.timer(10).timeout.connect(function() { throw { toString: function() { throw 1; } }; });\nscript.run();',
    /no text/,
  ],
  [
    'poison.js',
    'Array.prototype.push = Map.prototype.get = function() { throw new Error("poison"); };\nscript.wait(100);\nprint(1);',
    /poison|computed for 10 s/,
  ],
  ['lost.js', 'new Promise(function(_, no) { no(new Error("lost")); });\nscript.wait(10);', /Error: lost/],
];

test.each(HOSTILE)('%s ends, and the page says why', async (name, text, seen) => {
  const page = await opened();
  await run(page, name, text);
  await page.locator('.said, .lines').filter({ hasText: seen }).first().waitFor({ timeout: 90_000 });
  await button(page, 'Run').waitFor();
  await page.close();
});

const HAS_PYTHON = existsSync(join(SITE, 'python/pyodide.mjs'));

test('what a program has done before it computes for ever is seen', async () => {
  const page = await opened();
  await run(page, 'before.js', 'print("before");\nscript.wait(100);\nprint("after");\nwhile (true) {}\n');
  await page.getByText('computed for 10 s').first().waitFor();
  for (const line of ['before', 'after'])
    await page.locator('.lines li').filter({ hasText: line }).first().waitFor();
  await page.close();
});

test('a program does not write its own verdict, and strict ones fail at their line', async () => {
  const page = await opened();
  const forged =
    'var p = JSON.parse;\nJSON.parse = function (t) { var v = p(t); if (v && v.verdict) v.totalScore = 9999; return v; };\nscript.wait(50);\n';
  await run(page, 'forged.js', forged);
  await page.locator('.verdict').waitFor();
  expect(await page.locator('.verdict').innerText()).not.toContain('9999');
  await run(page, 'strict.js', '"use strict";\nvar a = 1;\nvar b = 010;\n');
  await page.getByRole('button', { name: 'Line 3' }).waitFor();
  await page.close();
});

test.skipIf(!HAS_PYTHON && process.env['TRIK_REQUIRE_TOOLS'] !== '1')(
  'a program in Python runs, asks and fails at its line',
  async () => {
    const page = await opened();
    const drive = `name = input('who? ')\nprint('hello', name)\nbrick.motor(M3).setPower(100)\nbrick.motor(M4).setPower(100)\nscript.wait(5000)\n`;
    await page.locator('input[type=file][accept*=".py"]').setInputFiles({
      name: 'drive.py',
      mimeType: 'text/plain',
      buffer: Buffer.from(drive),
    });
    await page.getByLabel('Answers to input()').fill('Ada');
    await page.locator('input[type=file][accept=".xml,.qrs"]').setInputFiles({
      name: 'world.xml',
      mimeType: 'text/xml',
      buffer: Buffer.from(WORLD),
    });
    await page.getByText('World: world.xml').waitFor();
    await page.getByLabel('Speed').selectOption('fastest');
    await button(page, 'Run').click();
    await verdict(page).filter({ hasText: 'The task is done' }).waitFor({ timeout: 120_000 });
    await page.getByText('hello Ada').waitFor();
    await run(page, 'wrong.py', 'print(1)\nscript.wait(20)\nnothing\n');
    await page.getByRole('button', { name: 'Line 3' }).waitFor({ timeout: 120_000 });
    await run(page, 'threads.py', 'import threading\nthreading.Thread(target=print).start()\n');
    await page.getByText('a program has one thread in the browser').first().waitFor({ timeout: 120_000 });
    const reach = `import js\nprint([n for n in ['fetch', 'XMLHttpRequest', 'WebSocket', 'postMessage'] if hasattr(js, n) and getattr(js, n)] or 'nothing')\n`;
    await run(page, 'reach.py', reach);
    await page.locator('.lines li', { hasText: 'nothing' }).waitFor({ timeout: 120_000 });
    await page.close();
  },
);

test('without Python the studio says how it comes', async () => {
  const page = await opened();
  // As on a site that was built without it.
  await page.route('**/python/**', (route) => route.fulfill({ status: 404 }));
  await run(page, 'drive.py', 'print(1)\n');
  await page.getByText('web/site.sh --python').waitFor();
  here.look.complaints.splice(0);
  await page.close();
});

test('a program that is not saved is there when the page is opened again, and is saved as it is', async () => {
  const page = await opened();
  await page.getByRole('button', { name: 'New in JavaScript' }).click();
  await page.getByRole('heading', { name: 'program.js' }).waitFor();
  const editor = page.locator('.cm-content');
  await editor.click();
  await page.keyboard.press('Control+Home');
  await page.keyboard.type('// mine\n');
  await page.getByText('not saved').waitFor();
  await eventually('the browser keeps it', async () => String(await page.evaluate(KEPT)).includes('// mine'));
  page.once('dialog', (dialog) => void dialog.accept());
  await page.reload();
  await page.locator('.cm-content', { hasText: '// mine' }).waitFor();
  const download = page.waitForEvent('download');
  await button(page, 'Save').click();
  const file = await download;
  expect(file.suggestedFilename()).toBe('program.js');
  expect(readFileSync(await file.path(), 'utf8')).toContain('// mine\nbrick.motor(M3)');
  await button(page, 'New').click();
  await page.locator('.svelte-flow').waitFor();
  await page.close();
});
