// The values of this package.

/** Language of messages. */
export type Locale = 'en' | 'ru';

/** What a request came to. Nothing is thrown but mistakes of the package itself. */
export type Answer<T> = { ok: true; value: T } | { ok: false; error: Failure };

/**
 * Why a request is not answered: `request` is a mistake of the code that asks, `unreadable` a damaged file, `diagram` a
 * diagram that is not there, `program` and `world` mistakes in these.
 */
export interface Failure {
  kind: 'request' | 'unreadable' | 'diagram' | 'program' | 'world';
  /** The worst first. */
  problems: Finding[];
}

/** Something that is wrong, as `trik lint --json` tells it. */
export interface Finding {
  file: string;
  level: 'error' | 'warning' | 'note';
  message: string;
  /** The part of a save, as `worldModel`. */
  part: string | null;
  diagram: string | null;
  /** The id of the block or link. */
  object: string | null;
  block: string | null;
  property: string | null;
  /** In the part or the property, from 1. */
  line: number | null;
  column: number | null;
  /** In a file that is a text, from 1. */
  fileLine?: number;
  fileColumn?: number;
}

export interface LintOptions {
  locale?: Locale;
}

export interface OpenOptions {
  locale?: Locale;
  /** The main diagram that is run, if it is not the first one. */
  diagram?: string;
}

export interface ShowOptions {
  locale?: Locale;
  /** By its name; without it the main one. */
  diagram?: string;
  /** SVG, not sentences. */
  picture?: boolean;
  /** Say defaults of a data-flow program too. */
  all?: boolean;
  /** The textual form of a data-flow program, as `NAME.flow` has it: all diagrams. */
  source?: boolean;
}

export interface GenerateOptions {
  locale?: Locale;
  /** Write crossing arrows as goto: in C and Lua. */
  goto?: boolean;
}

export interface OutlineOptions {
  locale?: Locale;
  /** By its name; without it the main one. */
  diagram?: string;
}

/** A sentence with its indentation. */
export interface OutlineLine {
  text: string;
  /** Ids of the blocks that it tells of. */
  blocks: string[];
}

/** Of a data-flow program `lua` and `c`, which become converters of trikfs. */
export type Language = 'python' | 'javascript' | 'lua' | 'c' | 'pascal' | 'fsharp';

export interface Generated {
  text: string;
  notes: Finding[];
  /** Of each line of a diagram's text the ids of the blocks that it says; empty for converters. */
  blocks: string[][];
}

/** What a project is. */
export interface About {
  name: string;
  language: 'diagram' | 'dataflow';
  diagrams: string[];
  main: string | null;
  hasWorld: boolean;
}

/** Diagrams of control flow, or of data flow. */
export type DrawnLanguage = 'diagram' | 'dataflow';

export interface PaletteOptions {
  locale?: Locale;
  /** Without it `diagram`. */
  language?: DrawnLanguage;
}

/** Of data flow: where links begin and end. */
export interface PortFacts {
  name: string;
  way: 'in' | 'out';
  /** What tokens are; `unit` is one without a value. */
  of: 'unit' | 'truth' | 'whole' | 'text' | 'list' | 'any';
  /** Its place on the block, in pixels from the upper left corner. */
  at: [number, number];
}

/** A block that a person can draw with. */
export interface PaletteBlock {
  /** Its type in saves. */
  kind: string;
  title: string;
  /** The last four and `drawing` are those of data flow. */
  category: 'algorithms' | 'actions' | 'wait' | 'drawing' | 'control' | 'streams' | 'devices' | 'shell';
  /** Which kits have it. */
  kits: string[];
  /** It is of old saves, and does nothing. */
  isOld: boolean;
  /** What it does. */
  text: string;
  /** Its picture: pieces of SVG around the origin, in a square of 50; empty: it has none. */
  icon: string;
  /** Of data flow: width and height. */
  size?: [number, number];
  /** Of data flow: a link names a port by its place here. */
  ports?: PortFacts[];
  properties: PropertyFacts[];
}

export interface PropertyFacts {
  name: string;
  title: string;
  /** What findings call it. */
  found: string;
  default: string;
  takes: 'statements' | 'expression' | 'text' | 'variable' | 'ports' | 'number' | 'choice';
  choices: string[] | null;
  /** What people read for each of them. */
  choiceTitles: string[] | null;
}

export interface BlankOptions {
  locale?: Locale;
  kit?: 'trikV62Kit' | 'trikV6Kit';
  /** Without it `diagram`. */
  language?: DrawnLanguage;
}

/** A project that is drawn. */
export interface DraftState {
  name: string;
  language: DrawnLanguage;
  kit: 'trikV62Kit' | 'trikV6Kit';
  diagrams: DrawnDiagram[];
  /** How many changes can be taken back, and made again. */
  undo: number;
  redo: number;
  hasWorld: boolean;
  /** Another number for another world. */
  world: number;
}

export interface DrawnDiagram {
  id: string;
  name: string;
  kind: 'main' | 'subprogram';
  parameters: Parameter[];
}

export interface Parameter {
  name: string;
  kind: 'int' | 'float' | 'bool' | 'string';
  default: string;
}

/** A diagram; places are pixels to the right and down. */
export interface DrawnSheet {
  id: string;
  blocks: DrawnBlock[];
  links: DrawnLink[];
}

export interface DrawnBlock {
  id: string;
  kind: string;
  /** As it is saved; `title` is what a person reads. */
  name: string;
  title: string;
  /** What it does, in a few words. */
  details: string;
  at: [number, number];
  size: [number, number];
  properties: Record<string, string>;
  /** The id of the diagram that it calls. */
  calls: string | null;
  arguments: { name: string; kind: string; value: string }[];
}

export interface DrawnLink {
  id: string;
  /** null: it hangs loose there. */
  from: string | null;
  to: string | null;
  guard: string;
  /** Of data flow: places among the ports of both ends; null if one of them is at none. */
  ports?: Ports | null;
  /** Of data flow: what its queue does, `fifo`, `latest` or `error`, and how many tokens it has room for; empty: as usual. */
  policy?: string;
  capacity?: string;
  path: [number, number][];
}

/** Of data flow: from which port to which one, by their places in the palette. */
export type Ports = [from: number, to: number];

/** Blocks and links between them, apart from any project. */
export interface Piece {
  blocks: PieceBlock[];
  /** Ends are places in `blocks`. */
  links: {
    from: number;
    to: number;
    guard?: string;
    ports?: Ports | null;
    /** Of data flow: `Policy` and `Capacity`. */
    properties?: Record<string, string>;
  }[];
}

export interface PieceBlock {
  kind: string;
  at: [number, number];
  /** Without it that of its type. */
  size?: [number, number] | null;
  name?: string;
  properties?: Record<string, string>;
  /** The name of the subprogram that it calls. */
  calls?: string | null;
  arguments?: Record<string, string>;
}

/** A change of a drawing; ids are those of a sheet. `ports` are needed for data flow, and refused for control flow. */
export type Change =
  | ({ do: 'add'; diagram: string } & Piece)
  /** `ports` are those of the block: where the link ends, and where the new one begins. */
  | { do: 'insert'; link: string; block: PieceBlock; guard?: string; ports?: [number, number] }
  | { do: 'remove'; ids: string[] }
  | { do: 'move'; places: { id: string; at: [number, number] }[] }
  | { do: 'connect'; from: string; to: string; guard?: string; ports?: Ports }
  | { do: 'reconnect'; link: string; from: string; to: string; ports?: Ports }
  | { do: 'set'; id: string; property: string; value: string }
  | { do: 'argument'; id: string; name: string; value: string }
  | { do: 'call'; id: string; diagram: string }
  | { do: 'addDiagram'; kind: 'main' | 'subprogram'; name: string }
  | { do: 'rename'; diagram: string; name: string }
  | { do: 'parameters'; diagram: string; parameters: Parameter[] }
  | { do: 'removeDiagram'; diagram: string }
  | { do: 'world'; text: string | null; images?: string }
  | { do: 'kit'; kit: 'trikV62Kit' | 'trikV6Kit' };

/** A name that can stand in an expression. */
export interface NameFacts {
  name: string;
  is: 'variable' | 'sensor' | 'constant' | 'function';
}

/** How a project is run; all as the options of `trik check`. */
export interface RunOptions {
  locale?: Locale;
  /** The text of a world in XML, which takes the place of the project's own. */
  field?: string;
  /** Of everything random: 0 to 4294967295, 1 without it. */
  seed?: number;
  /** Longest run, in seconds of model time: 600 without it. */
  modelSeconds?: number;
  /** Longest run of `judge`, in seconds of real time: 60 without it. */
  wallSeconds?: number;
  /** Go on after the first failure. */
  keepGoing?: boolean;
  /** Let markers leave traces that sensors and rules see. */
  markerTraces?: boolean;
  /** Tell why it ended as it did, as `trik check --explain`. */
  explain?: boolean;
  /** Give the trajectory. */
  trajectory?: boolean;
  /** What a person answers when the program asks, in order. */
  inputs?: string[];
  /** What a person does with keys and gamepad, a line for each. */
  gamepad?: string;
  /** Run with a debugger; only for `run`. */
  debug?: boolean;
}

/** What came out of a run. */
export interface Judged {
  verdict: 'accomplished' | 'ended' | 'failed' | 'broken';
  failure: 'wrong' | 'model_time' | 'program' | 'structure' | 'not_run' | null;
  /** Milliseconds of model time. */
  ms: number;
  totalScore: number | null;
  messages: Message[];
  /** Messages that are left out. */
  more: number;
  printed: string[];
  /** What is strange in the world, or why nothing was run. */
  strange: Finding[];
  /** The files that `trik check --report` and `--trajectory` write. */
  report: string;
  explanation: Explanation | null;
  trajectory: string | null;
}

/** Why a run ended as it did. */
export interface Explanation {
  /** Lines for people; those that belong to the one before are indented. */
  text: string[];
  ms: number;
  /** The rule that has decided. */
  decided_by: RuleName | null;
  rules: (RuleName & {
    decided: boolean;
    fired_ms: number | null;
    state: 'alive' | 'dropped' | 'never_set_up';
    set_up_by: RuleName[];
    conditions: {
      text: string;
      depth: number;
      negated: boolean;
      /** null: it was not looked at. */
      holds: boolean | null;
      values: string[];
      nearest: { gap: number; unit: 'value' | 'px' | 'ms'; ms: number } | null;
    }[];
    more_conditions: number;
  })[];
  more_rules: number;
  threads: {
    thread: string;
    ended_ms: number | null;
    diagram: string;
    block: { id: string; kind: string; caption: string };
  }[];
}

/** A rule; `number` is its place among its kind, from 1. */
export interface RuleName {
  kind: 'event' | 'constraint' | 'timelimit' | 'init';
  id: string;
  number: number;
}

/** Something that rules or the program said. */
export interface Message {
  level: 'info' | 'warning' | 'error' | 'log';
  ms: number;
  place: string;
  text: string;
}

export interface News {
  messages: Message[];
  printed: string[];
}

/** `held`: a debugger holds it. */
export type Progress = 'runs' | 'held' | 'over';

/** Metres with x to the right and y up, degrees counter-clockwise. */
export type Place = [x: number, y: number, degrees: number];

/** Something that stands still. `is` says what the points are. */
export interface Item {
  is: 'line' | 'strokes' | 'curve' | 'rect' | 'ellipse' | 'wall' | 'text' | 'image';
  /** x and y of each point in turn. */
  points: number[];
  stroke?: string;
  width?: number;
  dash?: number[];
  fill?: string;
  /** Of the colour inside, from 0 to 1. */
  alpha?: number;
  /** Of a text the text, of a picture its address. */
  text?: string;
}

/** A robot as it is built; places are ahead of its centre and to the left. */
export interface Shape {
  /** Length and width. */
  size: [number, number];
  round: boolean;
  wheels: { port: string; at: [number, number]; radius: number }[];
  sensors: {
    is: 'infrared' | 'sonar' | 'light' | 'touch' | 'camera' | 'lidar';
    port: string;
    at: [number, number];
    degrees: number;
    /** 0: it measures no distance. */
    reach: number;
    beam: number;
  }[];
}

/** What stands still. */
export interface Scene {
  /** Left, bottom, right and top. */
  bounds: [number, number, number, number];
  /** Colour of the floor. */
  floor: string;
  /** The lowest first. */
  items: Item[];
  /** What markers have left: both ends and the colour. */
  marks: [x: number, y: number, toX: number, toY: number, colour: string][];
  things: { is: 'ball' | 'skittle' | 'cube'; size: number; colour: string }[];
  /** Where the robot is. */
  start: Place;
  robots: Shape[];
}

/** A robot where it is. */
export interface Placed {
  at: Place;
  /** By the sensors of its shape: metres, a share of dark, 1 for pressed; null: nothing is in reach, or nobody has asked. */
  read: (number | null)[];
  rays: (number | null)[];
  stuck: boolean;
  /** The colour of a marker that draws; empty if none does. */
  marker: string;
}

/** Where a thread of the program is. */
export interface Thread {
  thread: string;
  diagram: string;
  /** The id of the block. */
  id: string;
  kind: string;
  /** The block, for people. */
  block: string;
}

/** What moves, and what the program does. */
export interface State {
  ms: number;
  progress: Progress;
  /** Power in percent, and degrees, by the port. */
  motors: Record<string, number>;
  /** The newest readings that program or rules have asked for. */
  sensors: Record<string, number>;
  variables: Record<string, string>;
  threads: Thread[];
  world: { t: number; robots: Placed[]; things: Place[] };
}

/** Where a thread of a program with text is: the line at which it waited, or asked its robot, last. */
export interface Stand {
  thread: string;
  file: string;
  line: number;
}

/** The same of a program with text. */
export interface ScriptState extends Omit<State, 'threads'> {
  threads: Stand[];
}

/** What a debugger answers: `done`, or `why` not. The rest is what `docs/user/debug.md` tells of orders. */
export type DebugAnswer = { to: number; done: true; [name: string]: unknown } | { to: number; done: false; why: string };

/** What a debugger tells by itself: its state, or lines of breakpoints. */
export type DebugReport = Record<string, unknown>;
