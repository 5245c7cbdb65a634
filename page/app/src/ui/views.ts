// The views of the page: a new one is a row here.

import type { Component } from 'svelte';
import Configuration from '../configuration/Configuration.svelte';
import Diagram from '../diagram/Diagram.svelte';
import Instruments from '../instruments/Instruments.svelte';
import Log from '../log/Log.svelte';
import Program from '../program/Program.svelte';
import type { Past } from '../past/past.svelte';
import type { Robot } from '../robot/robot.svelte';
import { words } from '../words';
import World from '../world/World.svelte';

export interface View {
  /** In the address of the page, after `#`; what comes after a colon there is for the view. */
  name: string;
  title: string;
  component: Component<{ robot: Robot; argument: string }>;
  /** Whether this robot has anything to show in it. */
  isThere(robot: Robot): boolean;
  /** It can show a moment of a recording, and then nothing in it reaches the robot. */
  hasPast?: (past: Past) => boolean;
}

const always = () => true;

export const views: View[] = [
  {
    name: 'world',
    title: words.world,
    component: World,
    isThere: (robot) => robot.hasWorld || robot.around !== undefined,
    hasPast: ({ around }) => around !== undefined,
  },
  {
    name: 'instruments',
    title: words.instruments,
    component: Instruments,
    isThere: () => true,
    hasPast: always,
  },
  { name: 'program', title: words.program, component: Program, isThere: () => true, hasPast: always },
  { name: 'diagram', title: words.diagram, component: Diagram, isThere: () => true, hasPast: always },
  { name: 'configuration', title: words.configuration, component: Configuration, isThere: () => true },
  { name: 'log', title: words.log, component: Log, isThere: () => true, hasPast: always },
];
