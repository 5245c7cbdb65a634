// The views of the page: a new one is a row here.

import type { Component } from 'svelte';
import Instruments from '../instruments/Instruments.svelte';
import type { Robot } from '../robot/robot.svelte';
import { words } from '../words';
import World from '../world/World.svelte';

export interface View {
  /** In the address of the page, after `#`. */
  name: string;
  title: string;
  component: Component<{ robot: Robot }>;
  /** Whether this robot has anything to show in it. */
  isThere(robot: Robot): boolean;
}

export const views: View[] = [
  { name: 'world', title: words.world, component: World, isThere: (robot) => robot.hasWorld },
  { name: 'instruments', title: words.instruments, component: Instruments, isThere: () => true },
];
