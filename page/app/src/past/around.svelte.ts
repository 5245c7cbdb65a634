// The world at a moment of a recording: as the simulator told it, or as a real robot tells of itself.
//
// Owns the reading of what was told; docs/user/journal.md has its form. Believes nothing.

import { PLACES_TRIED_MAX, SCENE_ITEMS_MAX, SHAPE_PARTS_MAX, SLICE_MS, THINGS_MAX } from '../limits';
import { isObject } from '../robot/plain';
import type { Line } from '../robot/recording';
import type { Known } from '../robot/robot.svelte';
import type { Around } from '../world/around';
import { Ground, saysWhere } from '../world/ground.svelte';
import { Trail } from '../world/trail';
import type { Item, Mark, Movable, Place, Placed, Scene, Sensor, Shape, WorldState } from '../world/types';
import { countUntil } from './steps';
import { Ways } from './ways';

/** What stood still from a time on. */
export interface SceneText {
  time: number;
  text: string;
}

/** What a recording has of a world. */
export interface Recorded {
  scenes: readonly SceneText[];
  places: readonly Line[];
}

export class PastWorld implements Around {
  scene = $state.raw<Scene | undefined>(undefined);
  state: WorldState | undefined;
  readonly trail = new Trail();
  readonly isGround = false;
  readonly #scenes: { time: number; scene: Scene }[];
  /** How many places are shown; with how many of them in the ways. */
  #shown = '';
  readonly #ways = new Ways();
  /** Places whose ways are found. */
  #found = 0;
  /** The scene of the last of these. */
  #scene: Scene | undefined;

  constructor(
    private readonly recorded: Recorded,
    private readonly now: () => number,
  ) {
    this.#scenes = recorded.scenes.flatMap(({ time, text }) => {
      const scene = sceneOf(parsed(text));
      return scene ? [{ time, scene }] : [];
    });
  }

  look(): void {
    const { places } = this.recorded;
    const now = this.now();
    // The recorder finds the world a moment after it has begun.
    const count = Math.max(1, countUntil(places, now));
    this.#find(count);
    const shown = `${count} ${Math.min(this.#found, count)}`;
    if (shown === this.#shown) return;
    this.#shown = shown;
    const at = this.#stateAt(count);
    if (at) {
      this.state = at.state;
      this.scene = this.#sceneAt(at.time);
    }
    this.#ways.cut(places[count - 1]?.time ?? now, this.trail);
  }

  /** Each place is read once for the ways, a little at a look: they are there when they are found. */
  #find(count: number): void {
    const { places } = this.recorded;
    const until_ms = performance.now() + SLICE_MS;
    for (; this.#found < count && performance.now() < until_ms; this.#found++) {
      const line = places[this.#found];
      const state = line && stateOf(parsed(line.text));
      if (!state || !line) continue;
      const scene = this.#sceneAt(line.time);
      if (scene !== this.#scene) this.#ways.tell(line.time);
      this.#scene = scene;
      this.#ways.put(line.time, state);
    }
  }

  /** The last of so many places that says something. */
  #stateAt(count: number): { time: number; state: WorldState } | undefined {
    const { places } = this.recorded;
    for (let at = count - 1; at >= Math.max(0, count - PLACES_TRIED_MAX); at--) {
      const line = places[at];
      const state = line && stateOf(parsed(line.text));
      if (state) return { time: line.time, state };
    }
    return undefined;
  }

  /** The scene of a time; before the first one it is that. */
  #sceneAt(time: number): Scene {
    const last = this.#scenes.findLast((one) => one.time <= time) ?? this.#scenes[0];
    return last?.scene ?? BARE;
  }
}

/** The world of a recording; undefined if it has nothing of it. */
export function aroundOf(
  recorded: Recorded,
  nodes: ReadonlyMap<string, Known>,
  now: () => number,
): Around | undefined {
  if (recorded.places.length > 0) return new PastWorld(recorded, now);
  return saysWhere(nodes) ? new Ground(() => nodes, now) : undefined;
}

/** A world whose scene has no room in a recording. */
export const BARE: Scene = {
  bounds: [-3, -3, 3, 3],
  floor: '#ffffff',
  items: [],
  marks: [],
  things: [],
  start: [0, 0, 0],
  robots: [{ size: [0.2, 0.2], round: false, wheels: [], sensors: [] }],
  locked: { world: true, robot: true },
  fields: false,
  devices: [],
};

function parsed(text: string): unknown {
  try {
    return JSON.parse(text) as unknown;
  } catch {
    return undefined;
  }
}

function number(value: unknown): number {
  return typeof value === 'number' && Number.isFinite(value) ? value : 0;
}

function text(value: unknown): string {
  return typeof value === 'string' ? value : '';
}

function list(value: unknown, most: number): unknown[] {
  return Array.isArray(value) ? value.slice(0, most) : [];
}

function objects(value: unknown, most: number): Record<string, unknown>[] {
  return list(value, most).filter(isObject);
}

function pair(value: unknown): [number, number] {
  const [one, other] = list(value, 2);
  return [number(one), number(other)];
}

function place(value: unknown): Place {
  const [x, y, degrees] = list(value, 3);
  return [number(x), number(y), number(degrees)];
}

/** A reading; null is none. */
function reading(value: unknown): number | null {
  return typeof value === 'number' && Number.isFinite(value) ? value : null;
}

function oneOf<T extends string>(all: readonly T[], value: unknown): T | undefined {
  return all.find((one) => one === value);
}

const LEDS = ['', 'green', 'red', 'orange'] as const;

/** What moves; undefined if it is nothing of the kind. */
export function stateOf(value: unknown): WorldState | undefined {
  if (!isObject(value) || !Array.isArray(value.robots)) return undefined;
  const faults = isObject(value.faults) ? Object.entries(value.faults).slice(0, SHAPE_PARTS_MAX) : [];
  return {
    t: number(value.t),
    paused: value.paused === true,
    speed: number(value.speed),
    robots: objects(value.robots, SHAPE_PARTS_MAX).map((robot): Placed => ({
      at: place(robot.at),
      read: list(robot.read, SHAPE_PARTS_MAX).map(reading),
      rays: list(robot.rays, THINGS_MAX).map(reading),
      stuck: robot.stuck === true,
      marker: text(robot.marker),
    })),
    things: list(value.things, THINGS_MAX).map(place),
    led: oneOf(LEDS, value.led) ?? '',
    said: text(value.said),
    faults: Object.fromEntries(faults.map(([name, what]) => [name, text(what)])),
  };
}

const ITEMS = ['line', 'strokes', 'curve', 'rect', 'ellipse', 'wall', 'text', 'image'] as const;
const THINGS = ['ball', 'skittle', 'cube'] as const;
const SENSORS = ['infrared', 'sonar', 'light', 'touch', 'camera', 'lidar'] as const;

/** What stands still; undefined if it is nothing of the kind. */
export function sceneOf(value: unknown): Scene | undefined {
  if (!isObject(value)) return undefined;
  const bounds = list(value.bounds, 4).map(number);
  const [left, bottom, right, top] = bounds;
  if (left === undefined || bottom === undefined || right === undefined || top === undefined)
    return undefined;
  if (right <= left || top <= bottom) return undefined;
  return {
    bounds: [left, bottom, right, top],
    floor: text(value.floor),
    items: objects(value.items, SCENE_ITEMS_MAX).flatMap(item),
    marks: list(value.marks, SCENE_ITEMS_MAX).map(mark),
    things: objects(value.things, THINGS_MAX).map((thing): Movable => ({
      is: oneOf(THINGS, thing.is) ?? 'ball',
      size: number(thing.size),
      colour: text(thing.colour),
    })),
    start: place(value.start),
    robots: objects(value.robots, SHAPE_PARTS_MAX).map(shape),
    // Nothing of the past is carried, broken or replaced.
    locked: { world: true, robot: true },
    fields: false,
    devices: [],
  };
}

function item(value: Record<string, unknown>): Item[] {
  const is = oneOf(ITEMS, value.is);
  if (!is) return [];
  return [
    {
      is,
      points: list(value.points, SCENE_ITEMS_MAX).map(number),
      ...(value.stroke === undefined ? {} : { stroke: text(value.stroke) }),
      width: number(value.width),
      dash: list(value.dash, SHAPE_PARTS_MAX).map((one) => Math.abs(number(one))),
      ...(value.fill === undefined ? {} : { fill: text(value.fill) }),
      alpha: value.alpha === undefined ? 1 : number(value.alpha),
      text: text(value.text),
    },
  ];
}

function mark(value: unknown): Mark {
  const [x, y, toX, toY, colour] = list(value, 5);
  return [number(x), number(y), number(toX), number(toY), text(colour)];
}

function shape(value: Record<string, unknown>): Shape {
  return {
    size: pair(value.size),
    round: value.round === true,
    wheels: objects(value.wheels, SHAPE_PARTS_MAX).map((wheel) => ({
      port: text(wheel.port),
      at: pair(wheel.at),
      radius: number(wheel.radius),
    })),
    sensors: objects(value.sensors, SHAPE_PARTS_MAX).map(sensor),
  };
}

/** One of a kind that is not known is there still, so that readings meet their sensors. */
function sensor(value: Record<string, unknown>): Sensor {
  return {
    is: oneOf(SENSORS, value.is) ?? 'camera',
    port: text(value.port),
    at: pair(value.at),
    degrees: number(value.degrees),
    reach: Math.max(0, number(value.reach)),
    beam: number(value.beam),
  };
}
