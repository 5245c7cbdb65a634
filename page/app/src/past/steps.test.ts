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
