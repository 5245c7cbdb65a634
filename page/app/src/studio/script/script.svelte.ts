// A program with text that is edited and run: its file, its world, and the pictures of its last run.
//
// Owns which moment is shown, and the clock of showing. The run itself is in a Worker, faster than it is shown.

import { ENGINE_MS_MAX, KEEP_AFTER_MS, PICTURES_MAX, SCRIPT_FILE_MB_MAX, SILENT_MS_MAX } from '../../limits';
import type { Mark } from '../../edit/marks';
import { language } from '../../words';
import type { Around } from '../../world/around';
import { Trail } from '../../world/trail';
import type { Scene as WorldScene, WorldState } from '../../world/types';
import type { Judged, Message, Scene, ScriptState } from '../engine/facts';
import { keep } from '../keep';
import type { Studio } from '../studio.svelte';
import { words as studioWords } from '../words';
import { joined } from '../world/pictures';
import { type ScriptLanguage, languageOf } from './names';
import { Player } from './player';
import type { Picture, PlayerNews } from './player.worker';
import { words } from './words';

const PICTURE_MS = 20;
/** Where pyodide is: beside the page. */
const PYTHON = 'python/';

interface Line extends Message {
  /** The picture with which it came. */
  at: number;
}

export class Script {
  /** Empty: there is none, and a diagram is drawn. */
  name = $state('');
  text = $state('');
  isSaved = $state(true);
  /** How many were opened here. */
  opened = $state(0);
  worldName = $state('');
  seed = $state(1);
  speed = $state(1);
  inputs = $state('');
  refusal = $state('');
  marks = $state.raw<Mark[]>([]);
  outcome = $state.raw<Judged | undefined>(undefined);
  remarks = $state.raw<string[]>([]);
  isLoading = $state(false);
  isRunning = $state(false);
  isShowing = $state(false);
  isEnded = $state(false);
  /** How many pictures there are, and which one is shown. */
  count = $state(0);
  at = $state(0);
  scene = $state.raw<WorldScene | undefined>(undefined);
  state = $state.raw<ScriptState | undefined>(undefined);
  lines = $state.raw<Line[]>([]);
  readonly trail = new Trail();
  #world = '';
  #start: Picture | undefined;
  #pictures: Picture[] = [];
  #scenes: [at: number, scene: Scene][] = [];
  #walked = -1;
  #player: Player | undefined;
  #frame = 0;
  #last = 0;
  #owed = 0;
  #keep: ReturnType<typeof setTimeout> | undefined;

  constructor(private readonly studio: Studio) {}

  get isOpen(): boolean {
    return this.name !== '';
  }

  get language(): ScriptLanguage {
    return languageOf(this.name) ?? 'js';
  }

  get world(): WorldState | undefined {
    return this.state && stateOf(this.state);
  }

  get around(): Around {
    const { scene, world: state, trail } = this;
    return { scene, state, trail, isGround: false, look: () => undefined };
  }

  /** Lines until the moment that is shown. */
  get said(): Line[] {
    return this.lines.filter(({ at }) => at <= this.at);
  }

  /** The end is shown, so its verdict is no news. */
  get isAtEnd(): boolean {
    return !this.isRunning && this.at >= this.count - 1;
  }

  /** The line of the program at the moment that is shown. */
  get line(): number | undefined {
    const [thread] = this.state?.threads ?? [];
    return this.count > 0 ? thread?.line : undefined;
  }

  /** Opens a file; without a world, in that of what was open. */
  async open(name: string, bytes: Uint8Array, world?: string): Promise<void> {
    if (bytes.length > SCRIPT_FILE_MB_MAX << 20) {
      this.studio.refusal = studioWords.notOpened(name, words.tooLarge(SCRIPT_FILE_MB_MAX));
      return;
    }
    this.end();
    const isTask = this.studio.hasTask || world === undefined;
    this.#world = isTask ? await this.studio.drafts.call('field') : world;
    this.worldName = '';
    this.text = new TextDecoder().decode(bytes);
    this.name = name;
    this.opened += 1;
    this.isSaved = true;
    this.studio.refusal = this.studio.notice = '';
    this.inputs = '';
    await this.#preview();
  }

  async blank(kind: ScriptLanguage): Promise<void> {
    // The world that was loaded for the program before stays.
    const [world, worldName] = this.worldName ? [this.#world, this.worldName] : [undefined, ''];
    await this.open(words.untitled[kind], new TextEncoder().encode(words.examples[kind]), world);
    this.worldName = worldName;
  }

  /** A diagram is drawn again. */
  close(): void {
    this.end();
    this.#clear();
    clearTimeout(this.#keep);
    this.name = this.text = '';
  }

  rename(name: string): void {
    const text = name.trim();
    if (text === '' || text === this.name) return;
    this.name = languageOf(text) === this.language ? text : `${text}.${this.language}`;
    this.changed();
  }

  bytes(): Uint8Array {
    return new TextEncoder().encode(this.text);
  }

  /** The text is another one than that of the file. */
  changed(): void {
    this.isSaved = false;
    this.marks = [];
    clearTimeout(this.#keep);
    this.#keep = setTimeout(() => void this.#keepNow(), KEEP_AFTER_MS);
  }

  async saved(notice: string): Promise<void> {
    this.isSaved = true;
    this.studio.notice = notice;
    await this.#keepNow();
  }

  async #keepNow(): Promise<void> {
    const { name, isSaved } = this;
    if (name) await keep({ name, bytes: this.bytes(), isSaved, world: this.#world });
  }

  /** The empty floor, or where it runs. */
  get worldIs(): string {
    if (this.studio.hasTask) return words.worldTask;
    if (this.worldName) return words.worldOf(this.worldName);
    return this.#world === '' ? words.worldEmpty : words.worldOf(this.studio.name);
  }

  /** Another world: of a file with one, or of a project. */
  async loadWorld(file: File): Promise<void> {
    const read = file.name.endsWith('.qrs')
      ? await this.studio.drafts.call('worldOf', file.name, new Uint8Array(await file.arrayBuffer()))
      : { text: await file.text(), images: '' };
    const before = this.#world;
    const why = typeof read === 'string' ? read : await this.#try(joined(read.text, read.images));
    if (why) {
      this.#world = before;
      this.studio.refusal = studioWords.notOpened(file.name, why);
      return;
    }
    this.worldName = file.name;
    await this.#keepNow();
  }

  async #try(world: string): Promise<string> {
    this.end();
    const seen = await this.studio.drafts.call('preview', world);
    if (typeof seen === 'string') return seen;
    this.#world = world;
    this.#start = { ...seen, messages: [], printed: [] };
    this.#clear();
    this.#show(0);
    return '';
  }

  async #preview(): Promise<void> {
    const why = await this.#try(this.#world);
    if (why) this.refusal = words.notRun(why);
  }

  #clear(): void {
    this.#pictures = [];
    this.#scenes = this.#start?.scene ? [[0, this.#start.scene]] : [];
    this.#walked = -1;
    this.trail.clear();
    this.count = this.at = 0;
    this.lines = [];
    this.marks = [];
    this.remarks = [];
    this.outcome = undefined;
    this.isEnded = false;
    this.refusal = '';
  }

  async run(): Promise<void> {
    this.end();
    this.#clear();
    this.isRunning = true;
    this.isShowing = true;
    // A program that takes all memory ends the page with it.
    await this.#keepNow();
    const folder = new URL(PYTHON, location.href).href;
    if (this.language === 'py') {
      this.isLoading = true;
      const there = await fetch(`${folder}pyodide.mjs`, { method: 'HEAD' }).catch(() => undefined);
      if (!there?.ok) {
        this.#stop(words.noPython);
        return;
      }
    }
    const player = new Player({
      told: (told) => this.#told(told),
      silent: (hadBegun) =>
        this.#stop(hadBegun ? words.silent(SILENT_MS_MAX / 1000) : words.noEngine(ENGINE_MS_MAX / 1000)),
      broken: (why) => this.#stop(words.crashed(why)),
    });
    this.#player = player;
    const { name, seed } = this;
    const inputs = this.inputs === '' ? [] : this.inputs.split('\n');
    const text = await this.studio.drafts.call('runnable', name, this.text);
    await player.begin({ name, text, world: this.#world, seed, inputs, locale: language, python: folder });
    this.#play();
  }

  /** By hand. */
  end(): void {
    this.isEnded = this.isRunning;
    this.isRunning = this.isLoading = false;
    this.#player?.end();
    this.#player = undefined;
  }

  #stop(why: string): void {
    this.end();
    this.isEnded = false;
    this.refusal = why;
  }

  #told(told: PlayerNews): void {
    if (told.kind === 'refused') this.#stop(words.notRun(told.why));
    if (told.kind === 'begun') this.isLoading = false;
    if (told.kind === 'pictures') this.#take(told.pictures);
    if (told.kind !== 'over') return;
    this.isRunning = false;
    this.outcome = told.outcome;
    this.remarks = told.remarks;
    const wrong = told.outcome?.messages.filter(({ level }) => level === 'error') ?? [];
    this.marks = wrong.flatMap(({ text }) => markOf(text)).slice(0, 1);
  }

  #take(pictures: Picture[]): void {
    const lines: Line[] = [];
    for (const picture of pictures) {
      const isKept = this.#pictures.length < PICTURES_MAX;
      const at = this.#pictures.length - (isKept ? 0 : 1);
      if (isKept) this.#pictures.push(picture);
      if (isKept && picture.scene) this.#scenes.push([at, picture.scene]);
      const { ms } = picture.state;
      for (const message of picture.messages) lines.push({ ...message, at });
      for (const text of picture.printed) lines.push({ level: 'log', ms, place: '', text, at });
    }
    if (lines.length > 0) this.lines = [...this.lines, ...lines].slice(-PICTURES_MAX);
    if (this.count === 0) this.#show(0);
    this.count = this.#pictures.length;
  }

  /** Shows a moment that a person has chosen. */
  seek(at: number): void {
    this.isShowing = false;
    this.#show(Math.max(0, Math.min(at, this.count - 1)));
  }

  /** Goes on with showing, from the beginning if it is at the end. */
  play(): void {
    if (this.isAtEnd) this.#show(0);
    this.isShowing = true;
    this.#play();
  }

  pause(): void {
    this.isShowing = false;
  }

  /** Ends everything. */
  leave(): void {
    this.end();
    cancelAnimationFrame(this.#frame);
  }

  #play(): void {
    cancelAnimationFrame(this.#frame);
    this.#last = performance.now();
    this.#owed = 0;
    const next = (now: number): void => {
      if (!this.isShowing) return;
      // A page that was hidden does not make up for it.
      const passed = Math.min(now - this.#last, 100);
      this.#last = now;
      this.#owed += (passed * this.speed) / PICTURE_MS;
      const pictures = Number.isFinite(this.#owed) ? Math.floor(this.#owed) : this.count;
      this.#owed = Number.isFinite(this.#owed) ? this.#owed - pictures : 0;
      const last = this.count - 1;
      if (pictures > 0 && last > this.at) this.#show(Math.min(last, this.at + pictures));
      if (this.isAtEnd) this.isShowing = false;
      else this.#frame = requestAnimationFrame(next);
    };
    this.#frame = requestAnimationFrame(next);
  }

  #show(at: number): void {
    const picture = this.#pictures[at] ?? this.#start;
    if (!picture) return;
    if (at < this.#walked) {
      this.trail.clear();
      this.#walked = -1;
    }
    for (let one = this.#walked + 1; one <= at; one += 1)
      this.#pictures[one]?.state.world.robots.forEach((robot, number) =>
        this.trail.step(number, robot.at[0], robot.at[1]),
      );
    this.#walked = Math.min(at, this.#pictures.length - 1);
    const scene = this.#scenes.findLast(([since]) => since <= at)?.[1];
    if (scene) this.scene = shown(scene);
    this.state = picture.state;
    this.at = at;
  }
}

/** A failure at a line of the program, as the report has it: `3:1 NameError: ...`. */
function markOf(text: string): Mark[] {
  const found = /^(\d{1,9}):\d+ (.*)/.exec(text);
  return found ? [{ line: Number(found[1]), text: found[2] ?? '' }] : [];
}

/** As the picture of the world takes it: nothing of it is moved by hand here. */
function shown(scene: Scene): WorldScene {
  return { ...scene, locked: { world: true, robot: true }, fields: false, devices: [] };
}

function stateOf({ world }: ScriptState): WorldState {
  const { t, robots, things } = world;
  return { t, robots, things, paused: false, speed: 1, led: '', said: '', faults: {} };
}
