// Texts in XML, of friends and of strangers: what is not named by a change stays letter for letter.

import { expect, test } from 'vitest';
import { XML_DEPTH_MAX } from '../../limits';
import {
  type XmlDocument,
  child,
  insert,
  letterAt,
  placeOf,
  read,
  remove,
  replace,
  set,
  spliced,
  swap,
  tagAt,
  value,
} from './xml';

function opened(text: string): XmlDocument {
  const found = read(text);
  if ('fault' in found) throw new Error(`${found.fault} at ${found.at}`);
  return found;
}

const TEXT = `<?xml version='1.0'?>
<!DOCTYPE root [ <!ENTITY a "b"> ]>
<!-- a > b -->
<root a = "1"  b='say "x" &amp; &#65;&#x42;' >
\t<list><![CDATA[ </list> ]]>
\t\t<one id="1"/>
\t\t<one id="2"   strange:name="kept" ></one>
\t</list>
\t<empty/>
</root >
<!-- end -->
`;

test('tags, attributes and what stands between them are found', () => {
  const { root } = opened(TEXT);
  expect(value(root, 'b')).toBe('say "x" & AB');
  expect(root.children.map(({ name }) => name)).toEqual(['list', 'empty']);
  expect(root.children[0]?.children.map((one) => value(one, 'id'))).toEqual(['1', '2']);
});

test('a change of an attribute touches that attribute alone', () => {
  const { root } = opened(TEXT);
  const second = root.children[0]?.children[1];
  if (!second) throw new Error('no tag');
  const changed = spliced(TEXT, set(second, { id: 'a"<&\n', more: 'x' }));
  expect(changed).toBe(
    TEXT.replace(
      '<one id="2"   strange:name="kept" >',
      '<one id="a&quot;&lt;&amp;&#10;"   strange:name="kept" more="x" >',
    ),
  );
  expect(value(opened(changed).root.children[0]?.children[1] ?? root, 'id')).toBe('a"<&\n');
  // What it says already is not written anew, and what is taken away goes with the space before it.
  expect(set(root, { b: 'say "x" & AB' })).toEqual([]);
  expect(spliced(TEXT, set(second, { id: undefined }))).toBe(TEXT.replace('<one id="2"   s', '<one   s'));
  expect(spliced(TEXT, set(root, { b: "it's" }))).toContain("b='it&apos;s'");
});

test('tags come, go and change places with their lines', () => {
  const document = opened(TEXT);
  const [list, empty] = document.root.children;
  const [first, second] = list?.children ?? [];
  if (!list || !empty || !first || !second) throw new Error('no tags');
  expect(spliced(TEXT, insert(document, list, '<two>\n\t<x/>\n</two>'))).toBe(
    TEXT.replace('</one>\n', '</one>\n\t\t<two>\n\t\t\t<x/>\n\t\t</two>\n'),
  );
  expect(spliced(TEXT, insert(document, list, '<two/>', 0))).toBe(
    TEXT.replace('\t\t<one id="1"/>', '\t\t<two/>\n\t\t<one id="1"/>'),
  );
  expect(spliced(TEXT, insert(document, empty, '<two/>'))).toBe(
    TEXT.replace('<empty/>', '<empty>\n\t\t<two/>\n\t</empty>'),
  );
  expect(spliced(TEXT, remove(document, first))).toBe(TEXT.replace('\n\t\t<one id="1"/>', ''));
  expect(spliced(TEXT, replace(document, first, '<a>\n</a>'))).toBe(
    TEXT.replace('<one id="1"/>', '<a>\n\t\t</a>'),
  );
  const swapped = opened(spliced(TEXT, swap(document, first, second)));
  expect(child(swapped.root, 'list')?.children.map((one) => value(one, 'id'))).toEqual(['2', '1']);
});

test('places are lines and columns, and lead to tags', () => {
  const { root } = opened(TEXT);
  const at = TEXT.indexOf('<one id="2"');
  expect(placeOf(TEXT, at)).toEqual({ line: 7, column: 3 });
  expect(letterAt(TEXT, 7, 3)).toBe(at);
  expect(letterAt(TEXT, 99, 1)).toBe(TEXT.lastIndexOf('\n') + 1);
  expect(tagAt(root, at + 2)?.name).toBe('one');
  expect(tagAt(root, 0)).toBe(undefined);
});

test.each([
  ['', 'noRoot'],
  ['words', 'noRoot'],
  ['<a/><b/>', 'noRoot'],
  ['<a>', 'notClosed'],
  ['<a><b></a></b>', 'wrongEnd'],
  ['</a>', 'wrongEnd'],
  ['<a b=1/>', 'badTag'],
  ['<a b="1', 'badTag'],
  ['<a b="1" b="2"/>', 'badTag'],
  ['<a', 'badTag'],
  ['<a><!-- ', 'notClosed'],
  ['<a><![CDATA[ </a>', 'notClosed'],
  ['<!DOCTYPE a [', 'notClosed'],
  ['<a>'.repeat(XML_DEPTH_MAX + 1), 'tooDeep'],
  [`<a>${'<b/>'.repeat(100_001)}</a>`, 'tooMany'],
])('%.20s is no document: %s', (text, fault) => {
  expect(read(text)).toMatchObject({ fault });
});

test('a text of a stranger takes time as it is long', () => {
  const begin = performance.now();
  for (const piece of [
    '<',
    '<a ',
    '<a b="',
    '&',
    '<!',
    '<!--',
    '<![CDATA[',
    ' ',
    '<!DOCTYPE [',
    '<!a>',
    '<b/>',
  ]) {
    read(`<a>${piece.repeat(300_000)}</a>`);
    read(`<a b="${piece.replaceAll('"', '').repeat(300_000)}"/>`);
  }
  expect(performance.now() - begin).toBeLessThan(20_000);
});
