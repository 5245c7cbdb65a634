// What most tests in a browser begin and end with: a robot and a browser, for all tests of a file.

import { afterAll, beforeAll } from 'vitest';
import { Look, Robot } from './robot.js';

/**
 * They are there once the tests begin.
 * @param {string[]} args further options of `trik up`
 */
export function scene(...args) {
  const there = {
    robot: /** @type {Robot} */ (/** @type {unknown} */ (null)),
    look: /** @type {Look} */ (/** @type {unknown} */ (null)),
  };
  beforeAll(async () => {
    there.robot = await Robot.start(...args);
    there.look = await Look.start();
  });
  afterAll(async () => {
    await there.look?.end();
    await there.robot?.end();
  });
  return there;
}
