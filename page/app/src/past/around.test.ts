import { expect, it } from 'vitest';
import type { Line } from '../robot/recording';
import { scene, state } from '../world/example';
import { aroundOf, PastWorld, sceneOf, stateOf } from './around.svelte';
import { channel, file, joined, line, record, schema, text, u32, u64 } from './example';
import { readNow } from './read';

const told = (time: number, x: number, more: object = {}): Line => {
  const robot = { ...state().robots[0], at: [x, 0, 0], ...more };
  const words = JSON.stringify({ ...state(), robots: [robot] });
  return { topic: '/world', time, level: 20, name: 'world', text: words, errno: 0 };
};

const scenes = (...times: number[]) =>
  times.map((time) => ({ time, text: JSON.stringify({ ...scene(), start: [time, 0, 0] }) }));

it('a moment has the place and the way until then, forward and back', () => {
  let now = 0;
  const places = [told(1, 0), told(2, 0.1), told(3, 0.2), told(4, 0.3)];
  const world = new PastWorld({ scenes: scenes(2), places }, () => now);
  const at = (time: number) => {
    now = time;
    world.look();
    const ways = world.trail.ways[0]?.points.filter((_, index) => index % 2 === 0);
    return [world.state?.robots[0]?.at[0], ways];
  };
  // The recorder finds it a moment later.
  expect(at(0)).toEqual([0, [0]]);
  expect(at(3.5)).toEqual([0.2, [0, 0.1, 0.2]]);
  expect(world.scene?.start).toEqual([2, 0, 0]);
  expect(at(9)).toEqual([0.3, [0, 0.1, 0.2, 0.3]]);
  expect(at(2)).toEqual([0.1, [0, 0.1]]);
});

it('another world begins where it was loaded, without the marks of the one before', () => {
  let now = 5;
  const places = [told(1, 0, { marker: '#f00' }), told(2, 0.1, { marker: '#f00' }), told(5, 1)];
  const world = new PastWorld({ scenes: scenes(1, 4), places }, () => now);
  world.look();
  expect([world.scene?.start[0], world.trail.marks.length]).toEqual([4, 0]);
  now = 2;
  world.look();
  expect([world.scene?.start[0], world.trail.marks.length]).toEqual([1, 1]);
});

it('nothing of what was told is believed', () => {
  for (const rubbish of [undefined, null, 1, [], {}, { robots: 1 }, { bounds: [0, 0] }]) {
    expect(stateOf(rubbish)).toBeUndefined();
    expect(sceneOf(rubbish)).toBeUndefined();
  }
  expect(sceneOf({ bounds: [1, 0, 0, 1] })).toBeUndefined();
  const wild = { robots: [{ at: ['x', null], read: [NaN, 'a', 1] }, 5], things: [[1], 'b'], led: 'blue' };
  const read = stateOf(wild);
  expect(read?.robots).toEqual([
    { at: [0, 0, 0], read: [null, null, 1], rays: [], stuck: false, marker: '' },
  ]);
  expect(read?.things).toEqual([
    [1, 0, 0],
    [0, 0, 0],
  ]);
  expect(read?.led).toBe('');
  const items = [{ is: 'wall', points: [1, 'x'], stroke: 7 }, { is: 'script' }, 3];
  const shown = sceneOf({
    bounds: [0, 0, 1, 1],
    items,
    things: [{ is: 'bomb' }],
    fields: true,
    devices: [1],
  });
  expect(shown?.items).toEqual([
    { is: 'wall', points: [1, 0], stroke: '', width: 0, dash: [], alpha: 1, text: '' },
  ]);
  expect([shown?.things[0]?.is, shown?.fields, shown?.devices]).toEqual(['ball', false, []]);
  const broken = new PastWorld({ scenes: [{ time: 0, text: '{' }], places: [told(1, 0)] }, () => 1);
  broken.look();
  expect(broken.scene?.items).toEqual([]);
});

it('a recording has its world as a file beside it and as lines that no view lists', () => {
  const type = 'uint8 level\nstring name\nstring msg\nstring file\nstring function\nuint32 line';
  const attached = (name: string, time: number, words: string) => {
    const data = new TextEncoder().encode(words);
    const named = [text(name), text('application/json')];
    return record(9, u64(time * 1e9), u64(0), ...named, u64(data.length), data, u32(0));
  };
  const bytes = file(
    schema(1, type),
    channel(1, 1, '/world', {}),
    channel(2, 1, '/log', {}),
    attached('world.json', 1, JSON.stringify(scene())),
    attached('other.json', 1, 'x'),
    line(2, 1, 'trikfs', 'begins'),
    line(1, 2, 'world', JSON.stringify(state())),
  );
  const { memory, wrong } = readNow(joined(bytes));
  expect(wrong).toBeUndefined();
  expect(memory.lines.map(({ text }) => text)).toEqual(['begins']);
  expect(memory.scenes.map(({ time }) => time)).toEqual([1]);
  const around = aroundOf(memory, new Map(), () => 9);
  around?.look();
  expect([around?.scene?.bounds, around?.state?.robots[0]?.at]).toEqual([scene().bounds, [1, 1, 370]]);
  expect(aroundOf({ scenes: [], places: [] }, new Map(), () => 0)).toBeUndefined();
});
