// The world as the simulator tells it: what stands still, and what moves. `sim/src/show/text.rs` makes these texts.
//
// Lengths are metres with x to the right and y up, angles degrees counter-clockwise.

/** A place and a heading: x, y, degrees. */
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

/** What a marker has left in one piece: both ends and the colour. */
export type Mark = [x: number, y: number, toX: number, toY: number, colour: string];

/** Something that can be moved. */
export interface Movable {
  is: 'ball' | 'skittle' | 'cube';
  size: number;
  colour: string;
}

export interface Wheel {
  port: string;
  /** Ahead of the centre and to the left. */
  at: [number, number];
  radius: number;
}

export interface Sensor {
  is: 'infrared' | 'sonar' | 'light' | 'touch' | 'camera' | 'lidar';
  port: string;
  /** Ahead of the centre and to the left. */
  at: [number, number];
  degrees: number;
  /** 0: it measures no distance. */
  reach: number;
  /** Degrees across its beam. */
  beam: number;
}

/** A robot as it is built. */
export interface Shape {
  /** Length and width. */
  size: [number, number];
  round: boolean;
  wheels: Wheel[];
  sensors: Sensor[];
}

/** What stands still. */
export interface Scene {
  /** Left, bottom, right and top. */
  bounds: [number, number, number, number];
  /** Colour of the floor. */
  floor: string;
  /** The lowest first. */
  items: Item[];
  marks: Mark[];
  things: Movable[];
  start: Place;
  robots: Shape[];
  locked: { world: boolean; robot: boolean };
  /** Other worlds can be loaded. */
  fields: boolean;
  /** Devices of the board, and the faults that each can have. */
  devices: [name: string, kinds: string[]][];
}

/** A robot where it is. */
export interface Placed {
  at: Place;
  /** By the sensors of its shape: metres, a share of dark, 1 for pressed; null: nothing is in reach. */
  read: (number | null)[];
  /** What a lidar sees, counter-clockwise from ahead. */
  rays: (number | null)[];
  stuck: boolean;
  /** The colour of a marker that draws; empty if none does. */
  marker: string;
}

/** What moves. */
export interface WorldState {
  /** Seconds of the world. */
  t: number;
  paused: boolean;
  speed: number;
  robots: Placed[];
  things: Place[];
  led: '' | 'green' | 'red' | 'orange';
  said: string;
  /** Devices that are broken, and what is wrong with each. */
  faults: Record<string, string>;
}
