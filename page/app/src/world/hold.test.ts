import { expect, test } from 'vitest';
import { scene, state } from './example';
import { carry, holdAt, putRobot, putThing, within } from './hold';

test('a finger takes what is below it and carries it by the same place', () => {
  const held = holdAt(scene(), state(), [1.05, 1], 200);
  expect(held?.is).toBe('robot');
  expect(held && carry(held, [2.05, 0.5])).toBe('robot 2 0.5 10');
  const thing = holdAt(scene(), state(), [2.02, 1], 200);
  expect(thing && carry(thing, [0.52, 0.25])).toBe('thing 0 0.5 0.25');
  expect(holdAt(scene(), state(), [0.2, 0.2], 200)).toBeUndefined();
});

test('a small thing on the robot is nearer than the robot', () => {
  const world = state();
  world.things = [[1, 1, 0]];
  expect(holdAt(scene(), world, [1, 1], 200)?.is).toBe('robot');
  expect(holdAt(scene(), world, [1.2, 1], 200)).toBeUndefined();
});

test('what a teacher has locked is taken by nobody', () => {
  const locked = scene();
  locked.locked = { world: true, robot: true };
  expect(holdAt(locked, state(), [1, 1], 200)).toBeUndefined();
  expect(holdAt(locked, state(), [2, 1], 200)).toBeUndefined();
});

test('a world without a robot and things has nothing to take', () => {
  const empty = state();
  empty.robots = [];
  empty.things = [];
  expect(holdAt(scene(), empty, [1, 1], 200)).toBeUndefined();
});

test('headings are within half a turn, and orders have no long numbers', () => {
  expect(within(370)).toBe(10);
  expect(within(-725)).toBe(-5);
  expect(within(190)).toBe(-170);
  expect(putRobot([0.1 + 0.2, 0, 190])).toBe('robot 0.3 0 -170');
  expect(putThing(3, [1 / 3, -1e-9, 0])).toBe('thing 3 0.3333 0');
});
