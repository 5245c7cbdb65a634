// The ground around a robot of which nobody knows the world: where it says that it is, its way, and what its sensors see.
//
// Owns the picture that is made of nodes, live and of a moment of a recording. Which nodes these are is known to `mount`.

import type { Known } from '../robot/robot.svelte';
import type { Around } from './around';
import { numberIn, type Pose, poseOf, type Ranger, rangerOf } from './mount';
import { Trail } from './trail';
import type { Item, Place, Scene, WorldState } from './types';

/** Between two lines of the grid, in metres. */
export const GRID_M = 0.5;
/** Left, bottom, right and top of what is seen at first. */
const BOUNDS: Scene['bounds'] = [-1.5, -1, 1.5, 1];
/** The picture grows when the robot is so near to its edge. */
const EDGE_M = 0.3;
/** An encoder that has jumped says that the robot is far away: nothing that far is drawn. */
const FAR_M = 50;
const SIZE: [number, number] = [0.2, 0.17];

type Nodes = ReadonlyMap<string, Known>;

/** What is made of the nodes of a robot, as long as these are the same. */
interface Parts {
  key: string;
  pose: Pose;
  rangers: Ranger[];
}

/** Whether a robot with these nodes says where it is. */
export function saysWhere(nodes: Nodes): boolean {
  return [...nodes.values()].some(({ node }) => poseOf(node) !== undefined);
}

export class Ground implements Around {
  scene = $state.raw<Scene | undefined>(undefined);
  state: WorldState | undefined;
  readonly trail = new Trail();
  readonly isGround = true;
  #parts: Parts | undefined;
  #bounds = BOUNDS;
  /** Until when the way is known. */
  #until = -Infinity;
  #count = '';

  /** `nodes` and `now` may be others at each call. */
  constructor(
    private readonly nodes: () => Nodes,
    private readonly now: () => number,
  ) {}

  look(): void {
    const nodes = this.nodes();
    const parts = this.#found(nodes);
    if (!parts) return;
    this.#walk(nodes.get(parts.pose.path), parts.pose);
    const count = [parts.pose, ...parts.rangers].map(({ path }) => nodes.get(path)?.count ?? 0).join();
    if (count === this.#count && this.state) return;
    this.#count = count;
    this.state = stateOf(nodes, parts, this.state, this.now());
    this.#grow(this.state.robots[0]?.at ?? [0, 0, 0]);
  }

  #found(nodes: Nodes): Parts | undefined {
    const key = [...nodes]
      .map(([path, { node }]) => `${path} ${node.format} ${node.units} ${node.aliases.join(' ')}`)
      .join();
    if (key === this.#parts?.key) return this.#parts;
    const all = [...nodes.values()].map(({ node }) => node);
    const poses = all.map(poseOf).filter((pose) => pose !== undefined);
    const pose = poses.find(({ path }) => path === 'odometry') ?? poses[0];
    if (!pose) return undefined;
    const rangers = all.map(rangerOf).filter((ranger) => ranger !== undefined);
    this.#parts = { key, pose, rangers };
    this.#show();
    return this.#parts;
  }

  /** The way since the last look; from its beginning if that was a later moment. */
  #walk(known: Known | undefined, pose: Pose): void {
    const now = this.now();
    if (now < this.#until) {
      this.trail.clear();
      this.#until = -Infinity;
    }
    const since = this.#until;
    const [x, y] = [pose.x, pose.y].map(({ name, factor }) => {
      const samples = known?.histories.get(name)?.since(since);
      return { times: samples?.times ?? [], values: (samples?.values ?? []).map((one) => one * factor) };
    });
    x?.times.forEach((time, at) => {
      // The first one was there before.
      if (time <= since || time > now) return;
      this.#until = time;
      const place: [number, number] = [x.values[at] ?? NaN, y?.values[at] ?? NaN];
      if (isNear(place)) this.trail.step(0, ...place);
    });
  }

  #grow([x, y]: Place): void {
    const [left, bottom, right, top] = this.#bounds;
    const bounds: Scene['bounds'] = [
      Math.min(left, Math.floor(x - EDGE_M)),
      Math.min(bottom, Math.floor(y - EDGE_M)),
      Math.max(right, Math.ceil(x + EDGE_M)),
      Math.max(top, Math.ceil(y + EDGE_M)),
    ];
    if (bounds.every((one, at) => one === this.#bounds[at])) return;
    this.#bounds = bounds;
    this.#show();
  }

  #show(): void {
    this.scene = sceneOf(this.#bounds, this.#parts?.rangers ?? []);
  }
}

function isNear(place: readonly number[]): boolean {
  return place.every((one) => Math.abs(one) < FAR_M);
}

function sceneOf(bounds: Scene['bounds'], rangers: readonly Ranger[]): Scene {
  const [left, bottom, right, top] = bounds;
  const items: Item[] = [];
  const line = (isMain: boolean, points: number[]) =>
    items.push({ is: 'line', points, stroke: isMain ? '#b0bec5' : '#e3e8ea', width: 0 });
  for (let x = Math.ceil(left / GRID_M) * GRID_M; x <= right; x += GRID_M) line(x === 0, [x, bottom, x, top]);
  for (let y = Math.ceil(bottom / GRID_M) * GRID_M; y <= top; y += GRID_M) line(y === 0, [left, y, right, y]);
  const sensors = rangers.map(({ sensor }) => sensor);
  return {
    bounds,
    floor: '#ffffff',
    items,
    marks: [],
    things: [],
    start: [0, 0, 0],
    robots: [{ size: SIZE, round: false, wheels: [], sensors }],
    locked: { world: true, robot: true },
    fields: false,
    devices: [],
  };
}

function stateOf(nodes: Nodes, parts: Parts, before: WorldState | undefined, now: number): WorldState {
  const { pose, rangers } = parts;
  const sample = nodes.get(pose.path)?.fields;
  const at: Place = [numberIn(sample, pose.x), numberIn(sample, pose.y), numberIn(sample, pose.heading)];
  const isKnown = isNear(at.slice(0, 2)) && Number.isFinite(at[2]);
  const faults: Record<string, string> = {};
  const seen = rangers.map(({ path, sensor, numbers }) => {
    const known = nodes.get(path);
    if (known?.fault) faults[sensor.port] = known.fault;
    return numbers.map((number) => {
      const far = known?.fault ? NaN : numberIn(known?.fields, number);
      // What is not positive is no distance, and so is what is farther than the sensor looks.
      return far > 0 && far <= sensor.reach ? far : null;
    });
  });
  const lidar = seen.find((_, number) => rangers[number]?.sensor.is === 'lidar') ?? [];
  return {
    t: now,
    paused: false,
    speed: 1,
    robots: [
      {
        // A place that is lost is the last one.
        at: isKnown ? at : (before?.robots[0]?.at ?? [0, 0, 0]),
        read: seen.map((all) => (all.length === 1 ? (all[0] ?? null) : null)),
        // From clockwise to counter-clockwise; ahead stays.
        rays: lidar.map((_, number) => lidar[(lidar.length - number) % lidar.length] ?? null),
        stuck: false,
        marker: '',
      },
    ],
    things: [],
    led: '',
    said: '',
    faults,
  };
}
