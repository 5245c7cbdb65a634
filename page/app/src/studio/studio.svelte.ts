// The project that is drawn: what the page shows of it, and everything that changes it.
//
// Owns what is looked at and chosen. Knows no elements; the draft itself is in a Worker.

import { language } from '../words';
import { EDIT_FILE_MB_MAX, KEEP_AFTER_MS, LOOK_AFTER_MS, PASTE_SHIFT_PX } from '../limits';
import type {
  Change,
  DrawnBlock,
  DrawnLanguage,
  DrawnLink,
  DrawnSheet,
  Finding,
  Language,
  PaletteBlock,
  Piece,
  Ports,
} from './engine/facts';
import type { Drawing, DraftCalls, Looks } from './engine/drafts.worker';
import { Remote } from './engine/remote';
import { arranged } from './draw/arrange';
import { guardOfNext } from './draw/guards';
import { pieceOf } from './draw/piece';
import { arranged as flowArranged } from './flow/arrange';
import { through } from './flow/ports';
import { words as ofFlow } from './flow/words';
import { type Kept, keep, kept } from './keep';
import { PLAIN, type Point } from './run/point';
import { isScript } from './script/names';
import { fromLink, isLink } from './share';
import { words } from './words';
import { parted } from './world/pictures';

/** What of the project is in the middle of the page. */
export type Part = 'program' | 'world' | 'rules';

/** The part of a save in which findings of its world are. */
const WORLD_PART = 'worldModel';

const NONE: Looks = { findings: [], names: [], lines: [], isWritten: true };

export class Studio {
  #palettes = $state.raw<Record<DrawnLanguage, PaletteBlock[]>>({ diagram: [], dataflow: [] });
  drawing = $state.raw<Drawing | undefined>(undefined);
  looks = $state.raw<Looks>(NONE);
  /** Ids of blocks and links. */
  chosen = $state.raw<ReadonlySet<string>>(new Set());
  language = $state<Language | 'sentences' | 'source'>('sentences');
  /** Ids of blocks before which a run stops, and when. */
  breakpoints = $state.raw<ReadonlyMap<string, Point>>(new Map());
  part = $state<Part>('program');
  /** A finding of the world whose place is looked for. */
  sought = $state.raw<Finding | undefined>(undefined);
  /** What was not done, and why. */
  refusal = $state('');
  /** What was done. */
  notice = $state('');
  isReady = $state(false);
  /** Once there is a project to give up. */
  readonly ready: Promise<void>;
  #begun: () => void = () => undefined;
  /** How many projects were opened here. */
  opened = $state(0);
  /** There is a task: its world stays. */
  hasTask = $state(false);
  isSaved = $state(true);
  readonly #drafts: Remote<DraftCalls>;
  /** What is drawn is data flow: links go from port to port. */
  readonly isFlow = $derived(this.drawing?.state.language === 'dataflow');
  readonly palette = $derived(this.#palettes[this.isFlow ? 'dataflow' : 'diagram']);
  readonly #byKind = $derived(new Map(this.palette.map((block) => [block.kind, block])));
  #look: ReturnType<typeof setTimeout> | undefined;
  #lookNumber = 0;
  #keep: ReturnType<typeof setTimeout> | undefined;
  /** What was copied last, or is being copied. */
  #piece: Promise<Piece> | undefined;
  /** The same as text, for the clipboard. */
  #copied = '';
  #task: { name: string; bytes: Uint8Array } | undefined;

  constructor() {
    const worker = new Worker(new URL('./engine/drafts.worker.ts', import.meta.url), { type: 'module' });
    this.#drafts = new Remote<DraftCalls>(worker);
    this.ready = new Promise((done) => (this.#begun = done));
  }

  /** The Worker with the draft. */
  get drafts(): Remote<DraftCalls> {
    return this.#drafts;
  }

  /** A program with text that was left here. */
  left: Kept | undefined;

  /** The name of its file. */
  name = $state('');

  rename(name: string): void {
    const text = name.trim();
    if (text === '' || text === this.name) return;
    this.name = text.endsWith('.qrs') ? text : `${text}.qrs`;
    this.isSaved = false;
    this.#keepSoon();
  }

  get diagram(): string {
    return this.drawing?.sheet?.id ?? '';
  }

  get sheet(): DrawnSheet | null {
    return this.drawing?.sheet ?? null;
  }

  /** The type of blocks that call a subprogram. */
  get callKind(): string {
    return this.isFlow ? 'DFUserBlock' : 'Subprogram';
  }

  /** Blocks that the kit of the project has. */
  get offered(): PaletteBlock[] {
    const kit = this.drawing?.state.kit ?? 'trikV62Kit';
    return this.palette.filter(({ kits }) => kits.includes(kit));
  }

  facts(kind: string): PaletteBlock | undefined {
    return this.#byKind.get(kind);
  }

  /** Whether only the other language has such blocks. Those of other kits neither has. */
  #isOfOther(kind: string): boolean {
    const other = this.#palettes[this.isFlow ? 'diagram' : 'dataflow'];
    return !this.facts(kind) && other.some((one) => one.kind === kind);
  }

  block(id: string): DrawnBlock | undefined {
    return this.sheet?.blocks.find((block) => block.id === id);
  }

  /** The link that is chosen, if nothing else is. */
  get chosenLink(): DrawnLink | undefined {
    const [id] = this.chosen.size === 1 ? this.chosen : [];
    return this.sheet?.links.find((link) => link.id === id);
  }

  /** What is wrong with a block or link. */
  wrongWith(id: string): Finding[] {
    return this.looks.findings.filter(({ object }) => object === id);
  }

  /** Begins: with the project of the address, with what was left here, or with a new one. */
  async begin(hash: string): Promise<void> {
    try {
      this.#palettes = await this.#drafts.call('speak', language);
    } catch (error) {
      this.refusal = words.broken(String(error));
      return;
    }
    await this.#beginTask();
    const isLinked = isLink(hash) && (await this.openLink(hash));
    const left = isLinked ? undefined : await kept();
    if (left && isScript(left.name)) {
      this.left = left;
    } else if (left) {
      const why = this.refusal;
      await this.open(left.name, left.bytes);
      this.notice = words.kept(left.name);
      this.refusal = why;
      this.isSaved = left.isSaved;
    }
    if (!this.drawing) await this.blank();
    this.isReady = true;
    this.#begun();
  }

  /** Opens the project of an address, which then is in the page and no longer in its address. Whether there was one. */
  async openLink(hash: string): Promise<boolean> {
    history.replaceState(null, '', location.pathname + location.search);
    const shared = await fromLink(hash);
    const before = this.opened;
    if (shared) await this.open(shared.name, shared.bytes);
    if (this.opened === before) {
      this.refusal = words.linkWrong;
      return false;
    }
    // Nobody has it as a file yet.
    this.isSaved = false;
    this.#keepSoon();
    return true;
  }

  /** The task of the page, which `trik site --task` has named in it. */
  async #beginTask(): Promise<void> {
    const named = document.querySelector<HTMLMetaElement>('meta[name=trik-task]');
    if (!named) return;
    try {
      const answer = await fetch(named.content);
      if (!answer.ok) throw new Error(`${answer.status}`);
      const bytes = new Uint8Array(await answer.arrayBuffer());
      const name = named.dataset['name'] ?? named.content;
      await this.open(name, bytes, false);
      await this.#drafts.call('setTask');
      this.#task = { name, bytes };
      this.hasTask = true;
    } catch (error) {
      this.refusal = words.noTask(String(error));
    }
  }

  /** A new project, or the task from its beginning. */
  async blank(language: DrawnLanguage = 'diagram'): Promise<void> {
    const why = this.refusal;
    if (this.#task) {
      await this.open(this.#task.name, this.#task.bytes);
      return;
    }
    this.#show(await this.#drafts.call('blank', words.untitled, language));
    if (!this.isReady) this.refusal = why;
  }

  async open(name: string, bytes: Uint8Array, isKept = true): Promise<void> {
    if (bytes.length > EDIT_FILE_MB_MAX << 20) {
      this.refusal = words.notOpened(name, words.tooLarge(EDIT_FILE_MB_MAX));
      return;
    }
    const opened = await this.#drafts.call('open', name, bytes);
    if (typeof opened === 'string') {
      this.refusal = words.notOpened(name, opened);
      return;
    }
    this.#show(opened);
    if (isKept) this.#keepSoon();
    if (name.toLowerCase().endsWith('.flow')) this.notice = ofFlow.textOpened(name);
  }

  /** Looks at another diagram. */
  async see(diagram: string): Promise<void> {
    this.chosen = new Set();
    this.drawing = await this.#drafts.call('see', diagram);
    this.#lookSoon();
  }

  /** Looks at the diagram of this name, if there is one. */
  async seeNamed(diagram: string): Promise<void> {
    const wanted = this.drawing?.state.diagrams.find(({ name }) => name === diagram);
    if (wanted && wanted.id !== this.diagram) await this.see(wanted.id);
  }

  /** Changes the draft: ids of what is new. */
  async apply(change: Change): Promise<string[]> {
    const made = await this.#drafts.call('apply', change, this.diagram);
    if (typeof made === 'string') {
      this.refusal = made;
      // What a hand has moved goes back to where it is.
      if (this.drawing) this.drawing = { ...this.drawing };
      return [];
    }
    this.refusal = this.notice = '';
    this.#changed(made.drawing);
    return made.new;
  }

  async undo(): Promise<void> {
    this.refusal = this.notice = '';
    this.#changed(await this.#drafts.call('undo', this.diagram));
  }

  async redo(): Promise<void> {
    this.refusal = this.notice = '';
    this.#changed(await this.#drafts.call('redo', this.diagram));
  }

  /** Adds a block, perhaps into a link; it is chosen then. `calls` is the name of a subprogram. */
  async add(kind: string, at: [number, number], calls?: string, link?: string): Promise<void> {
    const name = this.facts(kind)?.title ?? '';
    const block = { kind, at, name, ...(calls ? { calls } : {}) };
    const ports = link ? this.#portsInto(link, kind) : undefined;
    const change: Change =
      link && (ports || !this.isFlow)
        ? { do: 'insert', link, block, ...(ports ? { ports } : { guard: guardOfNext(kind, []) }) }
        : { do: 'add', diagram: this.diagram, blocks: [block], links: [] };
    const made = await this.apply(change);
    if (made.length > 0) this.chosen = new Set(made.slice(0, 1));
  }

  /** By which ports a block of data flow goes into a link. */
  #portsInto(id: string, kind: string): Ports | undefined {
    const link = this.sheet?.links.find((one) => one.id === id);
    const port = (end: string | null, at: number | undefined) =>
      this.facts(this.block(end ?? '')?.kind ?? '')?.ports?.[at ?? -1];
    const gives = port(link?.from ?? null, link?.ports?.[0]);
    const takes = port(link?.to ?? null, link?.ports?.[1]);
    return gives && takes ? through(gives, takes, this.facts(kind)) : undefined;
  }

  /** Draws a link; of data flow from an output of the first block to an input of the second one. */
  async connect(from: string, to: string, ports?: Ports): Promise<void> {
    if (ports) {
      await this.apply({ do: 'connect', from, to, ports });
      return;
    }
    const block = this.block(from);
    const leaving = (this.sheet?.links ?? []).filter((link) => link.from === from);
    const guard = block ? guardOfNext(block.kind, leaving) : '';
    await this.apply({ do: 'connect', from, to, guard });
  }

  async remove(): Promise<void> {
    const ids = [...this.chosen];
    if (ids.length === 0) return;
    this.chosen = new Set();
    await this.apply({ do: 'remove', ids });
  }

  /** Copies what is chosen, over the clipboard of the computer too, so that another page gets it. */
  async copy(): Promise<void> {
    const ids = [...this.chosen].filter((id) => this.block(id));
    if (ids.length === 0) return;
    this.#piece = this.#drafts.call('copy', ids);
    const text = JSON.stringify(await this.#piece);
    this.#copied = text;
    // Without a secure connection there is no clipboard: then it is for this page alone.
    const clipboard = navigator.clipboard as Clipboard | undefined;
    await clipboard?.writeText(text).catch(() => undefined);
  }

  /** Puts what was copied a little beside its original, and again a little beside that. `text` is what the clipboard has. */
  async paste(text = ''): Promise<void> {
    const other = text === this.#copied ? undefined : pieceOf(text);
    // Of another page it may be anything; the draft refuses what is no block.
    const piece = other ?? (await this.#piece);
    if (!piece) return;
    if (piece.blocks.some(({ kind }) => this.#isOfOther(kind))) {
      this.refusal = words.otherLanguage[this.isFlow ? 'diagram' : 'dataflow'];
      return;
    }
    if (other) this.#copied = text;
    const blocks = piece.blocks.map((block) => ({
      ...block,
      at: [block.at[0] + PASTE_SHIFT_PX, block.at[1] + PASTE_SHIFT_PX] as [number, number],
    }));
    this.#piece = Promise.resolve({ blocks, links: piece.links });
    const made = await this.apply({ do: 'add', diagram: this.diagram, blocks, links: piece.links });
    this.chosen = new Set(made.slice(0, blocks.length));
  }

  /** Puts the blocks of the diagram in order. */
  async arrange(): Promise<void> {
    if (!this.sheet) return;
    const places = this.isFlow ? flowArranged(this.sheet) : arranged(this.sheet);
    await this.apply({ do: 'move', places });
  }

  async addSubprogram(): Promise<void> {
    const all = this.drawing?.state.diagrams ?? [];
    const names = new Set(all.map(({ name }) => name));
    let number = 1;
    while (names.has(words.subprogramName(number))) number += 1;
    const name = words.subprogramName(number);
    const [diagram] = await this.apply({ do: 'addDiagram', kind: 'subprogram', name });
    if (!diagram) return;
    await this.see(diagram);
    const block = (kind: string, x: number): Piece['blocks'][number] => ({
      kind,
      at: [x, 200],
      name: this.facts(kind)?.title ?? '',
    });
    const [first, last] = this.isFlow
      ? (['DFInPortBlock', 'DFOutPortBlock'] as const)
      : (['InitialNode', 'FinalNode'] as const);
    const blocks = [block(first, 100), block(last, 400)];
    await this.apply({ do: 'add', diagram, blocks, links: [] });
  }

  /** The project as a file. */
  async bytes(): Promise<Uint8Array | undefined> {
    const saved = await this.#drafts.call('save');
    if (typeof saved !== 'string') return saved;
    this.refusal = saved;
    return undefined;
  }

  /** The same with nothing compressed. */
  async stored(): Promise<Uint8Array | undefined> {
    const saved = await this.#drafts.call('stored');
    if (typeof saved !== 'string') return saved;
    this.refusal = saved;
    return undefined;
  }

  /** The text of its world, if it has one. */
  async world(): Promise<string | undefined> {
    return await this.#drafts.call('world');
  }

  /** The text of the images that it names; empty if there are none. */
  async images(): Promise<string> {
    return await this.#drafts.call('images');
  }

  /** What is wrong with the world and its rules. */
  get worldFindings(): Finding[] {
    return this.looks.findings.filter(({ part }) => part === WORLD_PART);
  }

  /** Shows another part; what was chosen in the last one is no longer. */
  turnTo(part: Part): void {
    if (part === this.part) return;
    this.part = part;
    this.chosen = new Set();
  }

  /** Puts the project into the world of a file: of a world, or of a project with one. */
  async loadWorld(file: File): Promise<void> {
    const { name } = file;
    const read = name.endsWith('.qrs')
      ? await this.#drafts.call('worldOf', name, new Uint8Array(await file.arrayBuffer()))
      : parted(await file.text());
    if (typeof read === 'string' || read.text === '') {
      this.refusal = words.notOpened(name, typeof read === 'string' ? read : words.worldless);
      return;
    }
    const { text, images } = read;
    const why = await this.#drafts.call('wrongWith', text);
    if (why) {
      this.refusal = words.notOpened(name, why);
      return;
    }
    await this.apply({ do: 'world', text, images });
    if (!this.refusal) this.notice = words.worldLoaded(name);
  }

  /** A run stops before this block, or does so no longer. */
  toggleBreakpoint(id: string): void {
    this.setBreakpoint(id, this.breakpoints.has(id) ? undefined : PLAIN);
  }

  /** When a run stops before this block; undefined: never. */
  setBreakpoint(id: string, point: Point | undefined): void {
    const others = [...this.breakpoints].filter(([one]) => one !== id);
    this.breakpoints = new Map(point ? [...others, [id, point]] : others);
  }

  /** Shows the program in another language. */
  write(language: Language | 'sentences' | 'source'): void {
    this.language = language;
    void this.#lookNow();
  }

  /** Where something is wrong: its diagram, with the block chosen. */
  async goTo(finding: Finding): Promise<void> {
    const { diagram, object } = finding;
    if (finding.part === WORLD_PART) {
      if (this.part === 'program') this.turnTo('world');
      this.sought = finding;
      return;
    }
    this.turnTo('program');
    await this.seeNamed(diagram ?? '');
    if (object) this.chosen = new Set([object]);
  }

  /** Chooses blocks, in the diagram of the first of them. */
  async choose(ids: readonly string[]): Promise<void> {
    this.turnTo('program');
    const [first] = ids;
    if (first !== undefined && !ids.some((id) => this.block(id))) {
      const home = await this.#drafts.call('home', first);
      if (home !== undefined) await this.see(home);
    }
    this.chosen = new Set(ids.filter((id) => this.block(id)));
  }

  #show(drawing: Drawing | string): void {
    if (typeof drawing === 'string') {
      this.refusal = drawing;
      return;
    }
    this.refusal = this.notice = '';
    this.chosen = new Set();
    this.breakpoints = new Map();
    this.drawing = drawing;
    this.part = 'program';
    this.name = drawing.state.name;
    this.isSaved = true;
    this.opened += 1;
    const isThere = this.isFlow ? ['source', 'lua', 'c'].includes(this.language) : this.language !== 'source';
    if (!isThere) this.language = 'sentences';
    void this.#lookNow();
  }

  #changed(drawing: Drawing): void {
    this.drawing = drawing;
    this.isSaved = false;
    const there = new Set([
      ...(drawing.sheet?.blocks ?? []).map(({ id }) => id),
      ...(drawing.sheet?.links ?? []).map(({ id }) => id),
    ]);
    if ([...this.chosen].some((id) => !there.has(id)))
      this.chosen = new Set([...this.chosen].filter((id) => there.has(id)));
    this.#lookSoon();
    this.#keepSoon();
  }

  #lookSoon(): void {
    clearTimeout(this.#look);
    this.#look = setTimeout(() => void this.#lookNow(), LOOK_AFTER_MS);
  }

  async #lookNow(): Promise<void> {
    clearTimeout(this.#look);
    const number = ++this.#lookNumber;
    const diagram = this.drawing?.state.diagrams.find(({ id }) => id === this.diagram);
    const looks = await this.#drafts.call('look', this.language, diagram?.name ?? '');
    // A later one has overtaken it.
    if (number !== this.#lookNumber) return;
    this.looks = looks;
  }

  /** Not at each change: a large project takes the Worker some pictures' time. */
  #keepSoon(): void {
    clearTimeout(this.#keep);
    this.#keep = setTimeout(() => void this.#keepNow(), KEEP_AFTER_MS);
  }

  async #keepNow(): Promise<void> {
    const bytes = await this.bytes();
    if (bytes) await keep({ name: this.name, bytes, isSaved: this.isSaved });
  }

  /** Somebody has it as a file; it is there all the same when the page is opened again. */
  async saved(notice: string): Promise<void> {
    this.isSaved = true;
    this.notice = notice;
    await this.#keepNow();
  }
}
