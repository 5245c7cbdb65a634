// The drawing in a Worker, so that the page never waits for it: one draft, changed and looked at.

import init, * as web from 'trik-studio-web';
import type {
  Change,
  DraftState,
  DrawnLanguage,
  DrawnSheet,
  Finding,
  Language,
  Locale,
  NameFacts,
  OutlineLine,
  PaletteBlock,
  Scene,
  ScriptState,
} from './facts';
import { type Place, joined } from '../world/pictures';
import { serve } from './remote';

/** What a page shows of a draft after each change. */
export interface Drawing {
  state: DraftState;
  /** The diagram that is looked at; null if the draft has it no longer. */
  sheet: DrawnSheet | null;
}

/** What takes longer, and follows. */
export interface Looks {
  findings: Finding[];
  names: NameFacts[];
  /** The program as text, or why it cannot be written: line by line, with the blocks that each tells of, as far as these are known. */
  lines: OutlineLine[];
  isWritten: boolean;
}

let draft: web.Draft | undefined;
let locale: Locale = 'en';
/** The world of the task, in which everything is judged; undefined: there is none. */
let task: Place | undefined;

function now(diagram: string): Drawing {
  const state = must().about();
  const there = state.diagrams.some(({ id }) => id === diagram);
  const shown = there ? diagram : (state.diagrams[0]?.id ?? '');
  return { state, sheet: must().sheet(shown, locale) };
}

function must(): web.Draft {
  if (!draft) throw new Error('there is no draft');
  return draft;
}

/** In words, of an answer that has not come to be. */
function said(findings: Finding[]): string {
  return findings.map(({ block, message }) => (block ? `${block}: ${message}` : message)).join('\n');
}

function begin(answer: ReturnType<typeof web.blank>): Drawing | string {
  if (!answer.ok) return said(answer.error.problems);
  draft?.free();
  draft = answer.value;
  if (task === undefined) return now('');
  // It is there from the beginning: nobody takes it back.
  const name = draft.about().name;
  const changed = draft.apply({ do: 'world', ...task }, locale);
  const saved = changed.ok ? draft.save() : changed;
  const opened = saved.ok ? web.edit(name, saved.value, { locale }) : saved;
  draft.free();
  draft = undefined;
  if (!opened.ok) return said(opened.error.problems);
  draft = opened.value;
  return now('');
}

/** Findings with the names of blocks as they stand on the sheet. */
function named(findings: Finding[]): Finding[] {
  const { diagrams } = must().about();
  const titles = new Map<string, string>();
  if (findings.length > 0) {
    for (const { id } of diagrams)
      for (const { id: block, title, details } of must().sheet(id, locale)?.blocks ?? [])
        titles.set(block, details ? `${title}: ${details}` : title);
  }
  return findings.map((finding) => ({
    ...finding,
    block: titles.get(finding.object ?? '') ?? finding.block,
    diagram: diagrams.length > 1 ? finding.diagram : null,
  }));
}

const calls = {
  speak(language: Locale) {
    locale = language;
    const blocks = (of: DrawnLanguage): PaletteBlock[] => {
      const told = web.palette({ locale, language: of });
      return told.ok ? told.value : [];
    };
    return { diagram: blocks('diagram'), dataflow: blocks('dataflow') };
  },
  /** A text says why it is not opened; what was open stays then. */
  open: (name: string, bytes: Uint8Array) => begin(web.edit(name, bytes, { locale })),
  blank: (name: string, language: DrawnLanguage) => begin(web.blank(name, { locale, language })),
  see: (diagram: string) => now(diagram),
  apply(change: Change, diagram: string): { new: string[]; drawing: Drawing } | string {
    const made = must().apply(change, locale);
    if (!made.ok) return said(made.error.problems);
    return { new: made.value, drawing: now(diagram) };
  },
  undo: (diagram: string) => (must().undo(), now(diagram)),
  redo: (diagram: string) => (must().redo(), now(diagram)),
  /** The diagram with a block. */
  home: (block: string) => {
    const has = (id: string) =>
      must()
        .sheet(id, locale)
        ?.blocks.some((one) => one.id === block);
    return must()
      .about()
      .diagrams.find(({ id }) => has(id))?.id;
  },
  copy(ids: string[]) {
    const copied = must().copy(ids);
    return copied.ok ? copied.value : { blocks: [], links: [] };
  },
  save(): Uint8Array | string {
    const saved = must().save();
    return saved.ok ? saved.value : said(saved.error.problems);
  },
  /** The same with nothing compressed. */
  stored(): Uint8Array | string {
    const saved = must().stored();
    return saved.ok ? saved.value : said(saved.error.problems);
  },
  /** The text of the world, if there is one. */
  world: () => draft?.world(),
  /** The text of the images that it names. */
  images: () => draft?.images() ?? '',
  /** The world with its images in it; empty if there is none. */
  field: () => joined(draft?.world() ?? '', draft?.images() ?? ''),
  /** What is wrong with a world; empty if it can be run in. */
  wrongWith(world: string): string {
    const found = web.lint('world.xml', new TextEncoder().encode(world), { locale });
    if (!found.ok) return said(found.error.problems);
    return said(found.value.filter(({ level }) => level === 'error').slice(0, 3));
  },
  /** That of a project in a file; what is no project says why. */
  worldOf(name: string, bytes: Uint8Array): Place | string {
    const opened = web.edit(name, bytes, { locale });
    if (!opened.ok) return said(opened.error.problems);
    const place = { text: opened.value.world() ?? '', images: opened.value.images() ?? '' };
    opened.value.free();
    return place;
  },
  /** A world with the robot at its start, or why nothing runs in it. */
  preview(world: string): { scene: Scene; state: ScriptState } | string {
    const begun = web.script('preview.js', world, { locale });
    if (!begun.ok) return said(begun.error.problems);
    const seen = { scene: begun.value.scene(), state: begun.value.state() };
    begun.value.free();
    return seen;
  },
  /** The text of a program as its engine runs it. */
  runnable(name: string, text: string): string {
    const made = web.runnable(name, text);
    return made.ok ? made.value : text;
  },
  /** What is open is the task: its world is that of everything from now on. */
  setTask() {
    const [text, images] = [must().world(), must().images() ?? ''];
    task = text === undefined ? undefined : { text, images };
  },
  /** What is wrong with it, and the program as text from the diagram of this name on. */
  look(wanted: Language | 'sentences' | 'source', diagram: string): Looks {
    const findings = named(must().lint(locale));
    const names = must().names();
    const looks = (isWritten: boolean, lines: OutlineLine[]) => ({ findings, names, isWritten, lines });
    const wrong = (problems: Finding[]) => looks(false, [{ text: said(named(problems)), blocks: [] }]);
    const project = must().project({ locale });
    if (!project.ok) return wrong(project.error.problems);
    const shown =
      wanted === 'sentences'
        ? project.value.outline({ locale, diagram })
        : wanted === 'source'
          ? project.value.show({ locale, diagram, source: true })
          : project.value.generate(wanted, { locale });
    project.value.free();
    if (!shown.ok) return wrong(shown.error.problems);
    const { value } = shown;
    if (Array.isArray(value)) return looks(true, value);
    if (typeof value === 'string') return looks(true, [{ text: value, blocks: [] }]);
    const written = value.text.replace(/\n$/, '').split('\n');
    return looks(
      true,
      written.map((text, at) => ({ text, blocks: value.blocks[at] ?? [] })),
    );
  },
};

export type DraftCalls = typeof calls;

serve(calls, init());
