// Every call of the package with its types; it is compiled and never run.
import { lint, open, type Answer, type Finding, type Judged, type Project, type State } from 'trik-studio-web';

function must<T>(answer: Answer<T>): T {
  if (answer.ok) {
    return answer.value;
  }
  const worst: Finding | undefined = answer.error.problems[0];
  throw new Error(`${answer.error.kind}: ${worst?.message ?? ''}`);
}

export function everything(name: string, bytes: Uint8Array, field: string): [Judged, State, string] {
  const findings: Finding[] = must(lint(name, bytes, { locale: 'ru' }));
  const project: Project = must(open(name, bytes, { diagram: 'main' }));
  const about = project.about();
  const shown: string = must(project.show({ diagram: about.main ?? '', picture: true }));
  const { text, notes } = must(project.generate('python'));
  const judged: Judged = must(project.judge({ field, seed: 2, trajectory: true, inputs: ['1'] }));
  const run = must(project.run({ field, debug: true }));
  must(run.order('attach'));
  while (run.tick(2) === 'runs') {
    const [x, y, degrees] = run.state().world.robots[0]?.at ?? [0, 0, 0];
    const way: Float64Array = run.trail(x + y + degrees);
    const wall = run.scene().items.find((item) => item.is === 'wall');
    console.log(way.length, wall?.points, run.news().printed, run.reports().length, run.display().byteLength);
  }
  run.end();
  const state: State = run.state();
  const over: Judged | undefined = run.outcome();
  run.free();
  project.free();
  return [over ?? judged, state, shown + text + String(findings.length + notes.length)];
}

// @ts-expect-error There is no such language.
export const wrong = (project: Project) => project.generate('basic');
// @ts-expect-error Nor such an option.
export const strange = (project: Project) => project.judge({ time: 5 });
// @ts-expect-error And an answer may be an error.
export const careless = (project: Project) => project.judge().value;
