// Images of a project: put in, taken out, carried with worlds, and texts of others.

import { expect, test } from 'vitest';
import { KINDS } from './kinds';
import { added, changed, isFault, model, moved } from './model';
import { addressOf, joined, newId, parted, stored, withImage, withoutImages } from './pictures';
import { spliced } from './xml';

const PNG = { id: '{a}', path: 'maze.png', text: 'AAAA' };
const SVG = { id: '{b}', path: 'line "1".SVG', text: '<svg viewBox="0 0 1 1"><g id="&amp;"/></svg>' };

function both(): string {
  const one = withImage('', PNG) ?? '';
  return withImage(one, SVG) ?? '';
}

test('images come and go, and others stay as they are', () => {
  const images = both();
  expect(stored(images)).toEqual([PNG, SVG]);
  expect(stored(withoutImages(images, new Set(['{a}'])))).toEqual([SVG]);
  expect(withoutImages(withImage('', PNG) ?? '', new Set(['{a}']))).toBe('');
  expect(withoutImages(images, new Set())).toBe(images);
  const strange = '<blobs><!-- of mine --><images  x="1"></images></blobs>';
  expect(withImage(strange, PNG)).toContain('<!-- of mine --><images  x="1">');
  expect(withImage('<blobs/>', PNG)).toContain('imageId="{a}"');
  expect(withImage('<blobs>', PNG)).toBeUndefined();
  expect(stored('<blobs>')).toEqual([]);
  expect(newId()).toMatch(/^\{[0-9a-f]{32}\}$/);
  expect(newId()).not.toBe(newId());
});

test('an image is shown by an address that needs nobody', () => {
  expect(addressOf(PNG)).toBe('data:image/png;base64,AAAA');
  expect(addressOf(SVG)).toMatch(/^data:image\/svg\+xml,%3Csvg/);
});

test('a world carries its images along, and gives them back', () => {
  const world = '<root><settings/>\n    <world/>\n</root>';
  const whole = joined(world, both());
  expect(whole).toContain('imageId="{a}"');
  const { text, images } = parted(whole);
  expect(text).toBe(world);
  expect(stored(images)).toEqual([PNG, SVG]);
  expect(joined(world, '')).toBe(world);
  expect(joined('', both())).toBe('');
  expect(parted(world)).toEqual({ text: world, images: '' });
  expect(parted('<root>')).toEqual({ text: '<root>', images: '' });
});

const opened = (text: string) => {
  const found = model(text);
  if (isFault(found)) throw new Error(found.fault);
  return found;
};
const kind = (name: string) => {
  const found = KINDS.find((one) => one.name === name);
  if (!found) throw new Error(name);
  return found;
};
const EMPTY = '<root><settings sizeUnit="px"/><world/></root>';

test('a picture names its image and is as large as it was drawn', () => {
  const world = opened(EMPTY);
  const { splices, key } = added(world, kind('image'), [10, 20], [110, 70], { imageId: '{a}' });
  const text = spliced(world.document.text, splices);
  expect(text).toContain(
    '<image id="image1" imageId="{a}" rect="10:20:100:50" position="0:0" isBackground="false"/>',
  );
  expect(opened(text).byKey.get(key)?.values.text('imageId')).toBe('{a}');
});

test('what a hand has drawn is kept piece by piece, and moves as a whole', () => {
  const world = opened(EMPTY);
  const way = [
    [0, 0],
    [5, 5],
    [5, -10.5],
  ] as const;
  const { splices, key } = added(world, kind('stylus'), [0, 0], [5, 0], { way });
  let next = opened(spliced(world.document.text, splices));
  expect(next.document.text).toContain(
    '<stylusLine begin="5:5" end="5:-10.5" stroke="#000000" stroke-width="6"/>',
  );
  const item = next.byKey.get(key);
  if (!item) throw new Error(key);
  const [grip] = item.kind.moves;
  if (!grip) throw new Error('it does not move');
  next = opened(spliced(next.document.text, changed(next, key, moved(item, grip, 10, -1))));
  const { document } = next;
  expect(document.text).toContain('begin="10:-1" end="15:4"');
  expect(document.text).toContain('begin="15:4" end="15:-11.5"');
  expect(document.text).not.toContain('pieces');
  expect(next.byKey.get(key)?.values.text('pieces')).toBe('M10 -1L15 4M15 4L15 -11.5');
});
