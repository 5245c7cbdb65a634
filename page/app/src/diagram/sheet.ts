// The picture of one diagram: from the text that the server has drawn to elements that can be lit and clicked.
//
// Owns what is taken from the picture: its shapes, and no style, script or link.

import { PICTURE_ELEMENTS_MAX } from '../limits';

export interface SheetPicture {
  name: string;
  main: boolean;
  /** Of data flow: its blocks have ports, and a program of it has no threads. */
  flow: boolean;
  /** SVG, in which each block is a group with its `data-id`. */
  picture: string;
  /** What stands in its blocks, by those ids; blocks of other kits are not there. */
  blocks: Record<string, BlockFacts>;
}

/** A block, and what stands in it. */
export interface BlockFacts {
  title: string;
  properties: Property[];
  /** Only of data flow: what no other block of its sheet is called. */
  name?: string;
  ports?: PortSpot[];
}

/** A port of a block, and where it is from the corner of its block. */
export interface PortSpot {
  name: string;
  gives: boolean;
  x: number;
  y: number;
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

/** The picture as an element; undefined if it is none, or too large to be shown. */
export function picture(text: string): SVGSVGElement | undefined {
  // The rules of the page forbid styles in a text, and would say so in the console.
  const plain = text.replace(/<style>[^<]*<\/style>/, '');
  const root = new DOMParser().parseFromString(plain, 'image/svg+xml').documentElement;
  if (!(root instanceof SVGSVGElement)) return undefined;
  const elements = [...root.querySelectorAll('*')];
  if (elements.length > PICTURE_ELEMENTS_MAX) return undefined;
  for (const element of elements) {
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

/** Classes of blocks: only those are touched whose class changes. */
export class Marks {
  readonly #marked = new Map<string, ReadonlySet<string>>();

  constructor(private readonly blocks: ReadonlyMap<string, Element>) {}

  /** These blocks have the class, and no other ones. Returns those for which that is new. */
  put(name: string, ids: ReadonlySet<string>): string[] {
    const before = this.#marked.get(name) ?? new Set();
    const changed = [
      ...[...ids].filter((id) => !before.has(id)),
      ...[...before].filter((id) => !ids.has(id)),
    ];
    for (const id of changed) this.blocks.get(id)?.classList.toggle(name, ids.has(id));
    this.#marked.set(name, new Set(ids));
    return changed;
  }
}
