import { expect, test } from 'vitest';
import { Camera, SCALES } from './camera';

function camera(): Camera {
  const one = new Camera();
  one.resize(800, 600);
  one.fit([0, 0, 3, 2]);
  return one;
}

test('all of a world is seen, with up above', () => {
  const one = camera();
  const low = one.spot(0, 0);
  const high = one.spot(3, 2);
  expect(low.x).toBeGreaterThan(0);
  expect(high.x).toBeLessThan(800);
  expect(high.y).toBeLessThan(low.y);
  expect(high.y).toBeGreaterThanOrEqual(0);
  expect(one.spot(1.5, 1)).toEqual({ x: 400, y: 300 });
});

test('a place is where its spot is', () => {
  const one = camera();
  one.zoom(1.7, { x: 100, y: 50 });
  const [x, y] = one.place(one.spot(1.25, -0.5));
  expect(x).toBeCloseTo(1.25, 9);
  expect(y).toBeCloseTo(-0.5, 9);
});

test('what is at the spot stays there while one zooms, within bounds', () => {
  const one = camera();
  const at = { x: 700, y: 500 };
  const before = one.place(at);
  for (let times = 0; times < 100; times++) one.zoom(1.5, at);
  expect(one.scale).toBe(SCALES[1]);
  expect(one.place(at)[0]).toBeCloseTo(before[0], 6);
  for (let times = 0; times < 100; times++) one.zoom(0.5, at);
  expect(one.scale).toBe(SCALES[0]);
  one.zoom(NaN);
  expect(one.scale).toBe(SCALES[0]);
});

test('the world follows the finger', () => {
  const one = camera();
  const before = one.place({ x: 10, y: 10 });
  one.pan(30, -20);
  const after = one.place({ x: 40, y: -10 });
  expect(after[0]).toBeCloseTo(before[0], 9);
  expect(after[1]).toBeCloseTo(before[1], 9);
});

test('two fingers keep what is between them', () => {
  const one = camera();
  const before = one.place({ x: 200, y: 200 });
  const { scale } = one;
  one.pinch(
    [
      { x: 150, y: 200 },
      { x: 250, y: 200 },
    ],
    [
      { x: 200, y: 300 },
      { x: 400, y: 300 },
    ],
  );
  expect(one.scale).toBeCloseTo(2 * scale, 9);
  const after = one.place({ x: 300, y: 300 });
  expect(after[0]).toBeCloseTo(before[0], 9);
  expect(after[1]).toBeCloseTo(before[1], 9);
});

test('the matrix of a canvas does what spots do', () => {
  const one = camera();
  const [a, b, c, d, e, f] = one.matrix(2);
  const { x, y } = one.spot(1.1, 0.7);
  expect(a * 1.1 + c * 0.7 + e).toBeCloseTo(2 * x, 6);
  expect(b * 1.1 + d * 0.7 + f).toBeCloseTo(2 * y, 6);
});
