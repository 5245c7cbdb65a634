// Worlds as things: of friends, of strangers.

import { expect, test } from 'vitest';
import { KINDS, plainText } from './kinds';
import {
  NEW_WORLD,
  type WorldModel,
  added,
  boundsOf,
  changed,
  drawnTo,
  gripAt,
  isFault,
  model,
  shifted,
  withSensor,
  withSetting,
  without,
} from './model';
import { SENSORS, sensorPort } from './sensors';
import { colour, written } from './units';
import { spliced } from './xml';

function opened(text: string, before?: WorldModel): WorldModel {
  const found = model(text, before);
  if (isFault(found)) throw new Error(`${found.fault} at ${found.at}`);
  return found;
}

const kind = (name: string) => {
  const found = KINDS.find((one) => one.name === name);
  if (!found) throw new Error(name);
  return found;
};

test('a new world has a room and a robot, and whatever a person adds', () => {
  let world = opened(NEW_WORLD);
  expect(world.items.map(({ key }) => key)).toEqual([
    'wall 0',
    'wall 1',
    'wall 2',
    'wall 3',
    'start 0',
    'robot 0',
  ]);
  for (const one of KINDS.filter(
    ({ creation }) => creation && creation !== 'robot' && creation !== 'start',
  )) {
    const { splices, key } = added(world, one, [0, 0], [100, 50]);
    world = opened(spliced(world.document.text, splices));
    expect(world.byKey.get(key)?.kind.name, one.name).toBe(one.name);
    expect(world.byKey.get(key)?.id).not.toBe('');
  }
  expect(new Set(world.items.map(({ id }) => id)).size).toBe(world.items.length);
  const [port] = SENSORS[0]?.ports ?? [];
  if (!port) throw new Error('no port');
  world = opened(
    spliced(world.document.text, withSensor(world, 'robot 0', SENSORS[0]?.type ?? '', sensorPort(port))),
  );
  expect(world.byKey.get('sensor 0')?.on).toBe('robot 0');
  expect(world.document.text).toContain(
    '            <sensors>\n                <sensor port="A1###input######sensorA1" type="trik::robotModel::parts::TrikInfraredSensor"',
  );
  world = opened(spliced(world.document.text, without(world, 'robot 0')));
  expect(world.byKey.get('robot 0')).toBe(undefined);
  const { splices } = added(world, kind('robot'), [0, 0], [0, 0]);
  world = opened(spliced(world.document.text, splices));
  expect(world.byKey.get('robot 0')?.values.point('position')).toEqual(
    [-25, -25].map((one) => expect.closeTo(one, 2)),
  );
});

test('lengths are in the unit of the file, and without settings centimetres', () => {
  const of = (settings: string) =>
    opened(`<root>${settings}<world><walls><wall begin="10:0" end="20:0"/></walls></world></root>`);
  expect(of('').byKey.get('wall 0')?.values.point('end')[0]).toBeCloseTo(57.14, 2);
  expect(of('<settings/>').unit).toBe('px');
  expect(of('<settings sizeUnit="mm"/>').byKey.get('wall 0')?.values.point('end')[0]).toBeCloseTo(5.714, 2);
  // A setting that is written where there were none does not change what lengths mean.
  const world = of('');
  const text = spliced(world.document.text, withSetting(world, 'realisticPhysics', 'true'));
  expect(opened(text).unit).toBe('cm');
});

test('what is moved is moved whole, in the unit of the file', () => {
  const text = `<root><settings sizeUnit="cm"/><world>
    <balls><ball x="1" y="2" markerX="1" markerY="2"/><ball x="1" y="2" markerX="9" markerY="2"/><ball begin="1:2"/></balls>
    <regions><region type="rectangle" x="0" y="0" width="10" height="10"/></regions>
    <robot position="1:1" direction="0"/></world><robots><robot id="trikKitRobot"><wheels left="M3###output######M3"/></robot></robots></root>`;
  const world = opened(text);
  const cm = 16 / 5.6;
  const item = (key: string) => world.byKey.get(key) ?? [...world.items][0];
  const shift = (key: string) => {
    const one = item(key);
    return one ? shifted(one, 10 * cm, -1 * cm) : {};
  };
  expect(shift('ball 0')).toEqual({ x: '11', y: '1', markerX: '11', markerY: '1' });
  expect(shift('ball 1')).toEqual({ x: '11', y: '1' });
  expect(shift('ball 2')).toEqual({ begin: '11:1' });
  const region = item('regionRectangle 0');
  const [size] = region?.kind.grips ?? [];
  if (!region || !size) throw new Error('no region');
  expect(drawnTo(region, size, [20 * cm, 30 * cm])).toEqual({ width: '20', height: '30' });
  // The place of an old robot is where it was, its wheels in its own tag.
  const placed = spliced(text, changed(world, 'robot 0', { position: '5:5', right: 'M4###output######M4' }));
  expect(placed).toBe(
    text.replace('position="1:1"', 'position="5:5"').replace('M3"/>', 'M3" right="M4###output######M4"/>'),
  );
});

test('a picture is where its rectangle is moved to, and keeps that', () => {
  const text = `<root><settings/><world><images><image rect="0:0:100:50" position="10:20"/>
    <image backgroundRect="5:5:10:10"/></images></world></root>`;
  const world = opened(text);
  const [first, old] = ['image 0', 'image 1'].map((key) => world.byKey.get(key));
  const [corner] = first?.kind.grips ?? [];
  if (!first || !old || !corner) throw new Error('no pictures');
  expect(gripAt(first, corner, 0)).toEqual([110, 70]);
  expect(shifted(first, 5, 5)).toEqual({ rect: '5:5:100:50' });
  expect(drawnTo(first, corner, [60, 60])).toEqual({ rect: '0:0:50:25' });
  expect(shifted(old, 5, 5)).toEqual({ backgroundRect: '10:10:10:10' });
});

test('things whose text is the same stay the same objects', () => {
  const world = opened(NEW_WORLD);
  const later = opened(spliced(NEW_WORLD, changed(world, 'wall 0', { begin: '0:0' })), world);
  expect(later.byKey.get('wall 0')).not.toBe(world.byKey.get('wall 0'));
  expect(later.byKey.get('wall 1')).toBe(world.byKey.get('wall 1'));
});

test('numbers, colours and comments of strangers are numbers, colours and words', () => {
  expect(['1e99', '-0', '0.00001', '1.23456'].map((one) => written(Number(one)))).toEqual([
    '1000000',
    '0',
    '0',
    '1.2346',
  ]);
  expect(colour('#80112233')).toBe('#11223380');
  expect(colour('url(x)')).toBe('#000000');
  expect(plainText('<html><style>p{}</style><p>a &lt;b</p></html>')).toBe('a <b');
  expect(plainText('<style'.repeat(1e6))).toBe('<style'.repeat(1e6).slice(0, 4000));
  const values = ['NaN:1e400', '::::', '', '1e9', ':', 'x:y'];
  for (const text of values)
    for (const one of KINDS) {
      const attributes = one.attributes.map(({ name }) => ` ${name}="${text}"`).join('');
      const when = Object.entries(one.when ?? {}).map(([name, is]) => ` ${name}="${is}"`);
      const tag = `<${one.tag}${attributes.replace(/ type="[^"]*"/, '')}${when.join('')}/>`;
      const world = opened(
        `<root><world><${one.list}>${tag}</${one.list}></world><robots><robot><sensors>${tag}</sensors></robot></robots></root>`,
      );
      for (const item of world.items)
        expect(item.kind.outline(item.values).path).not.toMatch(/NaN|Infinity|undefined/);
      expect(boundsOf(world).every(Number.isFinite)).toBe(true);
    }
});

test('thousands of things are read in a moment', () => {
  const walls = Array.from(
    { length: 20_000 },
    (_, at) => `<wall id="w${at}" begin="${at}:0" end="${at}:9"/>`,
  );
  const text = `<root><world><walls>${walls.join('\n')}</walls></world></root>`;
  const begin = performance.now();
  const world = opened(text);
  expect(world.items.length).toBe(20_000);
  opened(spliced(text, changed(world, 'wall 9999', { begin: '1:1' })), world);
  expect(performance.now() - begin).toBeLessThan(10_000);
});

test('a text that is no world says why', () => {
  expect(model('<root/>')).toMatchObject({ fault: 'noWorld' });
  expect(model('<save><root><world/></root></save>')).toMatchObject({ unit: 'cm' });
});
