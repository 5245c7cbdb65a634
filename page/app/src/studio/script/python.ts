// Python in this Worker: pyodide from the server of the page, with the module `trik` in model time as under `trik check`.
//
// Owns how the engine is begun. What the program is told is known to virtual.py, and by whom to channel.py.

import trik from '../../../../../trikd/src/python/trik.py?raw';
import virtual from '../../../../../trik/src/script/virtual.py?raw';
import channel from './channel.py?raw';
import type { Link } from './link';

interface Pyodide {
  registerJsModule(name: string, module: object): void;
  runPython(text: string): unknown;
}

/** Where the program stands for Python, as it does on a robot. */
const FOLDER = '/home/root/trik/scripts';

/** Gets the engine, from this folder of the server. What it gives runs one program, to its end. */
export async function python(
  folder: string,
): Promise<(link: Link, name: string, text: string, seed: number) => void> {
  const { loadPyodide } = (await import(/* @vite-ignore */ `${folder}pyodide.mjs`)) as {
    loadPyodide(options: object): Promise<Pyodide>;
  };
  const silent = (): void => undefined;
  const engine = await loadPyodide({ indexURL: folder, stdout: silent, stderr: silent });
  return (link, name, program, seed) => {
    const ask = (word: string, text: string): string => link.raw(word, text);
    engine.registerJsModule('trik_link', { ask, module: trik, path: `${FOLDER}/${name}`, program, seed });
    engine.runPython(`${channel}\n${virtual}`);
  };
}
