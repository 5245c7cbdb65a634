// A file with a world that a person gives to the page, as an order.
//
// Owns how large it may be. What is in it is checked by the simulator.

/** In megabytes. The server takes 6 MiB of an order, and Base64 has four letters for three bytes. */
export const FILE_MB_MAX = 4;

/** The order that loads a world of these bytes. */
export function loadOrder(bytes: Uint8Array): string {
  const pieces: string[] = [];
  const size = 0x8000;
  for (let at = 0; at < bytes.length; at += size) {
    pieces.push(String.fromCharCode(...bytes.subarray(at, at + size)));
  }
  return `load ${btoa(pieces.join(''))}`;
}
