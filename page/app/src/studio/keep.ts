// What this browser keeps of projects that are not saved, so that a page that was closed loses nothing.
//
// Owns the places in the browser's database: one for each tab, so that two tabs do not take each other's work away. Where the
// browser allows none, nothing is kept, and nothing else happens.

export interface Kept {
  name: string;
  bytes: Uint8Array;
  /** Somebody has it as a file, too. */
  isSaved: boolean;
  /** The world of a program with text. */
  world?: string;
}

/** What is kept of a tab. */
interface Place extends Kept {
  /** Each page of a server has its own, so that two tasks do not meet. */
  page: string;
  at: number;
}

const STORE = 'projects';
const NAME = 'trik-studio';
/** Of closed tabs; older ones go. */
const PLACES_MAX = 20;

/** This tab: the same after it was loaded again. */
const tab = ((): string => {
  try {
    const known = sessionStorage.getItem(NAME) ?? crypto.getRandomValues(new Uint32Array(2)).join('-');
    sessionStorage.setItem(NAME, known);
    return known;
  } catch {
    return 'one';
  }
})();

// There are none without a secure connection.
const locks = navigator.locks as LockManager | undefined;
// As long as it is held, another tab knows that this one is there.
void locks?.request(`${NAME}-${tab}`, () => new Promise(() => undefined));

function opened(): Promise<IDBDatabase> {
  return new Promise((done, failed) => {
    const asked = indexedDB.open(NAME, 1);
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

export async function keep({ name, bytes, isSaved, world }: Kept): Promise<void> {
  const place: Place = { name, bytes, isSaved, page: location.pathname, at: Date.now() };
  if (world !== undefined) place.world = world;
  await within('readwrite', (store) => store.put(place, tab)).catch(() => undefined);
}

/** Nothing of this tab is to be kept any more. */
export async function forget(): Promise<void> {
  await within('readwrite', (store) => store.delete(tab)).catch(() => undefined);
}

/** What was left in this tab, or else the newest that was left in one that is closed: it is of this tab from now on. */
export async function kept(): Promise<Kept | undefined> {
  try {
    const places = (await all()).filter(([, place]) => place.page === location.pathname);
    const own = places.find(([key]) => key === tab);
    if (own) return own[1];
    const held = new Set((await locks?.query())?.held?.map(({ name }) => name));
    const [newest, ...others] = places.filter(([key]) => !held.has(`${NAME}-${String(key)}`));
    for (const [key] of others.slice(PLACES_MAX)) await within('readwrite', (store) => store.delete(key));
    if (!newest) return undefined;
    await within('readwrite', (store) => store.delete(newest[0]));
    await keep(newest[1]);
    return newest[1];
  } catch {
    return undefined;
  }
}

/** All places, the newest first. */
async function all(): Promise<[key: IDBValidKey, place: Place][]> {
  const keys = await within('readonly', (store) => store.getAllKeys());
  const values: unknown[] = await within('readonly', (store) => store.getAll());
  const places = keys.map((key, at): [IDBValidKey, unknown] => [key, values[at]]);
  const good = places.filter((one): one is [IDBValidKey, Place] => isPlace(one[1]));
  return good.toSorted(([, one], [, other]) => other.at - one.at);
}

function isPlace(found: unknown): boolean {
  const is = found as Partial<Place> | undefined;
  return typeof is?.name === 'string' && is.bytes instanceof Uint8Array && typeof is.at === 'number';
}
