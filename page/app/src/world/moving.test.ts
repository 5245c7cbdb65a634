import { expect, test, vi } from 'vitest';
import { scene, state } from './example';
import { Gesture } from './gesture';
import { loadOrder } from './load';
import { Paced, PERIOD_MS } from './paced';
import { Trail } from './trail';

test('a way has gaps where a hand has carried the robot, and no more points than it needs', () => {
  const trail = new Trail();
  const world = state();
  for (const x of [1, 1.0001, 1.1, 1.2, 2.5]) {
    world.robots = [{ at: [x, 1, 0], read: [], rays: [], stuck: false, marker: '' }];
    trail.put(world);
  }
  expect(trail.ways[0]?.points).toEqual([1, 1, 1.1, 1, 1.2, 1, NaN, NaN, 2.5, 1]);
  trail.clear();
  expect(trail.ways).toEqual([]);
});

test('a way does not grow for ever', () => {
  const trail = new Trail();
  const world = state();
  for (let step = 0; step < 50_000; step++) {
    world.robots = [{ at: [step * 0.01, 0, 0], read: [], rays: [], stuck: false, marker: '' }];
    trail.put(world);
  }
  expect(trail.ways[0]?.points.length).toBeLessThanOrEqual(40_002);
});

test('a marker leaves a line of its colour until it is up or the scene is told anew', () => {
  const trail = new Trail();
  const world = state();
  const draw = (x: number, marker: string) => {
    world.robots = [{ at: [x, 0, 0], read: [], rays: [], stuck: false, marker }];
    trail.put(world);
  };
  draw(0, '#ff0000');
  draw(0.1, '#ff0000');
  draw(0.15, '');
  draw(0.2, '#0000ff');
  draw(0.3, '#0000ff');
  expect(trail.marks).toEqual([
    { points: [0, 0, 0.1, 0], colour: '#ff0000' },
    { points: [0.2, 0, 0.3, 0], colour: '#0000ff' },
  ]);
  trail.told();
  expect(trail.marks).toEqual([]);
});

test('orders of a finger are told twenty times in a second, the last one always', () => {
  vi.useFakeTimers();
  const told: string[] = [];
  const paced = new Paced((order) => told.push(order));
  for (let at = 0; at < 100; at++) paced.put(`robot ${at}`);
  expect(told).toEqual(['robot 0']);
  vi.advanceTimersByTime(PERIOD_MS);
  expect(told).toEqual(['robot 0', 'robot 99']);
  vi.useRealTimers();
});

test('one pointer pans or carries, two pinch', () => {
  const told: string[] = [];
  const gesture = new Gesture<string>({
    take: (at) => (at.x < 10 ? 'robot' : undefined),
    carry: (held, to, isLast) => told.push(`${held} ${to.x} ${isLast}`),
    pan: (right, down) => told.push(`pan ${right} ${down}`),
    pinch: (from, to) => told.push(`pinch ${from[0].x} ${to[0].x}`),
  });
  gesture.down(1, { x: 5, y: 5 });
  expect(gesture.isHolding).toBe(true);
  gesture.move(1, { x: 20, y: 5 });
  gesture.up(1);
  gesture.down(2, { x: 50, y: 50 });
  gesture.move(2, { x: 52, y: 49 });
  gesture.down(3, { x: 90, y: 50 });
  gesture.move(3, { x: 95, y: 50 });
  gesture.up(2);
  gesture.move(3, { x: 96, y: 50 });
  gesture.move(9, { x: 0, y: 0 });
  expect(told).toEqual(['robot 20 false', 'robot 20 true', 'pan 2 -1', 'pinch 90 95', 'pan 1 0']);
});

test('a file of any bytes becomes an order', () => {
  const bytes = Uint8Array.from({ length: 100_000 }, (_, at) => at % 256);
  const order = loadOrder(bytes);
  expect(order.startsWith('load ')).toBe(true);
  expect(Uint8Array.from(atob(order.slice(5)), (letter) => letter.charCodeAt(0))).toEqual(bytes);
});

test('walls of one look are painted at once, and marks of one colour too', async () => {
  const paths: string[][] = [];
  class Path {
    readonly steps: string[] = [];
    constructor() {
      paths.push(this.steps);
    }
    moveTo(): void {
      this.steps.push('M');
    }
    lineTo(): void {
      this.steps.push('L');
    }
    addPath(other: Path): void {
      this.steps.push(...other.steps);
    }
  }
  Object.assign(globalThis, { Path2D: Path });
  const { steps } = await import('./brush');
  const list = steps(scene());
  expect(list.map((step) => step.is)).toEqual(['path', 'path', 'path']);
  expect(list.map((step) => step.is === 'path' && step.stroke)).toEqual(['#000000', '#789', '#ff0000']);
  // A picture that is not in the scene itself is not fetched.
  const strange = scene();
  strange.items = [{ is: 'image', points: [0, 0, 1, 1], text: 'http://elsewhere/x.png' }];
  strange.marks = [];
  expect(steps(strange)).toEqual([]);
});
