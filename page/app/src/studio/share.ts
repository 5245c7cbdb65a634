// A project in an address: the part after `#`, which no server is ever sent.
//
// Owns its form: `#project=NAME:BYTES`, the bytes in base64 as addresses have it (RFC 4648, section 5).

import { LINK_KIB_MAX } from '../limits';

const BEGIN = '#project=';

export interface Shared {
  name: string;
  bytes: Uint8Array;
}

export function isLink(hash: string): boolean {
  return hash.startsWith(BEGIN);
}

/** The address of this page with a project in it; undefined if that is too long for an address. */
export function toLink(page: string, { name, bytes }: Shared): string | undefined {
  if (bytes.length > LINK_KIB_MAX * 1024) return undefined;
  let text = '';
  for (const byte of bytes) text += String.fromCharCode(byte);
  const digits = btoa(text).replaceAll('+', '-').replaceAll('/', '_').replaceAll('=', '');
  return `${page.replace(/#.*$/, '')}${BEGIN}${encodeURIComponent(name)}:${digits}`;
}

/** The project of an address; undefined if there is none. */
export function fromLink(hash: string): Shared | undefined {
  const [name, digits] = hash.slice(BEGIN.length).split(':');
  if (name === undefined || digits === undefined || digits.length > LINK_KIB_MAX * 1400) return undefined;
  try {
    const text = atob(digits.replaceAll('-', '+').replaceAll('_', '/'));
    return { name: decodeURIComponent(name), bytes: Uint8Array.from(text, (letter) => letter.charCodeAt(0)) };
  } catch {
    return undefined;
  }
}
