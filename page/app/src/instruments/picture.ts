// Bytes that are a picture.
//
// Owns how one is told from other bytes; a browser looks at the rest of it.

const KINDS: { type: string; begin: number[] }[] = [
  { type: 'image/jpeg', begin: [0xff, 0xd8, 0xff] },
  { type: 'image/png', begin: [0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a] },
];

/** The type of a picture; undefined if the bytes are none. */
export function pictureType(bytes: Uint8Array): string | undefined {
  return KINDS.find(({ begin }) => begin.every((byte, at) => bytes[at] === byte))?.type;
}
