// What of others is in the page, with the texts that must go with it, as the file licences.txt beside it.
//
// Owns finding the packages: those of which the builder has taken a module.
import { existsSync, readdirSync, readFileSync } from 'node:fs';
import { dirname, join } from 'node:path';

/** Licences that a package may have; another one is a decision of people. */
const ALLOWED = ['MIT', 'ISC', 'BSD-2-Clause', 'BSD-3-Clause', 'Apache-2.0'];

/** The folder of the package that a module is of; undefined for our own. */
function folder(module) {
  if (!module.includes('/node_modules/')) return undefined;
  let at = dirname(module);
  while (!(existsSync(join(at, 'package.json')) && JSON.parse(readFileSync(join(at, 'package.json'))).name)) {
    at = dirname(at);
  }
  return at;
}

/** A name, a licence, its text. */
function notice(at) {
  const { name, version, license } = JSON.parse(readFileSync(join(at, 'package.json')));
  const file = readdirSync(at).find((one) => /^licen[cs]e/i.test(one));
  if (!ALLOWED.includes(license)) {
    throw new Error(`${name} has the licence ${license}, and the page takes ${ALLOWED.join(', ')}`);
  }
  const text = file ? readFileSync(join(at, file), 'utf8').trim() : 'Its package has no text of it.';
  return `${name} ${version}, ${license}\n\n${text}\n`;
}

export function licences() {
  return {
    name: 'licences',
    generateBundle(_, bundle) {
      const modules = Object.values(bundle).flatMap((chunk) =>
        chunk.type === 'chunk' ? chunk.moduleIds : [],
      );
      const clean = modules
        .map((id) => id.replace(/^\0/, '').replace(/\?.*$/, ''))
        .filter((id) => id.startsWith('/'));
      const folders = [...new Set(clean.map(folder))].filter((at) => at !== undefined).sort();
      const source = `What of others is in this page.\n\n${folders.map(notice).join('\n----\n\n')}`;
      this.emitFile({ type: 'asset', fileName: 'licences.txt', source });
    },
  };
}
