// What a program in JavaScript has thrown, as a text with its line: `Line 3: TypeError: ...`, and the calls that led there.
//
// Owns the forms in which browsers write a stack. Knows no Worker.

/** Calls that are told. */
const CALLS = 20;
/** Characters of what was thrown. */
const LONG = 2000;

interface Call {
  name: string;
  line: number;
}

/** `    at name (blob:...:3:10)` of Chromium, `name@blob:...:3:10` of Firefox and Safari. */
function call(text: string, file: string): Call | undefined {
  const at = text.indexOf(file);
  if (at < 0) return undefined;
  const place = /^:(\d+):\d+/.exec(text.slice(at + file.length));
  if (!place) return undefined;
  const before = text.slice(0, at).replace(/^\s*at /, '');
  const name = before.replace(/[@(\s]+$/, '').replace(/^(?:async |new )/, '');
  return { name, line: Number(place[1]) };
}

function words(thrown: unknown): string {
  try {
    if (thrown instanceof Error) {
      const [name, message] = [String(thrown.name), String(thrown.message)];
      if (name === '' || message === '') return name + message;
      return `${name}: ${message}`;
    }
    return String(thrown);
  } catch {
    // Its own toString() throws.
    return 'something that has no text';
  }
}

function stack(thrown: unknown): string {
  try {
    return thrown instanceof Error ? String(thrown.stack) : '';
  } catch {
    return '';
  }
}

/** As the robot's own engine tells it. `file` is how stacks name the program, and `top` how they name its own text. */
export function told(thrown: unknown, file: string, top: string): string {
  const said = words(thrown).slice(0, LONG);
  const calls = stack(thrown)
    .split('\n')
    .map((text) => call(text, file))
    .filter((found) => found !== undefined);
  const [innermost] = calls;
  if (!innermost) return said;
  const shown = calls.slice(0, CALLS).map(({ name, line }) => {
    const own = name === '' || name.endsWith(top) ? '<global>' : name.replace(/^(?:globalThis|Object)\./, '');
    return `\n${own}() at ${line}`;
  });
  const more = calls.length > CALLS ? '\n...' : '';
  return `Line ${innermost.line}: ${said}${shown.join('')}${more}`;
}
