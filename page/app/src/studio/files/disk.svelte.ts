// The project as a file of this computer: opened, and written where it was opened; and the folder beside it.
//
// Owns which file the project is, and whether somebody else has changed it meanwhile. Knows no elements.

import { EDIT_FILE_MB_MAX, FOLDER_ENTRIES_MAX, FOLDER_FILES_MAX } from '../../limits';
import type { Studio } from '../studio.svelte';
import { words as all } from '../words';
import { chosenFolder, mayWrite, walk } from './picker';
import { words } from './words';

/** A file, as it was when it was read or written last. */
interface OnDisk {
  handle: FileSystemFileHandle;
  lastModified: number;
  size: number;
  /** Of which project of the page it is. */
  opened: number;
}

export interface Folder {
  name: string;
  handle: FileSystemDirectoryHandle;
  /** Projects in it, by name. */
  files: FileSystemFileHandle[];
  /** There are more, which are not listed. */
  isCut: boolean;
}

/** Why a project is not written where it was opened. */
export interface Question {
  why: string;
  /** It may be written all the same. */
  mayForce: boolean;
}

export class Disk {
  folder = $state.raw<Folder | undefined>(undefined);
  question = $state.raw<Question | undefined>(undefined);
  #last: Promise<unknown> = Promise.resolve();
  #file = $state.raw<OnDisk | undefined>(undefined);

  constructor(private readonly studio: Studio) {}

  /** The file in which the project is; undefined: it is in none, or has another name now. */
  get #here(): OnDisk | undefined {
    const { studio } = this;
    const file = this.#file;
    return file?.opened === studio.opened && file.handle.name === studio.name ? file : undefined;
  }

  /** Whether this is the file of the project. */
  isHere(handle: FileSystemFileHandle): boolean {
    return this.#here?.handle === handle;
  }

  async open(handle: FileSystemFileHandle): Promise<void> {
    const { studio } = this;
    try {
      const file = await handle.getFile();
      if (file.size > EDIT_FILE_MB_MAX << 20) {
        studio.refusal = all.notOpened(handle.name, all.tooLarge(EDIT_FILE_MB_MAX));
        return;
      }
      const bytes = new Uint8Array(await file.arrayBuffer());
      await studio.ready;
      const before = studio.opened;
      this.question = undefined;
      await studio.open(handle.name, bytes);
      if (studio.opened !== before) this.#keep(handle, file);
    } catch (error) {
      studio.refusal = all.notOpened(handle.name, String(error));
    }
  }

  /**
   * Writes the project where it was opened; whether that is settled, or somebody is asked. Else it has no file. `isForced` writes
   * over what somebody else has changed.
   */
  async save(bytes: Uint8Array, isForced = false): Promise<boolean> {
    // One after the other: the second finds what the first has written.
    const saved = this.#last.then(() => this.#save(bytes, isForced));
    this.#last = saved;
    return saved;
  }

  async #save(bytes: Uint8Array, isForced: boolean): Promise<boolean> {
    const here = this.#here;
    this.question = undefined;
    if (!here) return false;
    const { handle } = here;
    try {
      if (!(await mayWrite(handle))) {
        this.question = { why: words.denied(handle.name), mayForce: false };
        return true;
      }
      const now = await handle.getFile();
      const isSame = now.lastModified === here.lastModified && now.size === here.size;
      if (!isSame && !isForced) {
        this.question = { why: words.changed(handle.name), mayForce: true };
        return true;
      }
      await write(handle, bytes);
      this.#keep(handle, await handle.getFile());
      await this.studio.saved(words.saved(handle.name));
    } catch (error) {
      const isGone = error instanceof DOMException && error.name === 'NotFoundError';
      const why = isGone ? words.gone(handle.name) : words.notWritten(handle.name, String(error));
      this.question = { why, mayForce: false };
    }
    return true;
  }

  async chooseFolder(): Promise<void> {
    try {
      const handle = await chosenFolder();
      if (handle) await this.#list(handle);
    } catch (error) {
      this.studio.refusal = words.noFolder(String(error));
    }
  }

  /** Looks into the folder again. */
  async lookAgain(): Promise<void> {
    const { folder } = this;
    if (!folder) return;
    try {
      await this.#list(folder.handle);
    } catch (error) {
      this.studio.refusal = words.noFolder(String(error));
      this.folder = undefined;
    }
  }

  async #list(handle: FileSystemDirectoryHandle): Promise<void> {
    const found: FileSystemFileHandle[] = [];
    let entries = 0;
    let isCut = false;
    for await (const entry of walk(handle)) {
      entries += 1;
      isCut = entries > FOLDER_ENTRIES_MAX || found.length >= FOLDER_FILES_MAX;
      if (isCut) break;
      if (entry instanceof FileSystemFileHandle && entry.name.endsWith('.qrs')) found.push(entry);
    }
    const files = found.toSorted((one, other) =>
      one.name.localeCompare(other.name, undefined, { numeric: true }),
    );
    // The file that is open is known by the handle with which it was opened.
    const same = await Promise.all(files.map((one) => this.#file?.handle.isSameEntry(one)));
    const at = same.indexOf(true);
    if (at >= 0 && this.#file) files[at] = this.#file.handle;
    this.folder = { name: handle.name, handle, files, isCut };
  }

  #keep(handle: FileSystemFileHandle, { lastModified, size }: File): void {
    this.#file = { handle, lastModified, size, opened: this.studio.opened };
  }
}

/** All of it, or nothing. */
async function write(handle: FileSystemFileHandle, bytes: Uint8Array): Promise<void> {
  const stream = await handle.createWritable();
  try {
    await stream.write(bytes.slice());
    await stream.close();
  } catch (error) {
    await stream.abort().catch(() => undefined);
    throw error;
  }
}
