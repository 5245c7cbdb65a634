// A project in an address: the part after `#`, which no server is ever sent.
//
// Owns its form: `#project=NAME:BYTES`, the bytes of a save that is compressed as a whole, in base64 as addresses have it
// (RFC 4648, section 5).

import { EDIT_FILE_MB_MAX, LINK_KIB_MAX } from '../limits';

const BEGIN = '#project=';

export interface Shared {
  name: string;
  bytes: Uint8Array;
}

export function isLink(hash: string): boolean {
  return hash.startsWith(BEGIN);
}

/**
 * The address of this page with a project in it, of which the bytes are a save that is not compressed; undefined if that is too long
 * for an address.
 */
export async function toLink(page: string, { name, bytes }: Shared): Promise<string | undefined> {
  const packed = await passed(bytes, new CompressionStream('deflate-raw'), Infinity);
  if (packed.length > LINK_KIB_MAX * 1024) return undefined;
  let text = '';
  for (const byte of packed) text += String.fromCharCode(byte);
  const digits = btoa(text).replaceAll('+', '-').replaceAll('/', '_').replaceAll('=', '');
  return `${page.replace(/#.*$/, '')}${BEGIN}${encodeURIComponent(name)}:${digits}`;
}

/** The project of an address; undefined if there is none. */
export async function fromLink(hash: string): Promise<Shared | undefined> {
  const [name, digits] = hash.slice(BEGIN.length).split(':');
  if (!name || !digits || digits.length > LINK_KIB_MAX * 1400) return undefined;
  try {
    const text = atob(digits.replaceAll('-', '+').replaceAll('_', '/'));
    const packed = Uint8Array.from(text, (letter) => letter.charCodeAt(0));
    const bytes = await passed(packed, new DecompressionStream('deflate-raw'), EDIT_FILE_MB_MAX << 20);
    return { name: decodeURIComponent(name), bytes };
  } catch {
    return undefined;
  }
}

/** Bytes after a stream; it fails once they are more than these. */
async function passed(
  bytes: Uint8Array,
  stream: CompressionStream | DecompressionStream,
  most: number,
): Promise<Uint8Array> {
  const parts: BlobPart[] = [];
  let length = 0;
  const reader = new Blob([bytes.slice()]).stream().pipeThrough(stream).getReader();
  for (;;) {
    const { done, value } = await reader.read();
    if (done) break;
    length += value.length;
    if (length > most) throw new Error('too long');
    parts.push(value);
  }
  return new Uint8Array(await new Blob(parts).arrayBuffer());
}
