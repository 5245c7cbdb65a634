// Milliseconds that the package takes to judge a project, once for each round after one that warms up: for judge.rs.
//
// usage: node judge.mjs PACKAGE PROJECT FIELD ROUNDS
import { readFileSync } from 'node:fs';
import { join, resolve } from 'node:path';

const [folder, file, world, rounds] = process.argv.slice(2);
const studio = await import(join(resolve(folder), 'node.js'));
const project = studio.open('line.qrs', new Uint8Array(readFileSync(file))).value;
const field = readFileSync(world, 'utf8');
const times = [];
for (let round = 0; round <= Number(rounds); round++) {
  const began = performance.now();
  const { ok, value } = project.judge({ field });
  times.push(performance.now() - began);
  if (!ok || value.verdict !== 'accomplished') throw new Error(JSON.stringify(value));
}
console.log(JSON.stringify(times.slice(1)));
