// What is taken from a Worker before a program of a person runs in it.
//
// Owns which names stay. The policy of the page is the wall; this makes the Worker look as a robot does, where there is no
// network and no page either.

/** What belongs to the language itself. */
const LANGUAGE = new Set(
  (
    'AggregateError Array ArrayBuffer AsyncDisposableStack Atomics BigInt BigInt64Array BigUint64Array Boolean DataView Date ' +
    'DisposableStack Error EvalError FinalizationRegistry Float16Array Float32Array Float64Array Function Infinity Int16Array ' +
    'Int32Array Int8Array Intl Iterator JSON Map Math NaN Number Object Promise Proxy RangeError ReferenceError Reflect RegExp ' +
    'Set String SuppressedError Symbol SyntaxError TypeError URIError Uint16Array Uint32Array Uint8Array Uint8ClampedArray ' +
    'WeakMap WeakRef WeakSet constructor decodeURI decodeURIComponent encodeURI encodeURIComponent escape eval globalThis ' +
    'isFinite isNaN parseFloat parseInt undefined unescape'
  ).split(' '),
);
/** Ways out of a Worker: to networks, to what the browser keeps, to the page. */
const OUTSIDE = new Set(
  (
    'BroadcastChannel EventSource MessageChannel MessagePort SharedWorker WebSocket WebSocketStream WebTransport Worker ' +
    'XMLHttpRequest caches close cookieStore fetch importScripts indexedDB navigator onmessage postMessage storage'
  ).split(' '),
);

function take(isTaken: (name: string) => boolean): void {
  let level = globalThis as object;
  while (level !== Object.prototype) {
    for (const name of Object.getOwnPropertyNames(level)) {
      if (!isTaken(name)) continue;
      // What cannot be taken away has no value any more, if that can be.
      if (!Reflect.deleteProperty(level, name))
        Reflect.defineProperty(level, name, { value: undefined, configurable: true, writable: true });
    }
    level = Object.getPrototypeOf(level) as object;
  }
}

/** Leaves the language, and nothing of a browser. */
export const leaveLanguage = (): void => take((name) => !LANGUAGE.has(name));

/** Leaves what an engine in this Worker may need, and no way out. */
export const leaveInside = (): void => take((name) => OUTSIDE.has(name));
