// A robot somewhere in the network, as a person names it: the address of its studio.
//
// Owns what counts as an address. Nothing is asked of it from here: the browser goes there, and that studio asks its own robot.

/** The port of a page, if none is named. */
const PORT = 8000;
/** A name, four numbers, or an address of IPv6 in brackets, and perhaps a port. */
const ADDRESS = /^(?:http:\/\/)?([a-z0-9._-]+|\[[0-9a-f:.]+\])(?::(\d{1,5}))?\/?$/i;

/** The address of the studio of a robot, with a pairing code if there is one; undefined if a person has written something else. */
export function studioAt(text: string, code = ''): string | undefined {
  const [, host, port = String(PORT)] = ADDRESS.exec(text.trim()) ?? [];
  if (host === undefined || Number(port) < 1 || Number(port) > 65_535) return undefined;
  const digits = code.replace(/\s/g, '');
  const query = digits ? `?code=${encodeURIComponent(digits)}` : '';
  const address = `http://${host}:${port}/studio/${query}`;
  return URL.canParse(address) ? address : undefined;
}
