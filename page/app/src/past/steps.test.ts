import { expect, it } from 'vitest';
import type { Line } from '../robot/recording';
import { runningAt, Steps } from './steps';

const line = (topic: string, time: number, name: string, text: string): Line => ({
  topic,
  time,
  level: 20,
  name,
  text,
  errno: 0,
});

it('a program runs from its start to its end', () => {
  const lines = [
    line('/programs', 1, 'a.qrs', 'a.qrs has started as diagram'),
    line('/log', 2, 'm', 'something'),
    line('/programs', 3, 'a.qrs', 'a.qrs has ended after 2 s'),
  ];
  expect(runningAt(lines, 0.5)).toBeUndefined();
  expect(runningAt(lines, 2.5)).toEqual({ name: 'a.qrs', since: 1 });
  expect(runningAt(lines, 3)).toBeUndefined();
});

it('a diagram has the variables that were assigned until then, forward and back', () => {
  const thread = { name: 'main', diagram: 'd', id: 'i', block: 'Timer' };
  const steps = new Steps([
    line('/diagram', 1, '', '{"ms":1,"threads":[],"variables":{"old":1}}'),
    line('/diagram', 5, '', JSON.stringify({ ms: 10, threads: [thread], variables: { n: 1, m: [1, 2] } })),
    line('/diagram', 6, '', 'no JSON'),
    line('/diagram', 7, '', '{"ms":20,"threads":[1,{}],"variables":{"n":2}}'),
  ]);
  expect(steps.at(4.5, 4)).toBeUndefined();
  const values = (time: number) => steps.at(time, 4)?.variables?.map(({ name, value }) => `${name}=${value}`);
  expect(values(6)).toEqual(['n=1', 'm=[1,2]']);
  expect(values(8)).toEqual(['n=2', 'm=[1,2]']);
  expect(values(5.5)).toEqual(['n=1', 'm=[1,2]']);
  expect(steps.at(5.5, 4)?.threads?.[0]).toMatchObject({ name: 'main', at: { id: 'i' } });
  expect(steps.at(8, 4)?.threads?.length).toBe(1);
});

it('blocks of data flow have reacted lately, and ports the last token, forward and back', () => {
  const told = (time: number, ms: number, more: object) =>
    line('/diagram', time, '', JSON.stringify({ ms, threads: [], variables: {}, ...more }));
  const token = (port: string, value: string, count: number) => ({ port, type: 'int', value, count });
  const named = { diagram: 'd', block: 'Function', caption: 'F' };
  const steps = new Steps([
    told(5, 0, { anew: true, blocks: [{ id: 'f', ...named, reacted: 1, ports: [token('O0', '7', 1)] }] }),
    told(6, 1000, {
      blocks: [
        { id: 'f', reacted: 3, ports: [token('O1', '8', 2)] },
        { id: 'f', instance: 1, ports: [token('O0', '1', 4)] },
        { id: 'g', reacted: 1 },
        'no block',
        { ports: [{ port: 1, value: [], count: 'x' }] },
      ],
      blocks_left_out: 2,
    }),
    told(7, 2000, { anew: true, blocks: [{ id: 'g', reacted: 1 }] }),
  ]);
  const ports = (time: number) =>
    steps
      .at(time, 4)
      ?.ports?.map(({ id, caption, port, value, count }) => `${id}${caption}.${port}=${value}*${count}`);
  expect(ports(5.5)).toEqual(['fF.O0=7*1']);
  expect([...steps.litAt(5.5)]).toEqual(['f']);
  expect([...steps.litAt(5.6)]).toEqual([]);
  expect(ports(6)).toEqual(['fF.O0=7*1', 'fF.O1=8*2', 'f.O0=1*4', '.=*0']);
  expect([...steps.litAt(6)]).toEqual(['f', 'g']);
  expect(steps.at(6, 4)).toMatchObject({
    reacted: [{ count: 3 }, { count: 0 }, { count: 1 }, {}],
  });
  // A new version of the program begins to count.
  expect(ports(7)).toEqual([]);
  expect(ports(5.5)).toEqual(['fF.O0=7*1']);
  expect(steps.at(4.5, 4)?.ports).toBeUndefined();
});

it('what is told once more is not what has happened again', () => {
  const told = (time: number, blocks: object[], more: object = {}) =>
    line('/diagram', time, '', JSON.stringify({ ms: 0, threads: [], variables: {}, blocks, ...more }));
  const once = { id: 'f', reacted: 1, ports: [{ port: 'O0', type: 'int', value: '7', count: 1 }] };
  const whole = new Steps([
    told(5, [once], { anew: true }),
    told(7, [once]),
    told(9, [{ id: 'f', reacted: 2 }]),
  ]);
  const lit = (steps: Steps, time: number) => (steps.at(time, 4), [...steps.litAt(time)]);
  expect(lit(whole, 5)).toEqual(['f']);
  expect(lit(whole, 7)).toEqual([]);
  expect(lit(whole, 9)).toEqual(['f']);
  // A recording that begins in the middle of a program.
  const later = new Steps([told(5, [once]), told(6, [{ id: 'f', reacted: 2 }])]);
  expect(lit(later, 5)).toEqual([]);
  expect(lit(later, 6)).toEqual(['f']);
  expect([...later.litAt(4)]).toEqual([]);
});
