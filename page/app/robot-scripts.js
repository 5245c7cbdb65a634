// The scripts with which a robot's own engine begins (trikd/js), as modules for a Worker: `robot-script:base` and the others.
import { readFileSync } from 'node:fs';
import { resolve } from 'node:path';

const NAME = /^robot-script:(base|codes|robot|talk)$/;
const folder = resolve(import.meta.dirname, '../../trikd/js');

export function robotScripts() {
  return {
    name: 'robot-scripts',
    resolveId: (id) => (NAME.test(id) ? `\0${id}.js` : null),
    load(id) {
      const name = /^\0robot-script:(.*)\.js$/.exec(id)?.[1];
      if (name === undefined) return null;
      const file = resolve(folder, `${name}.js`);
      this.addWatchFile(file);
      // Each is one function, which may stand behind comments.
      return `export default ${readFileSync(file, 'utf8')}`;
    },
  };
}
