import { expect, it } from 'vitest';
import type { Timeline } from '../robot/history';
import type { Fields } from '../robot/recording';
import type { Known } from '../robot/robot.svelte';
import { Ground, saysWhere } from './ground.svelte';
import { directionOf, poseOf, rangerOf } from './mount';

const node = (path: string, format: string, units: string, ...aliases: string[]) => ({
  path,
  format,
  units,
  about: '',
  aliases,
  isWritten: false,
  rest: '',
});

/** A node that has these samples, one in each second. */
function known(of: ReturnType<typeof node>, ...samples: Fields[]): Known {
  const names = Object.keys(samples[0] ?? {});
  const line = (name: string): Timeline => ({
    since: (time) => {
      const from = Math.max(0, Math.floor(time));
      const values = samples.slice(from).map((fields) => Number(fields[name]));
      return { times: values.map((_, at) => from + at), values };
    },
  });
  const histories = new Map(names.map((name) => [name, line(name)]));
  return { node: of, fields: samples.at(-1), count: samples.length, time: 0, fault: '', histories };
}

const odometry = node('odometry', 'f32 x, f32 y, f32 heading', '');

it('nodes that say a place or a distance are known by names and units', () => {
  expect(poseOf(odometry)?.x).toEqual({ name: 'x', factor: 0.001 });
  expect(poseOf(node('pose', 'f64 x, f64 y, f64 theta', 'm, rad'))?.heading.factor).toBeCloseTo(57.3, 1);
  expect(poseOf(node('accelerometer', 'f32 x, f32 y, f32 z', 'mg'))).toBeUndefined();
  expect(poseOf(node('odometry', 'f32 x, f32 y, f32 heading', 'deg, mm'))).toBeUndefined();
  expect(poseOf(node('odometry', 'f32 x, f32 y, f32 heading', 'toString, deg'))).toBeUndefined();
  expect(poseOf(node('pose', 'f32 x, f32 y, f32 heading', ''))).toBeUndefined();
  expect(poseOf(node('pose', 'f32 x, f32 y, f32 heading', 'mm, mm, deg'))?.y.factor).toBe(0.001);
  const left = rangerOf(node('sensors/D2', 'u16 distance', 'cm', 'sensors/left'));
  expect(left?.sensor).toMatchObject({ is: 'sonar', port: 'D2', degrees: 90, reach: 4 });
  const front = rangerOf(node('sensors/A1', 'u16 distance', 'cm', 'sensors/front_infrared'));
  expect(front?.sensor).toMatchObject({ is: 'infrared', degrees: 0, reach: 1 });
  expect(rangerOf(node('sensors/A5', 'u16 brightness', '%'))).toBeUndefined();
  const scan = Array.from({ length: 8 }, (_, at) => `u16 d${at}`).join(', ');
  expect(rangerOf(node('lidar', scan, 'mm'))?.sensor.is).toBe('lidar');
  expect(rangerOf(node('lidar', scan, '%'))).toBeUndefined();
});

it('names say where a sensor looks', () => {
  const looks = (...names: string[]) => directionOf(names);
  expect([looks('d1'), looks('d1', 'left'), looks('front_right'), looks('rear')]).toEqual([0, 90, -45, 180]);
  expect([looks('back_left'), looks('leftover'), looks('ir-right-2')]).toEqual([135, 0, -90]);
});

it('the way of a robot goes on, and begins anew at an earlier moment', () => {
  const places = [0, 100, 200, 300].map((x) => ({ x, y: 0, heading: 90 }));
  const nodes = new Map([['odometry', known(odometry, ...places)]]);
  let now = 3.5;
  const ground = new Ground(
    () => nodes,
    () => now,
  );
  expect(saysWhere(nodes)).toBe(true);
  ground.look();
  expect(ground.state?.robots[0]?.at).toEqual([0.3, 0, 90]);
  const ways = () => ground.trail.ways[0]?.points.filter((_, at) => at % 2 === 0);
  expect(ways()).toEqual([0, 0.1, 0.2, 0.3]);
  ground.look();
  expect(ways()).toEqual([0, 0.1, 0.2, 0.3]);
  now = 1.5;
  ground.look();
  expect(ways()).toEqual([0, 0.1]);
});

it('beams are what sensors see, and none where they see nothing or have failed', () => {
  const sonar = (path: string, cm: number) => known(node(path, 'u16 distance', 'cm'), { distance: cm });
  const names = Array.from({ length: 8 }, (_, at) => `d${at}`);
  const format = names.map((name) => `u16 ${name}`).join(', ');
  const scan = Object.fromEntries(names.map((name, at) => [name, at * 1000]));
  const broken = sonar('sensors/D3', 50);
  broken.fault = 'unplugged';
  const nodes = new Map([
    ['odometry', known(odometry, { x: 0, y: 0, heading: 0 })],
    ['sensors/D1', sonar('sensors/D1', 150)],
    ['sensors/D2', sonar('sensors/D2', 0)],
    ['sensors/D3', broken],
    ['lidar', known(node('lidar', format, 'mm'), scan)],
  ]);
  const ground = new Ground(
    () => nodes,
    () => 1,
  );
  ground.look();
  expect(ground.scene?.robots[0]?.sensors.map(({ port }) => port)).toEqual(['D1', 'D2', 'D3', 'lidar']);
  expect(ground.state?.robots[0]?.read).toEqual([1.5, null, null, null]);
  expect(ground.state?.robots[0]?.rays).toEqual([null, 7, 6, 5, 4, 3, 2, 1]);
  expect(ground.state?.faults).toEqual({ D3: 'unplugged' });
});

it('the picture grows with the way, and a place that was lost draws nothing', () => {
  const at = { x: 0, y: 0, heading: 0 };
  const robot = known(odometry, at);
  const nodes = new Map([['odometry', robot]]);
  const ground = new Ground(
    () => nodes,
    () => 1,
  );
  ground.look();
  expect(ground.scene?.bounds).toEqual([-1.5, -1, 1.5, 1]);
  Object.assign(robot, { fields: { ...at, x: 2500 }, count: 2 });
  ground.look();
  expect(ground.scene?.bounds).toEqual([-1.5, -1, 3, 1]);
  Object.assign(robot, { fields: { ...at, x: 1e9 }, count: 3 });
  ground.look();
  expect(ground.state?.robots[0]?.at[0]).toBe(2.5);
  expect(ground.scene?.bounds).toEqual([-1.5, -1, 3, 1]);
});
