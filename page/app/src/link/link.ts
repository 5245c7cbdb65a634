// The connection of this page to its server: it comes back by itself.
//
// Owns the socket. What is said over it is known to those who take it: words to `robot`, messages of the control port likewise.

import type { News, Order } from './words';

/** Who takes what comes. */
export interface Taker<Told = News> {
  /** The server is there, or not: then the next attempt follows. */
  connected(is: boolean): void;
  news(news: Told): void;
  /** A message of the robot's control port. */
  message(bytes: Uint8Array): void;
}

const SOONEST_MS = 250;
const LATEST_MS = 4000;
/** The server says something every second; after so long it is gone, and has brought to rest what was driven here. */
const SILENCE_MS = 4000;

export class Link<Told = News, Said = Order> {
  #socket: WebSocket | undefined;
  #lostOne: WebSocket | undefined;
  #wait = SOONEST_MS;
  #timer: ReturnType<typeof setTimeout> | undefined;
  #watch: ReturnType<typeof setTimeout> | undefined;
  readonly #encoder = new TextEncoder();

  constructor(
    private readonly address: string,
    private readonly taker: Taker<Told>,
  ) {
    this.#connect();
  }

  /** Says something to the server. False: it is not there. */
  order(order: Said): boolean {
    return this.#send(JSON.stringify(order));
  }

  /** Asks the robot's control port something. */
  request(request: string | Uint8Array<ArrayBuffer>): boolean {
    return this.#send(typeof request === 'string' ? this.#encoder.encode(request) : request);
  }

  /** Ends it for good. */
  close(): void {
    clearTimeout(this.#timer);
    clearTimeout(this.#watch);
    const socket = this.#socket;
    this.#socket = undefined;
    socket?.close();
  }

  #send(data: string | Uint8Array<ArrayBuffer>): boolean {
    if (this.#socket?.readyState !== WebSocket.OPEN) return false;
    this.#socket.send(data);
    return true;
  }

  /** A server that was started again has another cookie, which comes with the page. */
  async #again(): Promise<void> {
    try {
      await fetch('/', { cache: 'no-store' });
    } catch {
      // It is not there yet; the socket says so, and the next attempt follows.
    }
    if (this.#socket) this.#connect();
  }

  #connect(): void {
    const socket = new WebSocket(this.address);
    socket.binaryType = 'arraybuffer';
    this.#socket = socket;
    socket.onopen = () => {
      this.#wait = SOONEST_MS;
      this.taker.connected(true);
      this.#heard(socket);
    };
    socket.onmessage = ({ data }: MessageEvent<string | ArrayBuffer>) => {
      this.#heard(socket);
      if (typeof data === 'string') this.taker.news(JSON.parse(data) as Told);
      else this.taker.message(new Uint8Array(data));
    };
    socket.onclose = () => this.#lost(socket);
  }

  /** A connection that says nothing is none: its close may take minutes, so it is not waited for. */
  #heard(socket: WebSocket): void {
    clearTimeout(this.#watch);
    this.#watch = setTimeout(() => {
      this.#lost(socket);
      socket.close();
    }, SILENCE_MS);
  }

  #lost(socket: WebSocket): void {
    // It was ended here, replaced, or is known to be lost.
    if (this.#socket !== socket || this.#lostOne === socket) return;
    this.#lostOne = socket;
    clearTimeout(this.#watch);
    this.taker.connected(false);
    this.#timer = setTimeout(() => void this.#again(), this.#wait);
    this.#wait = Math.min(this.#wait * 2, LATEST_MS);
  }
}
