// A viewer without a browser: a WebSocket that asks for all values, as the page does, and counts what comes.
//
// Owns its frames. Thirty browsers on one machine would measure the browsers.

import { connect } from 'node:net';

const PING = 9;
const PONG = 10;
const TEXT = 1;
const BINARY = 2;

/** @param {number} kind @param {Buffer} payload */
function frame(kind, payload) {
  if (payload.length >= 126) throw new Error('a viewer says little');
  // Masked by zeros.
  return Buffer.concat([Buffer.from([0x80 | kind, 0x80 | payload.length, 0, 0, 0, 0]), payload]);
}

export class Viewer {
  bytes = 0;
  /** Pieces of the recording that came. */
  pieces = 0;
  /** @type {import('node:net').Socket} */
  #socket;
  #kept = Buffer.alloc(0);
  #isOpen = false;
  #onPiece;

  /**
   * @param {URL} url
   * @param {string} cookie
   * @param {(piece: Buffer) => void} onPiece
   */
  constructor(url, cookie, onPiece) {
    this.#onPiece = onPiece;
    this.#socket = connect(Number(url.port), url.hostname);
    this.#socket.setNoDelay(true);
    this.#socket.write(
      `GET /socket HTTP/1.1\r\nHost: ${url.host}\r\nCookie: ${cookie}\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n` +
        'Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n',
    );
    this.#socket.on('data', (data) => this.#read(data));
    this.#socket.on('error', () => undefined);
  }

  /**
   * One that looks at everything.
   * @param {string} page
   * @param {(piece: Buffer) => void} onPiece
   */
  static async open(page, onPiece = () => undefined) {
    const answer = await fetch(page);
    await answer.arrayBuffer();
    const cookie = (answer.headers.get('set-cookie') ?? '').split(';')[0] ?? '';
    return new Viewer(new URL(page), cookie, onPiece);
  }

  /** Reads no more: what is sent stays with the server. */
  sleep() {
    this.#socket.pause();
  }

  close() {
    this.#socket.destroy();
  }

  /** @param {Buffer} data */
  #read(data) {
    this.bytes += data.length;
    this.#kept = this.#kept.length === 0 ? data : Buffer.concat([this.#kept, data]);
    if (!this.#isOpen) {
      const end = this.#kept.indexOf('\r\n\r\n');
      if (end < 0) return;
      if (!this.#kept.subarray(0, 13).equals(Buffer.from('HTTP/1.1 101 '))) {
        throw new Error(this.#kept.subarray(0, end).toString());
      }
      this.#kept = this.#kept.subarray(end + 4);
      this.#isOpen = true;
    }
    for (let message = this.#next(); message; message = this.#next()) this.#hear(message);
  }

  /** The next frame, if it is whole. */
  #next() {
    const kept = this.#kept;
    if (kept.length < 2) return undefined;
    let [length, from] = [(kept[1] ?? 0) & 0x7f, 2];
    if (length === 126) {
      if (kept.length < 4) return undefined;
      [length, from] = [kept.readUInt16BE(2), 4];
    } else if (length === 127) {
      if (kept.length < 10) return undefined;
      [length, from] = [Number(kept.readBigUInt64BE(2)), 10];
    }
    if (kept.length < from + length) return undefined;
    this.#kept = kept.subarray(from + length);
    return { kind: (kept[0] ?? 0) & 0x0f, payload: kept.subarray(from, from + length) };
  }

  /** @param {{ kind: number; payload: Buffer }} message */
  #hear({ kind, payload }) {
    if (kind === PING) this.#socket.write(frame(PONG, payload));
    else if (kind === TEXT && payload.includes('"is":"robot"') && payload.includes('"there":true')) {
      this.#socket.write(frame(BINARY, Buffer.from('stream:;hz=60')));
    } else if (kind === BINARY && payload.subarray(0, 7).toString() === 'stream:') {
      this.pieces += 1;
      this.#onPiece(payload);
    }
  }
}
