// What this browser keeps of a project that is not saved, so that a page that was closed loses nothing.
//
// Owns one place in the browser's database. Where the browser allows none, nothing is kept, and nothing else happens.

export interface Kept {
  name: string;
  bytes: Uint8Array;
}

const STORE = 'projects';
/** Each page of a server has its own, so that two tasks do not meet. */
const KEY = location.pathname;

function opened(): Promise<IDBDatabase> {
  return new Promise((done, failed) => {
    const asked = indexedDB.open('trik-studio', 1);
    asked.onupgradeneeded = () => asked.result.createObjectStore(STORE);
    asked.onsuccess = () => done(asked.result);
    asked.onerror = () => failed(asked.error ?? new Error('no database'));
  });
}

async function within<T>(
  mode: IDBTransactionMode,
  ask: (store: IDBObjectStore) => IDBRequest<T>,
): Promise<T> {
  const database = await opened();
  try {
    return await new Promise((done, failed) => {
      const asked = ask(database.transaction(STORE, mode).objectStore(STORE));
      asked.onsuccess = () => done(asked.result);
      asked.onerror = () => failed(asked.error ?? new Error('not kept'));
    });
  } finally {
    database.close();
  }
}

export async function keep(project: Kept): Promise<void> {
  await within('readwrite', (store) => store.put(project, KEY)).catch(() => undefined);
}

/** Nothing is to be kept any more. */
export async function forget(): Promise<void> {
  await within('readwrite', (store) => store.delete(KEY)).catch(() => undefined);
}

export async function kept(): Promise<Kept | undefined> {
  const found: unknown = await within('readonly', (store) => store.get(KEY)).catch(() => undefined);
  const is = found as Kept | undefined;
  return is && typeof is.name === 'string' && is.bytes instanceof Uint8Array ? is : undefined;
}
