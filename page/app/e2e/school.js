// A small class for the page of marks: a task with two fields, pupils whose programs do well, badly and for ever.
//
// Owns its files.

import { copyFileSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { newTask } from './robot.js';

/** A name that a page could obey. */
export const HOSTILE = '<img src=x onerror=alert(1)>';

/**
 * Makes one below a folder, and gives the words for `trik check`.
 * @param {string} folder
 * @param {Record<string, string>} pupils the program of each: `good`, `bad`, none, or a text in Python
 */
export function school(folder, pupils) {
  newTask(folder, 'made');
  const tasks = join(folder, 'tasks', 'road');
  mkdirSync(tasks, { recursive: true });
  const world = readFileSync(join(folder, 'made', 'world.xml'), 'utf8');
  /** @param {string} name @param {number} ms */
  const field = (name, ms) => {
    const limit = `<timelimit value="${ms}"`;
    writeFileSync(join(tasks, name), world.replace(/<timelimit value="\d+"/, limit));
  };
  field('long.xml', 3_000_000);
  // Nobody is so fast.
  field('rush.xml', 500);
  for (const [pupil, program] of Object.entries(pupils)) {
    const own = join(folder, 'pupils', pupil);
    mkdirSync(own, { recursive: true });
    if (program === 'good') copyFileSync(join(folder, 'made', 'solution.js'), join(own, 'road.js'));
    else if (program === 'bad') copyFileSync(join(folder, 'made', 'wrong.js'), join(own, 'road.js'));
    else if (program !== '') writeFileSync(join(own, 'road.py'), program);
  }
  return ['pupils', '--tasks', 'tasks', '--points', 'accomplished', '--jobs', '2'];
}

/** A program that computes without end. */
export const ENDLESS = 'while True:\n    pass\n';
