// Where an error is, from what a run said about it.
//
// Owns the forms in which interpreters and the filesystem name a line. Knows no editor and no robot.

/** An error at a line of what is edited; the first line is 1. */
export interface Mark {
  line: number;
  text: string;
}

/** Marks that are kept. */
const MARKS = 50;

const escaped = (name: string): string => name.replace(/[.*+?^${}()|[\]\\]/g, '\\$&');

/** Errors of the configuration, in why the filesystem has refused it and in the faults of its nodes: `config:4: reason`. */
export function marksOfConfiguration(
  refusal: string,
  faults: Iterable<[path: string, fault: string]>,
): Mark[] {
  const all: [string, string][] = [];
  if (refusal) all.push(['', refusal]);
  all.push(...faults);
  const marks = new Map<string, Mark>();
  for (const [path, said] of all) {
    const found = /(?:^|[\s:])config:(\d{1,9}): (.*)/.exec(said);
    if (!found || marks.size >= MARKS) continue;
    const text = path ? `${path}: ${found[2]}` : (found[2] ?? '');
    const line = Number(found[1]);
    marks.set(`${line} ${text}`, { line, text });
  }
  return [...marks.values()];
}

/** The error of a program with this name, in what its run said last; none if the run has said of none. */
export function marksOfRun(name: string, said: string): Mark[] {
  const file = escaped(name.split('/').at(-1) ?? name);
  const line = (text: string | undefined) => Number(text);
  // A traceback of Python: its last place in this file is the deepest, and its last line the reason.
  const places = [...said.matchAll(new RegExp(`File "(?:[^"\n]*/)?${file}", line (\\d{1,9})`, 'g'))];
  const place = places.at(-1);
  if (place) {
    const reasons = said.slice(place.index).split('\n').slice(1);
    const reason = reasons.findLast(
      (text) => /^[A-Za-z_][\w.]*(:|$)/.test(text) && !text.startsWith('trik:'),
    );
    return [{ line: line(place[1]), text: reason ?? '' }];
  }
  // JavaScript of the robot.
  const script = /^Line (\d{1,9}): (.*)$/m.exec(said);
  if (script && /\.js$/.test(name)) return [{ line: line(script[1]), text: script[2] ?? '' }];
  // A program of data flow that cannot be read.
  const flow = /(?:^|: )(\d{1,9}):\d+ (.*)$/m.exec(said);
  if (flow && /\.flow$/.test(name)) return [{ line: line(flow[1]), text: flow[2] ?? '' }];
  // Lua, and what else names its file.
  const other = new RegExp(`(?:^|[\\s/])${file}:(\\d{1,9}):(?:\\d+:)? ?(.*)$`, 'm').exec(said);
  return other ? [{ line: line(other[1]), text: other[2] ?? '' }] : [];
}
