// The images of a project, of which each one has an id that pictures of the world name.
//
// Owns the text in which a save keeps them, and how a file of a person becomes one. Knows no world.

import {
  PICTURE_BYTES_MAX,
  PICTURE_FILE_MB_MAX,
  PICTURE_PIXELS_MAX,
  PICTURE_SIDE_PX_MAX,
} from '../../limits';
import { type Tag, child, encoded, insert, read, remove, spliced, value } from './xml';

/** An image as a save keeps it. */
export interface Stored {
  id: string;
  /** The name of a file: one that ends in `.svg` tells that `text` is SVG; all others are Base64. */
  path: string;
  text: string;
}

/** One that a person has chosen, and its own size in pixels. */
export interface Chosen {
  path: string;
  text: string;
  width: number;
  height: number;
}

/** A world, and its images beside it. */
export interface Place {
  text: string;
  images: string;
}

/** Why a file is no picture. */
export type NoPicture = 'tooLarge' | 'unreadable';

const NONE = '<blobs>\n    <images/>\n</blobs>\n';
const SVG = /\.svg$/i;

function lists(root: Tag): Tag[] {
  const blobs = root.name === 'blobs' ? root : (child(root, 'blobs') ?? root);
  return blobs.children.filter(({ name }) => name === 'images');
}

/** The images of a text; of one that cannot be read none. */
export function stored(images: string): Stored[] {
  const found = read(images);
  if ('fault' in found) return [];
  return lists(found.root)
    .flatMap(({ children }) => children)
    .map((tag) => ({
      id: value(tag, 'imageId') ?? '',
      path: value(tag, 'path') ?? '',
      text: unescaped(images.slice(tag.openTo, tag.closeFrom)),
    }));
}

/** An id that no image has. Pages of robots are not secure contexts, so that they have no `randomUUID`. */
export function newId(): string {
  const bytes = crypto.getRandomValues(new Uint8Array(16));
  return `{${[...bytes].map((one) => one.toString(16).padStart(2, '0')).join('')}}`;
}

/** A text with one image more. A text that cannot be read is left as it is, and undefined. */
export function withImage(images: string, { id, path, text }: Stored): string | undefined {
  const before = images.trim() ? images : NONE;
  const found = read(before);
  if ('fault' in found) return undefined;
  const xml = `<image imageId="${encoded(id)}" path="${encoded(path)}">${escaped(text)}</image>`;
  const [list] = lists(found.root);
  return spliced(
    before,
    list
      ? insert(found, list, xml)
      : insert(found, child(found.root, 'blobs') ?? found.root, `<images>${xml}</images>`),
  );
}

/** A text without the images of these ids; empty if none is left. */
export function withoutImages(images: string, ids: ReadonlySet<string>): string {
  const found = read(images);
  if ('fault' in found) return images;
  const all = lists(found.root).flatMap(({ children }) => children);
  const gone = all.filter((tag) => ids.has(value(tag, 'imageId') ?? ''));
  if (gone.length === all.length) return '';
  return spliced(
    images,
    gone.flatMap((tag) => remove(found, tag)),
  );
}

/** A world with its images in it, as TRIK Studio exports worlds. */
export function joined(world: string, images: string): string {
  const found = read(world);
  if ('fault' in found || !images.trim()) return world;
  const root = found.root.name === 'root' ? found.root : (child(found.root, 'root') ?? found.root);
  const blobs = /<blobs[\s>][\s\S]*<\/blobs>/.exec(images)?.[0];
  return blobs ? spliced(world, insert(found, root, blobs)) : world;
}

/** A world without images, and these. */
export function parted(text: string): Place {
  const found = read(text);
  if ('fault' in found) return { text, images: '' };
  const root = child(found.root, 'root') ?? found.root;
  const blobs = child(root, 'blobs') ?? child(found.root, 'blobs');
  if (!blobs) return { text, images: '' };
  return { text: spliced(text, remove(found, blobs)), images: text.slice(blobs.from, blobs.to) };
}

/** An address that shows an image within the page. */
export function addressOf({ path, text }: Stored): string {
  return SVG.test(path)
    ? `data:image/svg+xml,${encodeURIComponent(text)}`
    : `data:image/png;base64,${text.replace(/\s/g, '')}`;
}

/** A file of a person as a picture: SVG stays what it is, and everything else that the browser knows becomes PNG. */
export async function chosenFrom(file: File): Promise<Chosen | NoPicture> {
  if (file.size > PICTURE_FILE_MB_MAX << 20) return 'tooLarge';
  const isSvg = SVG.test(file.name) || file.type === 'image/svg+xml';
  const address = URL.createObjectURL(file);
  try {
    const image = await loaded(address);
    // Of SVG that names none it is the browser's.
    const [width, height] = [image.naturalWidth || 300, image.naturalHeight || 300];
    if (!isSvg && width * height > PICTURE_PIXELS_MAX) return 'tooLarge';
    const stem = file.name.replace(/\.[^.]*$/, '').slice(0, 100) || 'picture';
    if (isSvg) {
      if (file.size > PICTURE_BYTES_MAX) return 'tooLarge';
      return { path: `${stem}.svg`, text: drawingOf(await file.text()), width, height };
    }
    const isSmall = file.size <= PICTURE_BYTES_MAX && Math.max(width, height) <= PICTURE_SIDE_PX_MAX;
    const bytes =
      file.type === 'image/png' && isSmall
        ? new Uint8Array(await file.arrayBuffer())
        : await repainted(image, width, height);
    return bytes ? { path: `${stem}.png`, text: base64(bytes), width, height } : 'unreadable';
  } catch {
    return 'unreadable';
  } finally {
    URL.revokeObjectURL(address);
  }
}

/** An image of which the size is known, but not each pixel: those may be more than there is memory for. */
function loaded(address: string): Promise<HTMLImageElement> {
  return new Promise((done, fail) => {
    const image = new Image();
    image.onload = () => done(image);
    image.onerror = fail;
    image.src = address;
  });
}

/** SVG without what stands before it, which no tag of another document can have in it. */
function drawingOf(text: string): string {
  const begin = text.search(/<svg[\s>]/i);
  return begin < 0 ? text : text.slice(begin);
}

/** PNG of an image, so much smaller that its file is not too large. */
async function repainted(
  image: HTMLImageElement,
  width: number,
  height: number,
): Promise<Uint8Array | undefined> {
  let scale = Math.min(1, PICTURE_SIDE_PX_MAX / Math.max(width, height));
  for (;;) {
    const canvas = document.createElement('canvas');
    canvas.width = Math.max(1, Math.round(width * scale));
    canvas.height = Math.max(1, Math.round(height * scale));
    const context = canvas.getContext('2d');
    if (!context) return undefined;
    context.drawImage(image, 0, 0, canvas.width, canvas.height);
    const blob = await new Promise<Blob | null>((done) => canvas.toBlob(done, 'image/png'));
    if (!blob) return undefined;
    if (blob.size <= PICTURE_BYTES_MAX) return new Uint8Array(await blob.arrayBuffer());
    scale *= 0.7;
  }
}

/** Bytes of a piece: a function takes no more arguments at once. */
const PIECE = 0x8000;

function base64(bytes: Uint8Array): string {
  let letters = '';
  for (let at = 0; at < bytes.length; at += PIECE)
    letters += String.fromCharCode(...bytes.subarray(at, at + PIECE));
  return btoa(letters);
}

const escaped = (text: string): string =>
  text
    .replace(/[^\t\n\r\x20-\ud7ff\ue000-\ufffd\u{10000}-\u{10ffff}]/gu, '')
    .replaceAll('&', '&amp;')
    .replaceAll('<', '&lt;')
    .replaceAll('>', '&gt;');

/** What a tag says. SVG may stand there as it is. */
const unescaped = (text: string): string => {
  if (text.includes('<')) return text;
  return text
    .replaceAll('&lt;', '<')
    .replaceAll('&gt;', '>')
    .replaceAll('&quot;', '"')
    .replaceAll('&apos;', "'")
    .replaceAll('&amp;', '&');
};
