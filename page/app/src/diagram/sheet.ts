// The picture of one diagram: from the text that the server has drawn to elements that can be lit and clicked.
//
// Owns what is taken from the picture: its shapes, and no style, script or link.

export interface SheetPicture {
  name: string;
  main: boolean;
  /** SVG, in which each block is a group with its `data-id`. */
  picture: string;
  /** What stands in its blocks, by those ids; blocks of other kits are not there. */
  blocks: Record<string, BlockFacts>;
}

/** A block, and what stands in it. */
export interface BlockFacts {
  title: string;
  properties: Property[];
}

export interface Property {
  /** In the save. */
  name: string;
  title: string;
  value: string;
  /** What can stand there; null if it is any text. */
  choices: string[] | null;
}

/** What stands in a property of a block, in whichever sheet it is. */
export function valueOf(
  sheets: readonly SheetPicture[],
  block: string,
  property: string,
): string | undefined {
  const facts = sheets.map((sheet) => sheet.blocks[block]).find((one) => one);
  return facts?.properties.find(({ name }) => name === property)?.value;
}

const TAGS = new Set([
  ...[
    'svg',
    'g',
    'defs',
    'marker',
    'path',
    'rect',
    'circle',
    'ellipse',
    'line',
    'polyline',
    'polygon',
    'text',
  ],
  ...['tspan', 'title'],
]);

/** The picture as an element; undefined if it is none. */
export function picture(text: string): SVGSVGElement | undefined {
  // The rules of the page forbid styles in a text, and would say so in the console.
  const plain = text.replace(/<style>[^<]*<\/style>/, '');
  const root = new DOMParser().parseFromString(plain, 'image/svg+xml').documentElement;
  if (!(root instanceof SVGSVGElement)) return undefined;
  for (const element of [...root.querySelectorAll('*')]) {
    if (!TAGS.has(element.localName)) element.remove();
    for (const { name } of [...element.attributes]) {
      if (name.startsWith('on') || name.endsWith('href') || name === 'style') element.removeAttribute(name);
    }
  }
  return document.importNode(root, true);
}

/** The blocks of a picture by their ids. */
export function blocks(root: SVGSVGElement): Map<string, SVGGElement> {
  const found = new Map<string, SVGGElement>();
  for (const group of root.querySelectorAll<SVGGElement>('g[data-id]')) {
    const id = group.dataset['id'];
    if (id !== undefined) found.set(id, group);
  }
  return found;
}

/** What is written at each block of a picture, by its id. */
export function titlesOf(text: string): Map<string, string> {
  const root = picture(text);
  const all = root ? [...blocks(root)] : [];
  return new Map(
    all.map(([id, block]) => [id, (block.querySelector('title')?.textContent ?? '').replace(/: $/, '')]),
  );
}
