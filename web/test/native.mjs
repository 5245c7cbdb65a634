// What `trik` of this computer says of a file.
//
// Owns how the program is started and what of its output is read. Knows no package.
import { execFile } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, existsSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

const MOST = 64 << 20;

/** Runs it; what it printed, whatever its exit code is. */
function run(trik, words) {
  return new Promise((resolve, reject) => {
    execFile(trik, words, { maxBuffer: MOST }, (error, stdout, stderr) => {
      if (error && typeof error.code !== 'number') {
        reject(error);
      } else {
        resolve({ code: error ? error.code : 0, stdout, stderr });
      }
    });
  });
}

/** Judges a project: the row of its results, and the files that it wrote; null for one that it did not write. */
export async function check(trik, project, { field, modelSeconds, locale = 'en' }) {
  const folder = mkdtempSync(join(tmpdir(), 'trik-web-'));
  try {
    const [report, trajectory] = ['report', 'trajectory'].map((name) => join(folder, name));
    const words = ['check', project, '--results', '-', '--report', report, '--trajectory', trajectory];
    words.push('--language', locale);
    if (field) {
      words.push('--field', field);
    }
    if (modelSeconds !== undefined) {
      words.push('--time-limit', String(modelSeconds));
    }
    const { stdout, stderr } = await run(trik, words);
    const read = (path) => (existsSync(path) ? readFileSync(path, 'utf8') : null);
    if (!stdout) {
      throw new Error(`trik check ${project}: ${stderr}`);
    }
    return { row: JSON.parse(stdout), report: read(report), trajectory: read(trajectory) };
  } finally {
    rmSync(folder, { recursive: true });
  }
}

/** What is wrong with files: an object for each finding. */
export async function lint(trik, files) {
  const { stdout } = await run(trik, ['lint', '--json', ...files]);
  return stdout.split('\n').filter(Boolean).map((line) => JSON.parse(line));
}

/** What a command prints; null if it refuses. */
export async function printed(trik, words) {
  const { code, stdout } = await run(trik, words);
  return code === 0 ? stdout : null;
}
