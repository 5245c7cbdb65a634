import { describe, expect, test } from 'vitest';
import type { Node } from '../robot/recording';
import type { Desk } from './desk.svelte';
import { Driver } from './driver.svelte';
import type { Setup } from './setup';

const MOTOR: Node = {
  path: 'motors/M3',
  format: 'i8 duty_cycle',
  units: '%',
  about: '',
  aliases: [],
  isWritten: true,
  rest: '0',
};
const SETUP: Setup = {
  left: MOTOR.path,
  right: '',
  leftTurned: false,
  rightTurned: false,
  x: '',
  y: '',
  buttons: [],
  power_percent: 60,
};

/** A driver whose orders are kept, at a desk that may be told why it moves nothing. */
function driving() {
  const said: string[] = [];
  const robot = {
    nodes: new Map([[MOTOR.path, { node: MOTOR }]]),
    isOthers: false,
    stop: () => said.push('stop'),
  };
  const desk = {
    why: '',
    robot,
    orders: { put: (path: string, value: string) => said.push(`${path} ${value}`) },
    rest: (path: string) => said.push(`${path} rests`),
  };
  const driver = new Driver(desk as unknown as Desk, () => SETUP);
  return { desk, robot, said, driver };
}

describe('what was held when it cannot be moved any more', () => {
  test('rests by its own order while there is control', () => {
    const { driver, said } = driving();
    driver.drive({ x: 0, y: 1 });
    driver.release('first');
    expect(said).toEqual(['motors/M3 60', 'motors/M3 rests']);
  });

  test('rests by a stop from the past', () => {
    const { desk, driver, said } = driving();
    driver.drive({ x: 0, y: 1 });
    desk.why = 'this is the past';
    driver.release('first');
    expect(said).toEqual(['motors/M3 60', 'stop']);
  });

  test('does not halt whoever has taken the control', () => {
    const { desk, robot, driver, said } = driving();
    driver.drive({ x: 0, y: 1 });
    robot.isOthers = true;
    desk.why = 'somebody else is in control';
    driver.release('first');
    driver.release('first');
    expect(said).toEqual(['motors/M3 60']);
  });
});
