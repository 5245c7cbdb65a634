// Runs the examples of docs/user/web-package.md that are marked `js studio`, in a folder that has the package and a project.
//
// usage: node documents.mjs PAGE OUT
//
// Writes each example into OUT and prints its path; who calls runs them there.
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

const [page, out] = process.argv.slice(2);
const examples = [...readFileSync(page, 'utf8').matchAll(/^```js studio\n(.*?)^```$/gms)];
examples.forEach(([, code], number) => {
  const path = join(out, `example-${number}.mjs`);
  writeFileSync(path, code);
  console.log(path);
});
