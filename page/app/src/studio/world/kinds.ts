// The kinds of things in a world: the tag of each, its attributes, how it is drawn, what of it a hand can take hold of.
//
// Owns that table. Knows no text and no element of the page; lengths are pixels of TRIK Studio.

import { MOTORS, PORTS, SENSORS, sensorPort } from './sensors';
import { type Spot, Values, colour } from './units';

/** What an attribute takes, which decides what its field is. */
export type Takes =
  | 'length'
  | 'point'
  | 'box'
  | 'angle'
  | 'number'
  | 'colour'
  | 'choice'
  | 'truth'
  | 'text'
  | 'long'
  | 'drawn'
  | 'port';

export interface AttributeFacts {
  name: string;
  takes: Takes;
  /** The name of its title, if it is not that of the attribute. */
  title?: string;
  /** What counts where it is not written; of lengths in pixels. */
  default: string;
  choices?: readonly string[];
  /** The tag in that of the thing which has it. */
  within?: string;
  /** It means something with realistic physics only. */
  isPhysics?: boolean;
}

/**
 * What is where, as attributes have it: `x:y` in one, two of one number, or the lower right corner of a size. Pieces are a path
 * that the model has made of tags in the thing.
 */
export type Grip =
  | { is: 'point'; name: string }
  | { is: 'pair'; name: string; names: readonly [string, string] }
  | {
      is: 'size';
      name: string;
      at: readonly [string, string];
      names: readonly [string, string];
      least: number;
    }
  | { is: 'box'; name: string }
  | { is: 'turn'; name: string }
  | { is: 'pieces'; name: string };

/** How a thing is drawn. */
export interface Outline {
  path: string;
  stroke: string;
  width: number;
  dash?: string;
  fill?: string;
  /** Where it is turned around, and by how many degrees. */
  turn?: { angle: number; at: Spot };
  caption?: string;
  captionAt?: Spot;
}

/**
 * How a new one is made of two places: from one to the other, as a rectangle of both, or at the first. Strokes are made of all
 * places between them, a picture of a file of the person.
 */
export type Creation =
  'span' | 'curve' | 'corners' | 'size' | 'spot' | 'robot' | 'start' | 'strokes' | 'picture';

export const KIND_NAMES = [
  'background',
  'image',
  'stylus',
  'rectangle',
  'ellipse',
  'line',
  'curve',
  'trace',
  'regionRectangle',
  'regionEllipse',
  'regionBound',
  'comment',
  'wall',
  'skittle',
  'ball',
  'cube',
  'start',
  'robot',
  'sensor',
] as const;
export type KindName = (typeof KIND_NAMES)[number];

export interface Kind {
  name: KindName;
  tag: string;
  /** The tag that has them; of sensors and starts that of the robot. */
  list: string;
  /** Attributes that tell it from others of the tag, the first one where none is written. */
  when?: Readonly<Record<string, string>>;
  attributes: readonly AttributeFacts[];
  /** What goes along when all of it is moved. */
  moves: readonly Grip[];
  grips: readonly Grip[];
  outline(values: Values): Outline;
  /** How a person adds one; undefined: not here. */
  creation?: Creation;
  /** Attributes of a new one; lengths are pixels. */
  made?: Readonly<Record<string, string | number>>;
}

const facts = (
  name: string,
  takes: Takes,
  byDefault = '',
  rest: Partial<AttributeFacts> = {},
): AttributeFacts => ({
  name,
  takes,
  default: byDefault,
  ...rest,
});
const ID = facts('id', 'text');
const BEGIN = facts('begin', 'point', '0');
const END = facts('end', 'point', '0');
const STYLES = ['solid', 'dot', 'dash', 'dashdot', 'dashdotdot', 'none'];
const STROKE = facts('stroke', 'colour', '#000000');
const STYLE = facts('stroke-style', 'choice', 'solid', { choices: STYLES });
const PEN = [STROKE, facts('stroke-width', 'length', '0'), STYLE];
const BRUSH = [
  facts('fill-style', 'choice', 'none', { choices: ['none', 'solid'] }),
  facts('fill', 'colour', '#000000'),
];

/** What a thing is made of. */
const material = (mass: number, friction: number, restitution: number, damping: number): AttributeFacts[] => {
  const row = (name: string, byDefault: number) =>
    facts(name, 'number', String(byDefault), { isPhysics: true });
  return [
    row('mass', mass),
    row('friction', friction),
    row('restitution', restitution),
    row('angularDamping', damping),
    row('linearDamping', damping),
  ];
};

const point = (name: string): Grip => ({ is: 'point', name });
const pair = (name: string, x: string, y: string): Grip => ({ is: 'pair', name, names: [x, y] });
const AT = pair('place', 'x', 'y');
const SIZE: Grip = { is: 'size', name: 'size', at: ['x', 'y'], names: ['width', 'height'], least: 1 };
const ENDS = [point('begin'), point('end')];

/** Lengths of dashes of a pen, as TRIK Studio has them: in widths of the pen. */
const DASHES: Record<string, readonly number[]> = {
  dot: [1, 2],
  dash: [4, 2],
  dashdot: [4, 2, 1, 2],
  dashdotdot: [4, 2, 1, 2, 1, 2],
};

/** The look of what is drawn with a pen. */
function pen(values: Values, path: string, hasInside = true): Outline {
  const style = values.text('stroke-style', 'solid');
  const width = Math.abs(values.length('stroke-width'));
  const dashes = DASHES[style]?.map((one) => one * Math.max(width, 1)).join(' ');
  const fill = hasInside && values.text('fill-style') === 'solid' ? colour(values.text('fill')) : 'none';
  return {
    path,
    stroke: style === 'none' ? 'none' : colour(values.text('stroke')),
    width,
    fill,
    ...(dashes ? { dash: dashes } : {}),
  };
}

export const line = ([x, y]: Spot, [toX, toY]: Spot): string => `M${x} ${y}L${toX} ${toY}`;
export const rectangle = (x: number, y: number, width: number, height: number): string =>
  `M${x} ${y}h${width}v${height}h${-width}z`;
/** Within the rectangle of two corners. */
export const ellipse = (x: number, y: number, width: number, height: number): string => {
  const [across, down] = [Math.abs(width) / 2, Math.abs(height) / 2];
  const [left, middle] = [Math.min(x, x + width), y + height / 2];
  const half = (way: number) => `a${across} ${down} 0 1 0 ${way} 0`;
  return `M${left} ${middle}${half(2 * across)}${half(-2 * across)}z`;
};

const boxOf = (values: Values): [number, number, number, number] => {
  const [x, y] = values.point('begin');
  const [toX, toY] = values.point('end');
  return [Math.min(x, toX), Math.min(y, toY), Math.abs(toX - x), Math.abs(toY - y)];
};
const regionBox = (values: Values): [number, number, number, number] => [
  ...values.pair(['x', 'y']),
  ...values.pair(['width', 'height'], 200),
];

const REGION: readonly AttributeFacts[] = [
  ID,
  facts('type', 'choice', 'ellipse', { choices: ['rectangle', 'ellipse', 'bound'] }),
  facts('x', 'length', '0'),
  facts('y', 'length', '0'),
  facts('width', 'length', '200'),
  facts('height', 'length', '200'),
  facts('visible', 'truth', 'false'),
  facts('filled', 'truth', 'true'),
  facts('color', 'colour', '#87cefa'),
  facts('text', 'text'),
  facts('textX', 'length', '0'),
  facts('textY', 'length', '0'),
];

/** An id that a person has given: others are long and say nothing. */
export const nameOf = (id: string): string => (id.startsWith('{') ? '' : id);

function region(values: Values, path: string): Outline {
  const [x, y] = values.pair(['x', 'y']);
  const [right, down] = values.pair(['textX', 'textY']);
  const tint = colour(values.text('color', '#87cefa'), '#87cefa');
  const isFilled = values.text('filled', 'true') === 'true';
  return {
    path,
    stroke: tint,
    width: 2,
    dash: values.text('visible') === 'true' ? '' : '6 4',
    fill: isFilled ? tint : 'none',
    caption: values.text('text') || nameOf(values.text('id')),
    captionAt: [x + right, y + down],
  };
}

/** Where a ball, skittle or cube has its centre: of old worlds beside the corner that they name. */
export function centreOf(values: Values, size: number): Spot {
  if (!values.has('begin')) return values.pair(['x', 'y']);
  const [x, y] = values.point('begin');
  return [x + size / 2, y + size / 2];
}

/** A row of things that are pushed about. */
function solid(
  name: 'skittle' | 'ball' | 'cube',
  list: string,
  [sizeName, size]: [string, number],
  made: readonly AttributeFacts[],
  [stroke, fill]: [string, string],
): Kind {
  const angles = [facts('rotation', 'angle', '0'), facts('startRotation', 'angle', '0')];
  return {
    name,
    tag: name,
    list,
    attributes: [
      ID,
      facts('x', 'length', '0'),
      facts('y', 'length', '0'),
      facts(sizeName, 'length', String(size)),
      ...angles,
      facts('markerX', 'length', '0'),
      facts('markerY', 'length', '0'),
      ...made,
    ],
    moves: [AT, pair('marker', 'markerX', 'markerY')],
    grips: [],
    outline(values) {
      const wide = Math.abs(values.length(sizeName, size));
      const [x, y] = centreOf(values, wide);
      const box = [x - wide / 2, y - wide / 2, wide, wide] as const;
      const path = name === 'cube' ? rectangle(...box) : ellipse(...box);
      return { path, stroke, width: 1.5, fill, turn: { angle: values.plain('rotation'), at: [x, y] } };
    },
    creation: 'spot',
  };
}

const PICTURE: readonly AttributeFacts[] = [
  ID,
  facts('imageId', 'text'),
  facts('rect', 'box', '0'),
  facts('position', 'point', '0', { title: 'moved' }),
  facts('isBackground', 'truth', 'false'),
];

/** Whether a thing shows an image. */
export const isPicture = ({ kind }: { kind: Kind }): boolean => kind.attributes === PICTURE;

/** The attribute in which a picture has its place: old worlds have another one. */
export const pictureRect = (values: Values): string =>
  values.has('backgroundRect') ? 'backgroundRect' : 'rect';

/** Where a picture is: its rectangle, moved. */
export function pictureBox(values: Values): [number, number, number, number] {
  const name = pictureRect(values);
  const [x = 0, y = 0, width = 0, height = 0] = values.lengths(name, 4);
  const [right, down] = name === 'rect' ? values.point('position') : [0, 0];
  return [x + right, y + down, width, height];
}

/** A picture: its place alone; what it shows is in the save. */
function picture(name: 'background' | 'image', list: string): Kind {
  return {
    name,
    tag: name,
    list,
    attributes: PICTURE,
    moves: [{ is: 'box', name: 'rect' }],
    grips: [{ is: 'box', name: 'rect' }],
    // New ones stand in the list: TRIK Studio writes no other.
    ...(name === 'image' ? { creation: 'picture' as const } : {}),
    outline(values) {
      const [x, y, width, height] = pictureBox(values);
      const path = rectangle(x, y, width, height);
      // What it shows is drawn below it.
      return { path, stroke: '#8a8f94', width: 1, dash: '3 3', fill: '#8a8f9400' };
    },
  };
}

const corners = (name: 'rectangle' | 'ellipse', path: typeof rectangle): Kind => ({
  name,
  tag: name,
  list: 'colorFields',
  attributes: [ID, BEGIN, END, ...PEN, ...BRUSH],
  moves: ENDS,
  grips: ENDS,
  outline: (values) => pen(values, path(...boxOf(values))),
  creation: 'corners',
  made: { stroke: '#000000', 'stroke-width': 6 },
});

const regions = (name: 'regionRectangle' | 'regionEllipse', type: string, path: typeof rectangle): Kind => ({
  name,
  tag: 'region',
  list: 'regions',
  when: { type },
  attributes: REGION,
  moves: [AT],
  grips: [SIZE],
  outline: (values) => region(values, path(...regionBox(values))),
  creation: 'size',
  made: { type, visible: 'true', color: '#66bb6a' },
});

/** The side of a robot, which is a square by default. */
export const ROBOT_PX = 50;

/** A beam ahead of what stands somewhere and looks somewhere, as long as this. */
const arrow = ([x, y]: Spot, length: number): string => `M${x} ${y}h${length}m-6 -4l6 4l-6 4`;

/** Every kind; the lowest on the sheet first. Of one tag, the first row whose attributes it has counts. */
export const KINDS: readonly Kind[] = [
  picture('background', 'world'),
  picture('image', 'images'),
  {
    name: 'stylus',
    tag: 'stylus',
    list: 'colorFields',
    attributes: [ID, ...PEN],
    moves: [{ is: 'pieces', name: 'pieces' }],
    grips: [],
    // Its pieces are tags in it, which the model puts together.
    outline: (values) => pen(values, values.text('pieces', 'M0 0'), false),
    creation: 'strokes',
    made: { stroke: '#000000', 'stroke-width': 6 },
  },
  corners('rectangle', rectangle),
  corners('ellipse', ellipse),
  {
    name: 'line',
    tag: 'line',
    list: 'colorFields',
    attributes: [ID, BEGIN, END, ...PEN],
    moves: ENDS,
    grips: ENDS,
    outline: (values) => pen(values, line(values.point('begin'), values.point('end')), false),
    creation: 'span',
    made: { stroke: '#000000', 'stroke-width': 6 },
  },
  {
    name: 'curve',
    tag: 'cubicBezier',
    list: 'colorFields',
    attributes: [ID, BEGIN, facts('cp1', 'point', '0'), facts('cp2', 'point', '0'), END, ...PEN],
    moves: [...ENDS, point('cp1'), point('cp2')],
    grips: [...ENDS, point('cp1'), point('cp2')],
    outline(values) {
      const [begin, first, second, end] = ['begin', 'cp1', 'cp2', 'end'].map((name) => values.point(name));
      return pen(
        values,
        `M${begin?.join(' ')}C${first?.join(' ')} ${second?.join(' ')} ${end?.join(' ')}`,
        false,
      );
    },
    creation: 'curve',
    made: { stroke: '#000000', 'stroke-width': 6 },
  },
  {
    name: 'trace',
    tag: 'segment',
    list: 'trace',
    attributes: [
      ...['x1', 'y1', 'x2', 'y2'].map((name) => facts(name, 'length', '0')),
      facts('color', 'colour', '#000000'),
      facts('width', 'length', '0'),
    ],
    moves: [pair('begin', 'x1', 'y1'), pair('end', 'x2', 'y2')],
    grips: [pair('begin', 'x1', 'y1'), pair('end', 'x2', 'y2')],
    outline: (values) => ({
      path: line(values.pair(['x1', 'y1']), values.pair(['x2', 'y2'])),
      stroke: colour(values.text('color')),
      width: values.length('width'),
    }),
  },
  regions('regionRectangle', 'rectangle', rectangle),
  regions('regionEllipse', 'ellipse', ellipse),
  {
    name: 'regionBound',
    tag: 'region',
    list: 'regions',
    when: { type: 'bound' },
    attributes: [
      ...REGION.slice(0, 2),
      facts('boundItem', 'drawn'),
      facts('stroke', 'length', '0'),
      ...REGION.filter(({ name }) => ['visible', 'filled', 'color', 'text'].includes(name)),
    ],
    moves: [],
    grips: [],
    // The outline is that of the drawn thing, which the model has found.
    outline: (values) => ({ ...region(values, values.text('pieces', 'M0 0')), fill: 'none', width: 4 }),
  },
  {
    name: 'comment',
    tag: 'comment',
    list: 'comments',
    attributes: [ID, BEGIN, END, facts('text', 'long')],
    moves: ENDS,
    grips: ENDS,
    outline(values) {
      const [x, y, width, height] = boxOf(values);
      const caption = plainText(values.text('text'));
      const at: Spot = [x, y];
      return {
        path: rectangle(x, y, width, height),
        stroke: '#8a8f94',
        width: 1,
        dash: '2 3',
        caption,
        captionAt: at,
      };
    },
    creation: 'corners',
    made: { text: '' },
  },
  {
    name: 'wall',
    tag: 'wall',
    list: 'walls',
    attributes: [
      ID,
      BEGIN,
      END,
      facts('stroke-width', 'length', '10'),
      STROKE,
      facts('stroke-style', 'choice', 'solid', { choices: ['solid', 'none'] }),
      ...material(0, 1, 0.8, 0),
    ],
    moves: ENDS,
    grips: ENDS,
    outline(values) {
      const width = Math.abs(values.length('stroke-width')) || 10;
      const path = line(values.point('begin'), values.point('end'));
      return { path, stroke: '#8d6e63', width };
    },
    creation: 'span',
  },
  solid('skittle', 'skittles', ['diameter', 20], material(0.05, 0.2, 0.8, 6), ['#7f2704', '#e8590c']),
  solid('ball', 'balls', ['diameter', 30], material(0.015, 1, 0.8, 0.09), ['#5f2a06', '#f2a65a']),
  solid('cube', 'cubes', ['edgeSize', (4 * 16) / 5.6], material(0.1, 0.3, 0.8, 6), ['#1b4965', '#62b6cb']),
  {
    name: 'start',
    tag: 'startPosition',
    list: 'robot',
    attributes: [facts('x', 'length', '25'), facts('y', 'length', '25'), facts('direction', 'angle', '0')],
    moves: [AT],
    grips: [{ is: 'turn', name: 'direction' }],
    outline(values) {
      const at = values.pair(['x', 'y'], 25);
      const [x, y] = at;
      const path = `M${x - 8} ${y}h16M${x} ${y - 8}v16${arrow(at, 30)}`;
      return { path, stroke: '#c62828', width: 2, turn: { angle: values.plain('direction'), at } };
    },
    creation: 'start',
  },
  {
    name: 'robot',
    tag: 'robot',
    list: 'robots',
    attributes: [
      facts('position', 'point', '0', { title: 'corner' }),
      facts('direction', 'angle', '0'),
      facts('width', 'length', String(ROBOT_PX)),
      facts('height', 'length', String(ROBOT_PX)),
      facts('left', 'port', MOTORS[3], { choices: MOTORS, within: 'wheels' }),
      facts('right', 'port', MOTORS[2], { choices: MOTORS, within: 'wheels' }),
      ...material(1.05, 0.3, 0.6, 1),
    ],
    moves: [point('position')],
    grips: [{ is: 'turn', name: 'direction' }],
    outline(values) {
      const [x, y] = values.point('position');
      const [width, height] = values.pair(['width', 'height'], ROBOT_PX);
      const at: Spot = [x + width / 2, y + height / 2];
      const wheels = [y - 3, y + height - 5].map((top) => rectangle(x + width * 0.25, top, width * 0.5, 8));
      const path = `${rectangle(x, y, width, height)}${wheels.join('')}${arrow(at, width / 2)}`;
      return {
        path,
        stroke: '#1b5e9b',
        width: 2,
        fill: '#8ec1f066',
        turn: { angle: values.plain('direction'), at },
      };
    },
    creation: 'robot',
  },
  {
    name: 'sensor',
    tag: 'sensor',
    list: 'robot',
    attributes: [
      facts('type', 'choice', '', { choices: SENSORS.map(({ type }) => type) }),
      facts('port', 'port', '', { choices: (Object.keys(PORTS) as (keyof typeof PORTS)[]).map(sensorPort) }),
      facts('position', 'point', '0'),
      facts('direction', 'angle', '0'),
    ],
    moves: [point('position')],
    grips: [],
    outline(values) {
      const at = values.point('position');
      const [x, y] = at;
      const path = `${ellipse(x - 5, y - 5, 10, 10)}${arrow(at, 14)}`;
      return {
        path,
        stroke: '#00695c',
        width: 1.5,
        fill: '#b2dfdb',
        turn: { angle: values.plain('direction'), at },
      };
    },
  },
];

/** The words of a comment, which is HTML. */
export function plainText(html: string): string {
  // Of a long one the beginning is enough.
  const body = html
    .slice(0, 4000)
    .replace(/<(style|head|script)\b[^]*?<\/\1\s*>/gi, '')
    .replace(/<[^>]*>/g, ' ');
  const entities: Record<string, string> = { lt: '<', gt: '>', quot: '"', nbsp: ' ', amp: '&' };
  const read = body.replace(/&(lt|gt|quot|nbsp|amp);/g, (whole, name: string) => entities[name] ?? whole);
  return read.replace(/\s+/g, ' ').trim();
}

/** Settings of the world, in its tag `settings`. */
export const SETTINGS: readonly AttributeFacts[] = [
  facts('sizeUnit', 'choice', 'px', { choices: ['px', 'cm', 'mm', 'm'] }),
  facts('realisticPhysics', 'truth', 'false'),
  facts('realisticSensors', 'truth', 'false'),
  facts('realisticMotors', 'truth', 'false'),
  facts('backgroundColor', 'colour', '#ffffff'),
];
