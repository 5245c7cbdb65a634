// The package for browsers, as the studio uses it: built by web/build.sh, which declares the same of itself; web/test.sh holds
// one to the other.

import type {
  About,
  Answer,
  BlankOptions,
  Change,
  DebugAnswer,
  DebugReport,
  DraftState,
  DrawnSheet,
  Finding,
  GenerateOptions,
  Generated,
  Judged,
  Language,
  LintOptions,
  Locale,
  NameFacts,
  OutlineLine,
  OutlineOptions,
  News,
  OpenOptions,
  PaletteBlock,
  PaletteOptions,
  Piece,
  Progress,
  RunOptions,
  Scene,
  ScriptState,
  ShowOptions,
  State,
} from '../../../../../web/src/types';

export default function init(): Promise<unknown>;
export function edit(name: string, bytes: Uint8Array, options?: LintOptions): Answer<Draft>;
export function blank(name: string, options?: BlankOptions): Answer<Draft>;
export function palette(options?: PaletteOptions): Answer<PaletteBlock[]>;
export function open(name: string, bytes: Uint8Array, options?: OpenOptions): Answer<Project>;
export function script(name: string, world: string, options?: RunOptions): Answer<Script>;
export function runnable(name: string, program: string): Answer<string>;
export function lint(name: string, bytes: Uint8Array, options?: LintOptions): Answer<Finding[]>;

export interface Draft {
  about(): DraftState;
  sheet(diagram: string, locale?: Locale): DrawnSheet | null;
  apply(change: Change, locale?: Locale): Answer<string[]>;
  undo(): boolean;
  redo(): boolean;
  lint(locale?: Locale): Finding[];
  names(): NameFacts[];
  copy(ids: string[]): Answer<Piece>;
  world(): string | undefined;
  images(): string | undefined;
  save(): Answer<Uint8Array>;
  stored(): Answer<Uint8Array>;
  project(options?: OpenOptions): Answer<Project>;
  free(): void;
}

export interface Project {
  about(): About;
  show(options?: ShowOptions): Answer<string>;
  outline(options?: OutlineOptions): Answer<OutlineLine[]>;
  generate(language: Language, options?: GenerateOptions): Answer<Generated>;
  judge(options?: RunOptions): Answer<Judged>;
  run(options?: RunOptions): Answer<Run>;
  free(): void;
}

export interface Script {
  ask(word: string, said: string, ticks: number): string;
  goOn(ticks: number): string;
  scene(): Scene;
  state(): ScriptState;
  way(from: number): Float64Array;
  news(): News;
  remarks(): string[];
  end(): void;
  outcome(): Judged | undefined;
  free(): void;
}

export interface Run {
  tick(count: number): Progress;
  progress(): Progress;
  scene(): Scene;
  state(): State;
  way(from: number): Float64Array;
  news(): News;
  order(order: string): Answer<DebugAnswer>;
  reports(): DebugReport[];
  patch(project: Project): Answer<string>;
  display(): Uint8Array;
  end(): void;
  outcome(): Judged | undefined;
  free(): void;
}
