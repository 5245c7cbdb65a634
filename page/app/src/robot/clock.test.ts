import { expect, test } from 'vitest';
import { Clock } from './clock';

/** The page's clock at the beginning, and that of a robot which is ahead of it. */
const NOW = 1_700_000_000;
const ROBOT = NOW + 100;
const HOUR = 3600;

function heard(): Clock {
  const clock = new Clock();
  clock.told(1000, NOW);
  // What a node has had for a day comes first.
  clock.hear(ROBOT - 24 * HOUR, NOW);
  clock.hear(ROBOT, NOW);
  // One that was on its way for half a second.
  clock.hear(ROBOT + 0.5, NOW + 1);
  return clock;
}

test('the fastest message says what the clock of the robot is', () => {
  expect(heard().at(NOW + 1)).toBe(ROBOT + 1);
});

test('a robot that says that its clock was set is believed at once', () => {
  const clock = heard();
  clock.told(1000 - HOUR, NOW + 1);
  expect(clock.at(NOW + 1)).toBe(ROBOT + 1 - HOUR);
  // Sampled before, and sent later.
  clock.hear(ROBOT + 0.9, NOW + 1.1);
  expect(clock.at(NOW + 2)).toBe(ROBOT + 2 - HOUR);
  clock.told(1000 + HOUR, NOW + 3);
  clock.hear(ROBOT + 3 + HOUR, NOW + 3);
  expect(clock.at(NOW + 3)).toBe(ROBOT + 3 + HOUR);
});

test('what a robot says after another beginning is compared with nothing before', () => {
  const clock = heard();
  clock.begin();
  clock.told(5000, NOW + 1);
  expect(clock.at(NOW + 1)).toBe(ROBOT + 1);
  clock.told(NaN, NOW + 1);
  clock.told(4999, NOW + 1);
  expect(clock.at(NOW + 1)).toBe(ROBOT);
});

test('a clock that was set back without a word is seen when nothing else comes', () => {
  const clock = heard();
  clock.hear(ROBOT + 2 - HOUR, NOW + 2);
  expect(clock.at(NOW + 2)).toBe(ROBOT + 2);
  clock.hear(ROBOT + 3 - HOUR, NOW + 3);
  clock.hear(ROBOT + 3.9 - HOUR, NOW + 4);
  expect(clock.at(NOW + 4)).toBe(ROBOT + 4 - HOUR);
});

test('old samples among new ones, and slow ones, do not set the clock back', () => {
  const clock = heard();
  for (let second = 2; second < 9; second++) {
    clock.hear(ROBOT - HOUR, NOW + second);
    clock.hear(ROBOT + second - 5, NOW + second);
  }
  expect(clock.at(NOW + 9)).toBe(ROBOT + 9);
});
