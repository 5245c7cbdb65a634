// What the scripts of a robot stand on (trikd/js), where their world is in this Worker: the same functions as the robot's engine
// gives them, by questions.
//
// Owns which questions a function asks, and what it says when there is no answer. Knows no Worker; the scripts are handed in.

import { type Link, NOT_YET, Over, Refusal } from './link';

type Native = Record<string, unknown>;
/** One of trikd/js: base takes what it stands on, the others what base has made. */
export type RobotScript = (given: unknown) => unknown;

const TIMERS_MAX = 256;
const MESSAGES_MAX = 256;
/** Bytes of one print; what is longer is lost, as under `trik check`. */
const PRINT_MAX = (1 << 20) - 16;
/** 2026-01-01, 00:00 UTC: the calendar of judged programs. */
const EPOCH_MS = 1767225600000;
const KEYS = [116, 103, 1, 105, 106, 108, 28];
const KEYS_DEVICE = 'keys/device';
const NO_ECHO = -1;
const NOT_PRESSED = -101;
const MAIN = 'main';

export const NO_THREADS =
  'Threading: a program has one thread in the browser; on a robot and under trik check it may have more';

const isName = (name: string): boolean => /^[A-Za-z0-9_-]{1,32}$/.test(name);
const isConnector = (name: string): boolean => /^[A-Z]{1,2}[0-9]{1,2}$/.test(name);

function numbers(text: string, most = Infinity): number[] {
  const words = text.trim() === '' ? [] : text.trim().split(/\s+/);
  return words.slice(0, most).map(Number);
}

/** What one program runs on. */
class Ground {
  readonly #link: Link;
  isQuitting = false;

  constructor(link: Link) {
    this.#link = link;
  }

  get now(): number {
    return this.#link.now;
  }

  ask(word: string, text = ''): string {
    if (this.isQuitting) throw new Over('the program ends');
    return this.#link.ask(word, text);
  }

  /** The same, and a failure says where. */
  at(place: string, word: string, text: string): string {
    try {
      return this.ask(word, text);
    } catch (error) {
      throw error instanceof Refusal ? new Error(`${place}: ${error.message}`) : error;
    }
  }

  /** The same; undefined if it is refused for this reason, or for any. */
  try(word: string, text: string, errno?: number): string | undefined {
    try {
      return this.ask(word, text);
    } catch (error) {
      if (error instanceof Refusal && (errno === undefined || error.errno === errno)) return undefined;
      throw error;
    }
  }

  has(directory: string): boolean {
    return this.ask('has', directory) === '1';
  }

  number(place: string, file: string): number {
    const [first] = numbers(this.at(place, 'read', file));
    if (first === undefined || !Number.isFinite(first)) throw new Error(`${place}: no number`);
    return first;
  }

  write(place: string, file: string, text: string): void {
    this.at(place, 'write', `${file}\n${text}`);
  }
}

interface Port {
  directory: string;
  isServo: boolean;
}

/** The same things by numbers, as scripts have them. */
function handles(): { add(port: Port | undefined): number; of(handle: number): Port } {
  const all: Port[] = [];
  return {
    add: (port) => (port ? all.push(port) - 1 : -1),
    of(handle) {
      const port = all[handle];
      if (!port) throw new Error('no such port');
      return port;
    },
  };
}

function motors(ground: Ground): Native {
  const all = handles();
  const found = (name: string): Port | undefined => {
    if (!isName(name)) return undefined;
    if (ground.has(`motors/${name}`)) return { directory: `motors/${name}`, isServo: false };
    if (!ground.has(`servos/${name}`)) return undefined;
    ground.try('read', `servos/${name}/units`);
    return { directory: `servos/${name}`, isServo: true };
  };
  const tell = ({ directory }: Port, file: string, text: string): void =>
    ground.write(directory, `${directory}/${file}`, `${text}\n`);
  return {
    motor: (name: string) => all.add(found(name)),
    motorSet(handle: number, power: number) {
      const port = all.of(handle);
      if (Number.isFinite(power)) {
        const most = port.isServo ? 90 : 100;
        tell(port, 'value', String(Math.round(Math.max(-most, Math.min(most, power)))));
      } else if (!port.isServo) {
        tell(port, 'value', '0');
      }
    },
    motorGet: (handle: number) => {
      const { directory } = all.of(handle);
      return ground.number(directory, `${directory}/value`);
    },
    motorOff(handle: number) {
      const port = all.of(handle);
      tell(port, port.isServo ? 'power' : 'value', '0');
    },
    motorBrake(handle: number) {
      const port = all.of(handle);
      if (port.isServo) tell(port, 'power', '0');
      else tell(port, 'brake', '1');
    },
  };
}

function sensors(ground: Ground): Native {
  const [analog, encoders] = [handles(), handles()];
  const found = (group: string, name: string): Port | undefined => {
    const directory = `${group}/${name}`;
    return isName(name) && ground.has(directory) ? { directory, isServo: false } : undefined;
  };
  const read = (port: Port, file: string): number =>
    ground.number(port.directory, `${port.directory}/${file}`);
  return {
    sensor: (name: string) => analog.add(found('sensors', name)),
    sensorRead(handle: number) {
      const port = analog.of(handle);
      try {
        return read(port, 'value');
      } catch (error) {
        if (error instanceof Over) throw error;
        const raw = ground.try('read', `${port.directory}/raw`);
        if (Number(raw) === NO_ECHO) return NO_ECHO;
        throw error;
      }
    },
    sensorRaw: (handle: number) => read(analog.of(handle), 'raw'),
    encoder: (name: string) => encoders.add(found('encoders', name)),
    encoderRead: (handle: number) => read(encoders.of(handle), 'value'),
    encoderRaw: (handle: number) => read(encoders.of(handle), 'raw'),
    encoderReset(handle: number) {
      const { directory } = encoders.of(handle);
      ground.write(directory, `${directory}/value`, '0\n');
    },
  };
}

/** What there is once on each robot. */
function onboard(ground: Ground): Native {
  const vector = (name: string): number[] => {
    const values = numbers(ground.at(name, 'read', `${name}/value`), 3);
    while (values.length < 3) values.push(0);
    if (name !== 'gyroscope') return values;
    const tilt = numbers(ground.at(name, 'read', 'gyroscope/tilt'), 2);
    const time = (ground.now * 1000) % 2 ** 31;
    return [...values, time, tilt[0] ?? 0, tilt[1] ?? 0, ground.number(name, 'gyroscope/heading')];
  };
  return {
    keyPressed(code: number) {
      const pressed = numbers(ground.try('read', 'keys/value', NOT_YET) ?? '');
      return KEYS.some((other, at) => other === code && (pressed[at] ?? 0) !== 0);
    },
    led(green: boolean, red: boolean) {
      ground.write('led/green', 'led/green/value', green ? '1\n' : '0\n');
      ground.write('led/green', 'led/red/value', red ? '1\n' : '0\n');
    },
    voltage: () => ground.number('battery', 'battery/value'),
    rawVoltage: () => ground.number('battery', 'battery/raw'),
    vector,
    vectorRaw: (name: string) => numbers(ground.at(name, 'read', `${name}/raw`), 8),
    playSound: (file: string) => ground.write('sound/play', 'sound/play/value', file),
    tone: (hz: number, ms: number) => ground.write('sound/tone', 'sound/tone/value', `${hz} ${ms}\n`),
    say: (text: string) => ground.write('sound/say', 'sound/say/value', text),
    mark: (color: string) => ground.write('marker', 'marker/value', color),
    stop: () => ground.write('stop', 'stop', '1\n'),
  };
}

function cameras(ground: Ground): Native {
  const directory = (name: string): string | undefined => {
    if (['line', 'object', 'color'].includes(name)) return `camera/${name}`;
    return name === 'sound' ? 'microphones' : undefined;
  };
  const isThere = (name: string): boolean => {
    const place = directory(name);
    return place !== undefined && ground.has(place);
  };
  const known = new Set<string>();
  /** The numbers of a sensor; none if it has no picture or answer yet. */
  const asked = (name: string, word: string, file: string, text?: string): number[] => {
    const place = directory(name) ?? name;
    const path = `${place}/${file}`;
    try {
      return numbers(ground.ask(word, text === undefined ? path : `${path}\n${text}`), 9);
    } catch (error) {
      if (error instanceof Refusal && error.errno === NOT_YET) return [];
      throw error instanceof Refusal ? new Error(`${place}: ${error.message}`) : error;
    }
  };
  const must = (name: string): void => {
    if (known.has(name)) return;
    if (!isThere(name)) throw new Error('this robot has no such sensor');
    known.add(name);
  };
  return {
    hasCamera: isThere,
    cameraStart(name: string, shows: boolean) {
      must(name);
      asked(name, 'read', 'value');
      ground.try('read', `${directory(name)}/hsv`);
      asked(name, 'write', 'video_out', shows ? '1\n' : '0\n');
    },
    cameraStop: must,
    cameraRead(name: string) {
      must(name);
      const read = asked(name, 'read', 'value');
      return read.length > 0 ? read : [0, 0, 0];
    },
    cameraDetect(name: string) {
      must(name);
      asked(name, 'write', 'detect', '1\n');
      return true;
    },
    cameraDetected(name: string) {
      must(name);
      return asked(name, 'read', 'hsv').slice(0, 6);
    },
    cameraLookFor(name: string, values: number[]) {
      must(name);
      asked(name, 'write', 'hsv', `${values.map((value) => value.toFixed(0)).join(' ')}\n`);
    },
  };
}

function gamepad(ground: Ground): Native {
  const read = (file: string): number[] | undefined => {
    const text = ground.try('read', `gamepad/${file}`);
    return text === undefined ? undefined : numbers(text);
  };
  return {
    pad(number: number) {
      if (number !== 1 && number !== 2) return undefined;
      const [x, y, isPressed] = read(`pad${number}/value`) ?? [];
      return isPressed === undefined || isPressed === 0 ? undefined : [x, y];
    },
    wheel: () => read('wheel/value')?.[0] ?? NOT_PRESSED,
    button: (number: number) => (read('buttons/value')?.[number - 1] ?? 0) !== 0,
    gamepadConnected: () => read('buttons/value') !== undefined,
  };
}

/** What is the same for all files of the robot. */
function tree(ground: Ground): Native {
  const unsupported = (path: string): never => {
    throw new Error(`${path}: the simulated robot has no such file`);
  };
  return {
    has: (name: string) => ground.has(name),
    isReady: (name: string) => Number.isFinite(numbers(ground.try('read', `${name}/value`) ?? '')[0] ?? NaN),
    isNode: (path: string) => {
      const parts = path.split('/');
      return parts.length <= 3 && parts.every(isName) && ground.has(path);
    },
    isFile: (path: string) => path === 'display/device',
    numbers: (path: string) => numbers(ground.at(path, 'read', path)),
    ports(group: string) {
      const names = ground.ask('names', group).split(' ').filter(isName);
      return names.some(isConnector) ? names.filter(isConnector) : names;
    },
    write: (path: string, text: string) => ground.write(path, path, text),
    readAt: unsupported,
    writeAt: unsupported,
  };
}

function events(ground: Ground, text: string): Native {
  const record = (path: string, line: string): unknown => (path === KEYS_DEVICE ? numbers(line) : line);
  return {
    timersMax: TIMERS_MAX,
    clock() {
      ground.ask('clock');
      return ground.now;
    },
    date() {
      ground.ask('clock');
      return EPOCH_MS + ground.now;
    },
    next(until: number) {
      const told = ground.ask('event', String(until));
      if (told === '') return null;
      const end = told.indexOf('\n');
      const [source, rest] = [told.slice(0, end), told.slice(end + 1)];
      return source === 'mail' ? [source, -1, rest] : [source, record(source, rest)];
    },
    listen: (path: string) => void ground.at(path, 'listen', path),
    tryListen: (path: string) => ground.try('listen', path) !== undefined,
    forget: () => undefined,
    drain(path: string) {
      const lines = ground.ask('drain', path);
      return lines === '' ? [] : lines.split('\n').map((line) => record(path, line));
    },
    mentions: (word: string) => text.includes(word),
    random: (low: number, high: number) => Number(ground.ask('random', `${low} ${high}`)),
  };
}

function around(ground: Ground): Native {
  const drawn = (line: string): string => {
    try {
      ground.ask('draw', line);
      return '';
    } catch (error) {
      if (error instanceof Refusal) return error.message;
      throw error;
    }
  };
  const noPicture = (): string => 'pictures are not shown in the simulator';
  const file = (word: string, name: string, text?: string): string =>
    ground.at(name, word, text === undefined ? name : `${name}\n${text}`);
  return {
    print(text: string) {
      if (text.length <= PRINT_MAX) ground.ask('print', text);
    },
    info: (text: string) => void ground.ask('info', text),
    web: () => undefined,
    direct: () => undefined,
    survive: () => false,
    include: (name: string) => ground.at('include', 'include', name),
    append: (name: string, text: string) => void file('append', name, text),
    appendBytes: (name: string, bytes: number[]) =>
      void file('append', name, bytes.map((byte) => String.fromCharCode(byte)).join('')),
    readAll: (name: string) => ground.ask('file', name).match(/[^\n]*\n|[^\n]+$/g) ?? [],
    remove: (name: string) => void file('remove', name),
    system: (command: string) => Number(ground.at('script.system', 'system', command)),
    draw: drawn,
    showFile: noPicture,
    showNumbers: noPicture,
    photo() {
      throw new Error('the simulated robot has no picture of its camera');
    },
    mailbox: (words: string) => ground.at('mailbox', 'mailbox', words),
    takeMail: () => ground.try('take', '', NOT_YET),
    hasMail: () => ground.ask('waiting') === '1',
  };
}

/** There is one thread, which may leave messages to itself. */
function threads(ground: Ground): Native {
  const notes: string[] = [];
  return {
    startThread() {
      throw new Error(NO_THREADS);
    },
    isRunning(name: string) {
      if (name === MAIN) throw new Error('Threading: a thread cannot wait for its own end');
      return false;
    },
    killThread: () => void ground.ask('clock'),
    killOthers: () => void ground.ask('clock'),
    sendMessage(name: string, text: string) {
      ground.ask('clock');
      if (name === MAIN && notes.length < MESSAGES_MAX) notes.push(text);
    },
    takeMessage: () => notes.shift(),
  };
}

/** A robot that is made for one program: its names are properties of the global object. */
export interface Robot {
  /** Whether the program wants to live on after its text. */
  readonly hasEvents: boolean;
  /** For ever, until something throws. */
  loop(): void;
}

/** Makes it. `text` is that of the program. */
export function robot(link: Link, text: string, scripts: RobotScript[]): Robot {
  const ground = new Ground(link);
  let hasEvents = false;
  const native: Native = {
    ...motors(ground),
    ...sensors(ground),
    ...onboard(ground),
    ...cameras(ground),
    ...gamepad(ground),
    ...tree(ground),
    ...events(ground, text),
    ...around(ground),
    ...threads(ground),
    run: () => void (hasEvents = true),
    quit() {
      ground.isQuitting = true;
      throw new Over('the program ends');
    },
  };
  const [base, ...rest] = scripts;
  const kit = base?.(native) as { loop(survives: boolean): void };
  for (const script of rest) script(kit);
  return {
    get hasEvents() {
      return hasEvents;
    },
    loop: () => kit.loop(false),
  };
}
