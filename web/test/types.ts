// Every call of the package with its types; it is compiled and never run.
import {
  blank,
  edit,
  lint,
  open,
  palette,
  runnable,
  script,
  type Answer,
  type Change,
  type Finding,
  type Judged,
  type Project,
  type State,
} from 'trik-studio-web';

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
  must(run.patch(project));
  const places: Float64Array = run.way(0);
  console.log(places.length);
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

export function asked(text: string, world: string): Judged | undefined {
  const run = must(script('p.py', must(runnable('p.py', text)), { seed: 2 }));
  let told: string = run.ask('event', '100', 2);
  while (told === 'later') told = run.goOn(2);
  const scene = run.scene();
  console.log(world, scene.robots.length, run.state().threads[0]?.line, run.news().messages, run.remarks().join(), run.way(0).length);
  run.end();
  const over = run.outcome();
  run.free();
  return over;
}

// @ts-expect-error There is no such language.
export const wrong = (project: Project) => project.generate('basic');
// @ts-expect-error Nor such an option.
export const strange = (project: Project) => project.judge({ time: 5 });
// @ts-expect-error And an answer may be an error.
export const careless = (project: Project) => project.judge().value;

export function drawing(name: string, bytes: Uint8Array, changes: Change[]): Uint8Array {
  const draft = must(bytes.length > 0 ? edit(name, bytes, { locale: 'ru' }) : blank(name, { kit: 'trikV6Kit' }));
  const titles: string[] = must(palette({ locale: 'ru' })).map(({ title }) => title);
  for (const change of changes) must(draft.apply(change, 'ru'));
  const { diagrams, undo } = draft.about();
  const sheet = draft.sheet(diagrams[0]?.id ?? '', 'ru');
  const copied = must(draft.copy(sheet?.blocks.map(({ id }) => id) ?? []));
  console.log(titles, undo, copied.links.length, draft.world(), draft.names()[0]?.is, draft.undo(), draft.redo());
  const findings: Finding[] = draft.lint('ru');
  must(draft.project({ locale: 'ru' })).free();
  const saved = must(draft.save());
  draft.free();
  return findings.length > 0 ? new Uint8Array() : saved;
}
