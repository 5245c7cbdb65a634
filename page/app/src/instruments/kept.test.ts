import { describe, expect, it } from 'vitest';
import { PINNED_MAX } from '../limits';
import type { Node } from '../robot/recording';
import { keep, kept, moved, type Pinned, read, text } from './board';
import { guessed, read as readSetup, text as setupText } from './setup';

const node = (path: string): Pinned => ({ is: 'node', path });

describe('a dashboard', () => {
  const all: Pinned[] = [
    node('battery'),
    { is: 'graph', numbers: [{ path: 'heading', field: 'heading' }], window_s: 30 },
  ];

  it('is read as it was kept', () => {
    expect(read(text(all))).toEqual(all);
  });

  it('is nothing if it is none, and loses what is wrong in it', () => {
    for (const bad of [
      null,
      '',
      'x',
      '[]',
      '{}',
      '{"version":2,"pinned":[]}',
      '{"version":1,"pinned":7}',
      'null',
    ]) {
      expect(read(bad)).toEqual([]);
    }
    const source = { path: 'a', field: 'b' };
    const pinned = [
      7,
      null,
      { is: 'node' },
      { is: 'node', path: '' },
      { is: 'node', path: 'x'.repeat(2000) },
      { is: 'graph', numbers: [], window_s: 30 },
      { is: 'graph', numbers: [source], window_s: 31 },
      { is: 'graph', numbers: [source, source, 5, { path: 'c' }], window_s: 10 },
      { is: 'graph', numbers: [source], window_s: 30 },
      node('battery'),
      node('battery'),
    ];
    expect(read(JSON.stringify({ version: 1, pinned }))).toEqual([
      { is: 'graph', numbers: [source], window_s: 10 },
      node('battery'),
    ]);
  });

  it('has an end', () => {
    const pinned = Array.from({ length: 500 }, (_, at) => node(`n${at}`));
    expect(read(JSON.stringify({ version: 1, pinned })).length).toBe(PINNED_MAX);
  });

  it('is put in another order', () => {
    const list = [node('a'), node('b'), node('c')];
    expect(moved(list, 0, 2)).toEqual([node('b'), node('c'), node('a')]);
    expect(moved(list, 2, -1)).toEqual([node('a'), node('c'), node('b')]);
    expect(moved(list, 0, -1)).toEqual(list);
    expect(moved(list, 7, 1)).toEqual(list);
  });

  it('is not kept by a browser that keeps nothing', () => {
    const full = {
      getItem: () => {
        throw new Error('forbidden');
      },
      setItem: () => {
        throw new Error('full');
      },
    };
    expect(kept(full, 'k')).toBeNull();
    expect(kept(undefined, 'k')).toBeNull();
    expect(() => keep(full, 'k', 'v')).not.toThrow();
  });
});

describe('what pads move', () => {
  const motor = (path: string, aliases: string[] = []): Node => ({
    path,
    aliases,
    format: 'i32 duty_cycle',
    units: '%',
    about: '',
    isWritten: true,
    rest: '0',
  });
  const nodes = [
    motor('motors/M1'),
    motor('motors/M3', ['motors/left']),
    motor('motors/M4', ['motors/right']),
  ];

  it('is guessed by names, else by order', () => {
    expect(guessed(nodes)).toMatchObject({ left: 'motors/M3', right: 'motors/M4' });
    expect(guessed([motor('motors/M1'), motor('motors/M2')])).toMatchObject({
      left: 'motors/M1',
      right: 'motors/M2',
    });
    expect(guessed([])).toMatchObject({ left: '', right: '' });
    expect(guessed([{ ...motor('motors/M1'), rest: '' }])).toMatchObject({ left: '' });
  });

  it('is read as it was kept, and as guessed where it is wrong', () => {
    const setup = { ...guessed(nodes), x: 'servos/S1', leftTurned: true, power_percent: 40 };
    expect(readSetup(setupText(setup), guessed(nodes))).toEqual(setup);
    for (const bad of [null, '', '[', '5', 'null', '{}', '{"version":7}']) {
      expect(readSetup(bad, guessed(nodes))).toEqual(guessed(nodes));
    }
    const wrong =
      '{"version":1,"left":7,"power_percent":1e9,"buttons":[null,{"path":3,"value":"x"}],"leftTurned":"yes"}';
    expect(readSetup(wrong, guessed(nodes))).toEqual(guessed(nodes));
  });
});
