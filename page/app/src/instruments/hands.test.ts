import { describe, expect, it } from 'vitest';
import { Deadman, NOTHING } from './gamepad';
import { Orders } from './orders';
import { pictureType } from './picture';

const pad = (axes: number[], pressed: boolean[] = []) => ({
  axes,
  buttons: pressed.map((one) => ({ pressed: one })),
});

describe('a gamepad', () => {
  it('moves nothing before everything was let go', () => {
    const deadman = new Deadman();
    expect(deadman.step(pad([0, -1]))).toEqual(NOTHING);
    expect(deadman.step(pad([0, 0]))).toEqual(NOTHING);
    expect(deadman.step(pad([0, -1])).first).toEqual({ x: 0, y: 1 });
    deadman.disarm();
    expect(deadman.step(pad([0, -1]))).toEqual(NOTHING);
    expect(deadman.step(pad([0, 0], [true]))).toEqual(NOTHING);
    expect(deadman.step(pad([0, 0]))).toEqual(NOTHING);
    expect(deadman.step(pad([0, 0], [true])).buttons).toEqual([true, false, false, false]);
  });

  it('that is unplugged, or says rubbish, rests', () => {
    const deadman = new Deadman();
    deadman.step(pad([0, 0, 0, 0]));
    expect(deadman.step(undefined)).toEqual(NOTHING);
    expect(deadman.step(pad([1, 0]))).toEqual(NOTHING);
    deadman.step(pad([]));
    expect(deadman.step(pad([NaN, NaN, Infinity]))).toEqual(NOTHING);
  });
});

describe('orders', () => {
  function robot() {
    const sent: string[] = [];
    const due: { at: number; callback: () => void }[] = [];
    let now = 0;
    const orders = new Orders({
      send: (path, value) => sent.push(`${now} ${path} ${value}`),
      now_ms: () => now,
      later: (callback, after_ms) => due.push({ at: now + after_ms, callback }),
    });
    const until = (time: number) => {
      for (const one of due.splice(0).sort((a, b) => a.at - b.at)) {
        if (one.at > time) due.push(one);
        else {
          now = one.at;
          one.callback();
        }
      }
      now = time;
    };
    return { orders, sent, until };
  }

  it('come at most 20 times in a second, and the newest always', () => {
    const { orders, sent, until } = robot();
    for (let at = 0; at < 1000; at++) {
      until(at);
      orders.put('m', String(at));
    }
    until(2000);
    expect(sent.length).toBeLessThanOrEqual(21);
    expect(sent.at(-1)).toMatch(/ m 999$/);
  });

  it('to several actuators do not wait for each other', () => {
    const { orders, sent } = robot();
    orders.put('a', '1');
    orders.put('b', '2');
    expect(sent).toEqual(['0 a 1', '0 b 2']);
  });

  it('do not follow a rest or a stop', () => {
    const { orders, sent, until } = robot();
    orders.put('m', '1');
    orders.put('m', '2');
    orders.now('m', '0');
    until(500);
    expect(sent).toEqual(['0 m 1', '0 m 0']);
    orders.put('m', '3');
    orders.put('m', '4');
    orders.drop();
    until(1000);
    expect(sent.at(-1)).toBe('500 m 3');
  });
});

it('pictures are told by their first bytes', () => {
  expect(pictureType(new Uint8Array([0xff, 0xd8, 0xff, 0xe0, 0]))).toBe('image/jpeg');
  expect(pictureType(new Uint8Array([0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a]))).toBe('image/png');
  expect(pictureType(new Uint8Array([0xff]))).toBeUndefined();
  expect(pictureType(new Uint8Array())).toBeUndefined();
});
