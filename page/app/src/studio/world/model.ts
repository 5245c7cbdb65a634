// A world as things that can be shown and changed, made of its text; each change is a list of splices of that text.
//
// Owns where tags of a world stand and which of them count. How each kind looks is known to `kinds`, how texts change to `xml`.

import {
  type AttributeFacts,
  type Grip,
  KINDS,
  type Kind,
  ROBOT_PX,
  line,
  pictureBox,
  pictureRect,
} from './kinds';
import { PIECES, beginOf, carriedTo, movedPieces, pathOf, pieces, strokes, wave } from './strokes';
import { type Spot, UNITS, type Unit, Values } from './units';
import {
  type Splice,
  type Tag,
  type XmlDocument,
  type XmlFault,
  child,
  encoded,
  insert,
  read,
  remove,
  set,
  value,
} from './xml';

/** A thing of the world. It stays the same object as long as its text does. */
export interface Item {
  /** Its kind and which of its kind it is. */
  key: string;
  kind: Kind;
  id: string;
  values: Values;
  /** Of what is on a robot: the key of that. */
  on?: string;
  /** What decides whether it is the same as before. */
  source: string;
}

export interface WorldModel {
  document: XmlDocument;
  root: Tag;
  unit: Unit;
  hasSettings: boolean;
  /** The lowest on the sheet first. */
  items: readonly Item[];
  byKey: ReadonlyMap<string, Item>;
  /** The tags of things; of a robot the one that says where it stands. */
  tags: ReadonlyMap<string, Tag>;
  settings: Values;
  constraints: Tag | undefined;
}

/** Why a text is no world. */
export type WorldFault = XmlFault | { fault: 'noWorld'; at: 0 };

/** Lists whose things count, wherever they stand; of regions only the first list does. */
const LISTS = ['trace', 'walls', 'skittles', 'balls', 'cubes', 'colorFields', 'comments', 'images'];

export function isFault(found: WorldModel | WorldFault): found is WorldFault {
  return 'fault' in found;
}

/** The world that a text says; things whose text is as `before` are the same objects. */
export function model(text: string, before?: WorldModel): WorldModel | WorldFault {
  const document = read(text);
  if ('fault' in document) return document;
  const root =
    document.root.name === 'root' ? document.root : (child(document.root, 'root') ?? document.root);
  const world = child(root, 'world');
  if (!world) return { fault: 'noWorld', at: 0 };
  const settings = child(root, 'settings');
  const unit = unitOf(settings);
  const gathered = new Gathered(text, UNITS[unit].pixels, before);
  gathered.world(world);
  gathered.robots(root, world);
  const place = new Map(KINDS.map((kind, at) => [kind, at]));
  const items = gathered.items.toSorted(
    (one, other) => (place.get(one.kind) ?? 0) - (place.get(other.kind) ?? 0),
  );
  return {
    document,
    root,
    unit,
    hasSettings: settings !== undefined,
    items,
    byKey: new Map(items.map((item) => [item.key, item])),
    tags: gathered.tags,
    settings: new Values(texts(settings), 1),
    constraints: child(root, 'constraints'),
  };
}

/** Without settings lengths are centimetres; with them, but without a unit, pixels. */
function unitOf(settings: Tag | undefined): Unit {
  const written = settings && (value(settings, 'sizeUnit') ?? 'px');
  if (written === undefined) return 'cm';
  return written === 'cm' || written === 'mm' || written === 'm' ? written : 'px';
}

function texts(tag: Tag | undefined): Record<string, string> {
  return Object.fromEntries((tag?.attributes ?? []).map(({ name, value: text }) => [name, text]));
}

/** Whether a tag has what tells the kind from others of its name. */
function is(kind: Kind, tag: Tag): boolean {
  return Object.entries(kind.when ?? {}).every(([name, wanted]) => {
    const byDefault = kind.attributes.find((one) => one.name === name)?.default;
    return (value(tag, name) ?? byDefault)?.toLowerCase() === wanted;
  });
}

class Gathered {
  readonly items: Item[] = [];
  readonly tags = new Map<string, Tag>();
  readonly #counts = new Map<string, number>();
  readonly #drawn = new Map<string, string>();
  readonly #kinds = new Map<string, Kind[]>();

  constructor(
    private readonly text: string,
    private readonly scale: number,
    private readonly before: WorldModel | undefined,
  ) {
    for (const kind of KINDS) this.#kinds.set(kind.tag, [...(this.#kinds.get(kind.tag) ?? []), kind]);
  }

  world(world: Tag): void {
    for (const list of world.children) {
      if (LISTS.includes(list.name))
        for (const tag of list.children) this.#take(tag, (kind) => kind.list !== 'robot');
      else if (list.name === 'background') this.#take(list, () => true);
    }
    for (const tag of child(world, 'regions')?.children ?? [])
      this.#take(tag, (kind) => kind.list === 'regions');
  }

  robots(root: Tag, world: Tag): void {
    const inWorld = child(world, 'robot');
    const lists = root.children.filter(({ name }) => name === 'robots').flatMap((list) => list.children);
    const robots = lists.filter(({ name }) => name === 'robot');
    // An old world may have its robot there alone.
    if (robots.length === 0 && inWorld) robots.push(inWorld);
    for (const robot of robots) {
      const place = inWorld ?? robot;
      const more = Object.entries(texts(child(robot, 'wheels')));
      const key = this.#add(this.#row('robot'), place, more);
      const start = child(place, 'startPosition') ?? child(robot, 'startPosition');
      if (start) this.#add(this.#row('startPosition'), start, [], key);
      for (const tag of child(robot, 'sensors')?.children ?? [])
        if (tag.name === 'sensor') this.#add(this.#row('sensor'), tag, [], key);
    }
  }

  #row(tag: string): Kind {
    const [kind] = this.#kinds.get(tag) ?? [];
    if (!kind) throw new Error(`no kind ${tag}`);
    return kind;
  }

  #take(tag: Tag, isHere: (kind: Kind) => boolean): void {
    const kind = this.#kinds.get(tag.name)?.find((one) => is(one, tag));
    if (!kind || !isHere(kind)) return;
    const more: [string, string][] = [];
    if (kind.name === 'stylus') more.push([PIECES, this.#strokes(tag)]);
    // What it is the outline of stands before it.
    if (kind.name === 'regionBound')
      more.push([PIECES, this.#drawn.get(value(tag, 'boundItem') ?? '') ?? '']);
    const key = this.#add(kind, tag, more);
    const id = value(tag, 'id');
    const added = this.items.at(-1);
    if (id && added && added.key === key && (kind.name === 'rectangle' || kind.name === 'ellipse'))
      this.#drawn.set(id, kind.outline(added.values).path);
  }

  /** What was drawn by hand, as a path. */
  #strokes(tag: Tag): string {
    const paths = pieces(tag).map((piece) => {
      const values = new Values(texts(piece), this.scale);
      return line(values.point('begin'), values.point('end'));
    });
    return paths.join('') || 'M0 0';
  }

  #add(kind: Kind, tag: Tag, more: [string, string][], on?: string): string {
    const count = this.#counts.get(kind.name) ?? 0;
    this.#counts.set(kind.name, count + 1);
    const key = `${kind.name} ${count}`;
    this.tags.set(key, tag);
    const own = this.text.slice(tag.from, tag.openTo);
    const source = JSON.stringify([own, more, this.scale, on]);
    const old = this.before?.byKey.get(key);
    const item = old?.source === source ? old : this.#made(key, kind, tag, more, source, on);
    this.items.push(item);
    return key;
  }

  #made(key: string, kind: Kind, tag: Tag, more: [string, string][], source: string, on?: string): Item {
    const values = new Values({ ...texts(tag), ...Object.fromEntries(more) }, this.scale);
    return { key, kind, id: values.text('id'), values, source, ...(on ? { on } : {}) };
  }
}

/** Attributes of a thing become others; undefined takes one away. */
export function changed(
  { document, tags, byKey }: WorldModel,
  key: string,
  changes: Readonly<Record<string, string | undefined>>,
): Splice[] {
  const [item, tag] = [byKey.get(key), tags.get(key)];
  if (!item || !tag) return [];
  const within = new Map(item.kind.attributes.map((one) => [one.name, one.within]));
  const own = Object.entries(changes).filter(([name]) => !within.get(name) && name !== PIECES);
  const splices = set(tag, Object.fromEntries(own));
  const way = changes[PIECES];
  if (way !== undefined) splices.push(...movedPieces(item, tag, way));
  for (const [name, next] of Object.entries(changes)) {
    const inner = within.get(name);
    if (!inner) continue;
    // Of a robot that stands elsewhere too, its own tag has it.
    const holder = robotTag({ document, tags, byKey }, key) ?? tag;
    const there = child(holder, inner);
    if (there) splices.push(...set(there, { [name]: next }));
    else if (next !== undefined)
      splices.push(...insert(document, holder, `<${inner} ${name}="${encoded(next)}"/>`));
  }
  return splices;
}

/** The tag in `robots` of a robot. */
function robotTag(
  { document, byKey }: Pick<WorldModel, 'document' | 'tags' | 'byKey'>,
  key: string,
): Tag | undefined {
  if (byKey.get(key)?.kind.name !== 'robot') return undefined;
  const root =
    document.root.name === 'root' ? document.root : (child(document.root, 'root') ?? document.root);
  const robots = root.children.filter(({ name }) => name === 'robots').flatMap((list) => list.children);
  return robots.filter(({ name }) => name === 'robot')[Number(key.split(' ')[1])];
}

/** A setting becomes another one. Where there were none, the unit is written too: without it lengths would be others. */
export function withSetting(found: WorldModel, name: string, next: string | undefined): Splice[] {
  const settings = child(found.root, 'settings');
  if (settings) return set(settings, { [name]: next });
  if (next === undefined) return [];
  const unit = name === 'sizeUnit' ? '' : `sizeUnit="${found.unit}" `;
  return insert(found.document, found.root, `<settings ${unit}${name}="${encoded(next)}"/>`, 0);
}

/** A thing goes away; a robot takes what is on it along. */
export function without(found: WorldModel, key: string): Splice[] {
  const tag = robotTag(found, key) ?? found.tags.get(key);
  return tag ? remove(found.document, tag) : [];
}

/** What of a thing moves along when all of it is moved by so many pixels. */
export function shifted(item: Item, right: number, down: number): Record<string, string> {
  const changes: Record<string, string> = {};
  for (const grip of item.kind.moves) Object.assign(changes, moved(item, grip, right, down));
  return changes;
}

/** What changes when one of its grips is moved by so many pixels. */
export function moved(
  { values, kind }: Item,
  grip: Grip,
  right: number,
  down: number,
): Record<string, string> {
  switch (grip.is) {
    case 'point': {
      const [x, y] = values.point(grip.name);
      return { [grip.name]: values.writePoint(x + right, y + down) };
    }
    case 'pair':
      return movedPair(values, kind, grip.names, right, down);
    case 'size': {
      const [width, height] = values.pair(grip.names, 200);
      const least = grip.least;
      const [across, high] = [Math.max(width + right, least), Math.max(height + down, least)];
      return { [grip.names[0]]: values.write(across), [grip.names[1]]: values.write(high) };
    }
    case 'box': {
      const name = pictureRect(values);
      const [x = 0, y = 0, width = 0, height = 0] = values.lengths(name, 4);
      return { [name]: values.writePoint(x + right, y + down, width, height) };
    }
    case 'pieces':
      return { [PIECES]: carriedTo(values.text(PIECES), right, down) };
    case 'turn':
      return {};
  }
}

function movedPair(
  values: Values,
  kind: Kind,
  names: readonly [string, string],
  right: number,
  down: number,
): Record<string, string> {
  const byDefault = Number(kind.attributes.find(({ name }) => name === names[0])?.default ?? 0);
  const [x, y] = values.pair(names, byDefault);
  const isMarker = names[0] === 'markerX';
  // A marker that stands elsewhere on purpose stays there.
  const at = isMarker ? values.pair(['x', 'y']) : [x, y];
  if (isMarker && (!values.has('markerX') || at[0] !== x || at[1] !== y)) return {};
  if (!isMarker && names[0] === 'x' && values.has('begin')) {
    const [left, top] = values.point('begin');
    return { begin: values.writePoint(left + right, top + down) };
  }
  return { [names[0]]: values.write(x + right), [names[1]]: values.write(y + down) };
}

/** Where a grip is, in pixels; of one that turns, ahead of the thing. */
export function gripAt({ values, kind }: Item, grip: Grip, reach: number): Spot {
  switch (grip.is) {
    case 'point':
      return values.point(grip.name);
    case 'pair':
      return values.pair(grip.names);
    case 'size': {
      const [x, y] = values.pair(grip.at);
      const [width, height] = values.pair(grip.names, 200);
      return [x + width, y + height];
    }
    case 'box': {
      const [x, y, width, height] = pictureBox(values);
      return [x + width, y + height];
    }
    case 'pieces':
      return beginOf(values.text(PIECES));
    case 'turn': {
      const { turn } = kind.outline(values);
      const radians = ((turn?.angle ?? 0) * Math.PI) / 180;
      const [x, y] = turn?.at ?? [0, 0];
      return [x + reach * Math.cos(radians), y + reach * Math.sin(radians)];
    }
  }
}

/** What changes when a grip is drawn to a place: to a size, if it is the corner of one. */
export function drawnTo(item: Item, grip: Grip, [x, y]: Spot): Record<string, string> {
  const { values, kind } = item;
  if (grip.is === 'turn') {
    const [atX, atY] = kind.outline(values).turn?.at ?? [0, 0];
    const degrees = (Math.atan2(y - atY, x - atX) * 180) / Math.PI;
    return { [grip.name]: String(Math.round(degrees)) };
  }
  const [fromX, fromY] = gripAt(item, grip, 0);
  if (grip.is !== 'box') return moved(item, grip, x - fromX, y - fromY);
  const name = pictureRect(values);
  const [left = 0, top = 0] = values.lengths(name, 4);
  const [seenX, seenY] = pictureBox(values);
  const [, , wide, high] = pictureBox(values);
  // A hand keeps the proportions; the fields take any size.
  const across = Math.max(x - seenX, 1);
  const down = wide > 0 && high > 0 ? (across * high) / wide : Math.max(y - seenY, 1);
  return { [name]: values.writePoint(left, top, across, down) };
}

/** Where a thing is taken to be when it snaps to the grid. */
export function anchorOf(item: Item): Spot {
  const { values, kind } = item;
  const { turn } = kind.outline(values);
  if (turn) return turn.at;
  const [first] = kind.moves;
  if (!first) return [0, 0];
  const [x, y] = pictureBox(values);
  return first.is === 'box' ? [x, y] : gripAt(item, first, 0);
}

/** A name that nothing in the world has. */
export function freeId({ items }: WorldModel, stem: string): string {
  const ids = new Set(items.map(({ id }) => id));
  let at = 1;
  while (ids.has(`${stem}${at}`)) at += 1;
  return `${stem}${at}`;
}

/** What a new thing between two places will say. */
export function sketched(kind: Kind, from: Spot, to: Spot, scale: number): Values {
  const values = new Values({}, scale);
  const attributes = { ...places(values, kind, from, to), ...Object.fromEntries(fixed(values, kind)) };
  return new Values(attributes, scale);
}

/** What a new thing has beside its places: the id of the image that it shows, and where a hand went between its ends. */
export interface Contents {
  imageId?: string;
  way?: readonly Spot[];
}

/** A new thing between two places, and the key that it will have. */
export function added(
  found: WorldModel,
  kind: Kind,
  from: Spot,
  to: Spot,
  { imageId, way }: Contents = {},
): { splices: Splice[]; key: string } {
  const { scale, texts: own } = sketched(kind, from, to, UNITS[found.unit].pixels);
  const values = new Values(imageId === undefined ? own : { imageId, ...own }, scale);
  const key = `${kind.name} ${found.items.filter((item) => item.kind === kind).length}`;
  const written = Object.entries(values.texts)
    .filter(([name]) => name !== PIECES)
    .map(([name, text]) => ` ${name}="${encoded(text)}"`)
    .join('');
  if (kind.creation === 'robot') {
    const start = `<startPosition x="${values.write(from[0])}" y="${values.write(from[1])}" direction="0"/>`;
    const wheels = '<wheels left="M4###output######M4" right="M3###output######M3"/>';
    const xml = `<robot id="trikKitRobot"${written}>\n    <sensors/>\n    ${start}\n    ${wheels}\n</robot>`;
    return { splices: inList(found, found.root, 'robots', xml), key };
  }
  if (kind.creation === 'start') {
    const robot = found.tags.get('robot 0');
    return { splices: robot ? insert(found.document, robot, `<${kind.tag}${written}/>`) : [], key };
  }
  const id = freeId(found, kind.tag);
  const world = child(found.root, 'world');
  const inner = kind.creation === 'strokes' ? strokes(values, way ?? wave(from, to)) : '';
  const open = `<${kind.tag} id="${id}"${written}`;
  const xml = inner ? `${open}>${inner}\n</${kind.tag}>` : `${open}/>`;
  return { splices: world ? inList(found, world, kind.list, xml) : [], key };
}

function inList({ document }: WorldModel, outside: Tag, list: string, xml: string): Splice[] {
  const there = child(outside, list);
  if (there) return insert(document, there, xml);
  const inner = xml.replaceAll('\n', '\n    ');
  return insert(document, outside, `<${list}>\n    ${inner}\n</${list}>`);
}

function fixed(values: Values, { made }: Kind): [string, string][] {
  return Object.entries(made ?? {}).map(([name, one]) => [
    name,
    typeof one === 'number' ? values.write(one) : one,
  ]);
}

/** The places of a new thing, as its attributes have them. */
function places(values: Values, { creation }: Kind, [x, y]: Spot, [toX, toY]: Spot): Record<string, string> {
  const begin = values.writePoint(x, y);
  const end = values.writePoint(toX, toY);
  switch (creation) {
    case 'span':
    case 'corners':
      return { begin, end };
    case 'curve': {
      // A bend to the left of the way.
      const [right, down] = [(toX - x) / 3, (toY - y) / 3];
      const cp1 = values.writePoint(x + right + down, y + down - right);
      const cp2 = values.writePoint(toX - right + down, toY - down - right);
      return { begin, cp1, cp2, end };
    }
    case 'size':
      return {
        x: values.write(Math.min(x, toX)),
        y: values.write(Math.min(y, toY)),
        width: values.write(Math.abs(toX - x)),
        height: values.write(Math.abs(toY - y)),
      };
    case 'spot': {
      const [at, down] = [values.write(x), values.write(y)];
      return { x: at, y: down, rotation: '0', markerX: at, markerY: down, startRotation: '0' };
    }
    case 'robot':
      return { position: values.writePoint(x - ROBOT_PX / 2, y - ROBOT_PX / 2), direction: '0' };
    case 'start':
      return { x: values.write(x), y: values.write(y), direction: '0' };
    case 'picture': {
      const [left, top] = [Math.min(x, toX), Math.min(y, toY)];
      const rect = values.writePoint(left, top, Math.abs(toX - x), Math.abs(toY - y));
      return { rect, position: values.writePoint(0, 0), isBackground: 'false' };
    }
    case 'strokes':
      return { [PIECES]: pathOf(wave([x, y], [toX, toY])) };
    default:
      return {};
  }
}

/** A sensor more on a robot, in its middle, and the key that it will have. */
export function withSensor(found: WorldModel, robot: string, type: string, port: string): Splice[] {
  const tag = robotTag(found, robot);
  const item = found.byKey.get(robot);
  if (!tag || !item) return [];
  const [width, height] = item.values.pair(['width', 'height'], ROBOT_PX);
  const position = item.values.writePoint(width, height / 2);
  const xml = `<sensor port="${encoded(port)}" type="${encoded(type)}" position="${position}" direction="0"/>`;
  return inList(found, tag, 'sensors', xml);
}

/** Left, top, right and bottom of everything, in pixels; of an empty world a robot's room. */
export function boundsOf({ items }: WorldModel): [number, number, number, number] {
  const bounds: [number, number, number, number] = [Infinity, Infinity, -Infinity, -Infinity];
  const take = ([x, y]: Spot) => {
    bounds[0] = Math.min(bounds[0], x);
    bounds[1] = Math.min(bounds[1], y);
    bounds[2] = Math.max(bounds[2], x);
    bounds[3] = Math.max(bounds[3], y);
  };
  for (const item of items) {
    if (item.on && item.kind.name === 'sensor') continue;
    const [x, y] = anchorOf(item);
    take([x - ROBOT_PX / 2, y - ROBOT_PX / 2]);
    take([x + ROBOT_PX / 2, y + ROBOT_PX / 2]);
    for (const grip of [...item.kind.moves, ...item.kind.grips])
      if (grip.is !== 'turn' && !grip.name.startsWith('marker')) take(gripAt(item, grip, 0));
  }
  return bounds[0] <= bounds[2] ? bounds : [-200, -200, 200, 200];
}

/** Whatever an attribute means where it is not written, in the unit of the file. */
export function defaultOf(facts: AttributeFacts, scale: number): string {
  if (facts.takes !== 'length' && facts.takes !== 'point') return facts.default;
  return new Values({}, scale).write(Number(facts.default) || 0);
}

/** A new world: a small room with a robot in it. */
export const NEW_WORLD = `<root version="20251219">
    <settings sizeUnit="cm" realisticPhysics="false" realisticSensors="false" realisticMotors="false"/>
    <world>
        <walls>
            <wall id="north" begin="-30:-30" end="150:-30"/>
            <wall id="east" begin="150:-30" end="150:90"/>
            <wall id="south" begin="150:90" end="-30:90"/>
            <wall id="west" begin="-30:90" end="-30:-30"/>
        </walls>
        <colorFields/>
        <regions/>
    </world>
    <robots>
        <robot id="trikKitRobot" position="-8.75:21.25" direction="0">
            <sensors/>
            <startPosition x="0" y="30" direction="0"/>
            <wheels left="M4###output######M4" right="M3###output######M3"/>
        </robot>
    </robots>
</root>
`;
