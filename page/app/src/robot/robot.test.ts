import { afterEach, beforeEach, expect, test, vi } from 'vitest';
import type { Line, Node } from './recording';
import { Robot } from './robot.svelte';

beforeEach(() => {
  vi.stubGlobal('requestAnimationFrame', () => 0);
  // It never opens.
  vi.stubGlobal('WebSocket', Object.assign(vi.fn(), { OPEN: 1 }));
  vi.stubGlobal('fetch', () => Promise.reject(new Error('there is no server')));
});
afterEach(() => vi.unstubAllGlobals());

const node = (path: string, format: string): Node => ({
  path,
  format,
  units: '',
  about: '',
  aliases: [],
  isWritten: false,
  rest: '',
});
const odometry = node('odometry', 'f32 x, f32 y, f32 heading');
const fault = (path: string, errno: number): Line => ({
  topic: '/faults',
  time: 1,
  level: 40,
  name: `/${path}`,
  text: 'why',
  errno,
});

test('a node that has left the tree is there no more, and with it the place that it has told', () => {
  const robot = new Robot('ws://robot/');
  robot.node(node('A1', 'i32 distance'));
  robot.node(odometry);
  expect(robot.around?.isGround).toBe(true);
  robot.line(fault('odometry', 19));
  expect(robot.paths).toEqual(['A1', 'odometry']);
  robot.line(fault('odometry', 116));
  expect(robot.paths).toEqual(['A1']);
  expect(robot.around).toBeUndefined();
  robot.node(odometry);
  expect(robot.around?.isGround).toBe(true);
});

test('a robot that comes back with another tree has the nodes of that one', () => {
  const robot = new Robot('ws://robot/');
  const returns = () => robot.news({ is: 'robot', there: true, why: null });
  robot.node(node('A1', 'i32 distance'));
  robot.node(odometry);
  robot.sample('A1', 1, { distance: 5 });
  returns();
  robot.node(node('A1', 'i32 distance'));
  robot.node(node('A2', 'i32 distance'));
  // What was there is shown until the new tree has told of all.
  expect(robot.paths).toEqual(['A1', 'A2', 'odometry']);
  robot.sample('A1', 2, { distance: 6 });
  expect(robot.paths).toEqual(['A1', 'A2']);
  expect(robot.around).toBeUndefined();
  expect(robot.nodes.get('A1')?.histories.get('distance')?.since(0).values).toEqual([5, 6]);
  robot.sample('A1', 3, { distance: 7 });
  expect(robot.paths).toEqual(['A1', 'A2']);
});

test('the log says in a sentence why a value was refused, before the refusal or after it', () => {
  const robot = new Robot('ws://robot/');
  const log = (text: string) => robot.line({ ...fault('', 0), topic: '/log', name: 'trikfs', text });
  const refuses = (param: string | null) =>
    robot.news({ is: 'written', path: 'motors/M3', param, value: '7', why: 'out of range' });
  log('[     0.518] motors/M3: caller: power is -100 to 100, not 700');
  refuses(null);
  expect(robot.refused.get('motors/M3')).toBe('power is -100 to 100, not 700');
  log('[     9.000] motors/M3: device: gone');
  log('[     9.000] motors/M3: caller: power is -100 to 100, not 7');
  expect(robot.refused.get('motors/M3')).toBe('power is -100 to 100, not 7');
  robot.inside.choose('motors/M3');
  refuses('alpha');
  log('[     9.000] motors/M3: params/alpha stays as it is: no');
  expect(robot.inside.wrong).toEqual({ alpha: 'params/alpha stays as it is: no' });
  log('no line of a node: caller: params/alpha');
  expect(robot.inside.wrong).toEqual({ alpha: 'params/alpha stays as it is: no' });
});
