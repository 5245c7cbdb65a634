// The last minutes of a robot, as its black box has them: a whole recording that comes in pieces.
//
// Owns a connection of its own, because over one connection one recording comes at a time.

import { FILE_BYTES_MAX, SILENCE_MS } from '../limits';
import { Link } from '../link/link';
import { Wrong } from './wrong';

const PIECE = 'stream:';
const ERROR = 'error: ';
/** What a refusal ends with that is none for long. */
const AGAIN = 'try again';
const AGAIN_MS = 500;
const TRIES = 10;

/** The robot has said in words why there are no minutes; empty: it said nothing. */
export class Refused extends Error {}

/** Asks for them; `told` is told how many bytes have come, and says whether to go on. Undefined comes out if not. */
export function lastMinutes(
  address: string,
  told: (bytes: number) => boolean,
): Promise<Uint8Array<ArrayBuffer> | undefined> {
  const pieces: Uint8Array[] = [];
  let count = 0;
  let tries = TRIES;
  const decoder = new TextDecoder();
  return new Promise((done, fail) => {
    const watch = () => setTimeout(() => end(() => fail(new Refused(''))), SILENCE_MS);
    let timer = watch();
    const end = (say: () => void): void => {
      clearTimeout(timer);
      link.close();
      say();
    };
    const piece = (bytes: Uint8Array): void => {
      clearTimeout(timer);
      timer = watch();
      count += bytes.length;
      if (!told(count)) end(() => done(undefined));
      else if (count > FILE_BYTES_MAX) end(() => fail(new Wrong('large', FILE_BYTES_MAX)));
      else if (bytes.length === 0) end(() => done(joined(pieces, count)));
      else pieces.push(bytes);
    };
    // It may be saving them already, because a program has failed.
    const refused = (why: string): void => {
      if (!why.includes(AGAIN) || --tries < 0) end(() => fail(new Refused(why)));
      else setTimeout(() => link.request('box'), AGAIN_MS);
    };
    const link: Link = new Link(address, {
      connected: (is) => {
        if (!is) end(() => fail(new Refused('')));
      },
      news: (news) => {
        if (news.is === 'robot' && news.there) link.request('box');
        else if (news.is === 'robot') end(() => fail(new Refused(news.why ?? '')));
        else if (news.is === 'refused') end(() => fail(new Refused(news.why)));
      },
      message: (bytes) => {
        const head = decoder.decode(bytes.subarray(0, PIECE.length));
        if (head === PIECE) piece(bytes.subarray(PIECE.length));
        else if (head === ERROR) refused(decoder.decode(bytes.subarray(ERROR.length)));
      },
    });
  });
}

function joined(pieces: readonly Uint8Array[], count: number): Uint8Array<ArrayBuffer> {
  const all = new Uint8Array(count);
  let at = 0;
  for (const piece of pieces) {
    all.set(piece, at);
    at += piece.length;
  }
  return all;
}
