// Recorded runs: which project, in which world, for how long.
//
// Owns how a folder of recordings is read. What was recorded of a run is known to the tests of `sim`.
import { readFileSync, readdirSync } from 'node:fs';
import { join } from 'node:path';

/** Every recorded run below a folder. */
export function recorded(place) {
  const names = readdirSync(join(place, 'oracle')).filter((name) => name.endsWith('.json'));
  return names.sort().map((name) => {
    const run = JSON.parse(readFileSync(join(place, 'oracle', name), 'utf8'));
    const poses = run.poses_100ms;
    const end = poses.length ? poses[poses.length - 1][0] : 0;
    return {
      name: `${place}: ${name}`,
      project: join(place, run.project),
      field: run.field ? join(place, run.field) : undefined,
      // One that does not end by itself was recorded for a while.
      modelSeconds: run.ends_by_itself ? undefined : end / 1000,
    };
  });
}
