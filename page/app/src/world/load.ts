// A file with a world that a person gives to the page, as an order.
//
// Owns the words of the order. What is in the file is checked by the simulator.

/** The order that loads a world of these bytes. */
export function loadOrder(bytes: Uint8Array): string {
  const pieces: string[] = [];
  const size = 0x8000;
  for (let at = 0; at < bytes.length; at += size) {
    pieces.push(String.fromCharCode(...bytes.subarray(at, at + size)));
  }
  return `load ${btoa(pieces.join(''))}`;
}
