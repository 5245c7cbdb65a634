// Files and folders of the computer, where the browser lets a page ask for them (File System API).
//
// Owns what the page needs of it beside what TypeScript knows. A browser without it has none of these.

type Mode = { mode: 'read' | 'readwrite' };

interface Asking {
  queryPermission?: (mode: Mode) => Promise<PermissionState>;
  requestPermission?: (mode: Mode) => Promise<PermissionState>;
}

interface Pickers {
  showOpenFilePicker?: (options: object) => Promise<FileSystemFileHandle[]>;
  showDirectoryPicker?: (options: object) => Promise<FileSystemDirectoryHandle>;
}

interface Walked {
  values: () => AsyncIterable<FileSystemDirectoryHandle | FileSystemFileHandle>;
}

const pickers = window as Window & Pickers;

export const canChoose = (): boolean => pickers.showOpenFilePicker !== undefined;
export const canChooseFolder = (): boolean => pickers.showDirectoryPicker !== undefined;

/** A project or a program with text that a person chooses; undefined: none. It fails where the browser allows no question. */
export async function chosen(): Promise<FileSystemFileHandle | undefined> {
  const types = [{ accept: { 'application/zip': ['.qrs'], 'text/plain': ['.py', '.js'] } }];
  return unlessGivenUp(async () => (await pickers.showOpenFilePicker?.({ id: 'trik', types }))?.[0]);
}

/** A folder that a person chooses; undefined: none. */
export async function chosenFolder(): Promise<FileSystemDirectoryHandle | undefined> {
  return unlessGivenUp(async () => pickers.showDirectoryPicker?.({ id: 'trik', mode: 'read' }));
}

/** What is in a folder, as it comes. */
export function walk(folder: FileSystemDirectoryHandle): AsyncIterable<FileSystemHandle> {
  return (folder as unknown as Walked).values();
}

/** Whether the page may write to a file; a person is asked if that is not known. */
export async function mayWrite(handle: FileSystemFileHandle): Promise<boolean> {
  const asking = handle as Asking;
  const mode: Mode = { mode: 'readwrite' };
  const known = (await asking.queryPermission?.(mode)) ?? 'granted';
  if (known !== 'prompt') return known === 'granted';
  return (await asking.requestPermission?.(mode)) === 'granted';
}

async function unlessGivenUp<T>(ask: () => Promise<T | undefined>): Promise<T | undefined> {
  try {
    return await ask();
  } catch (error) {
    if (error instanceof DOMException && error.name === 'AbortError') return undefined;
    throw error;
  }
}
