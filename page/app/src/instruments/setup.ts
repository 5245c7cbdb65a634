// What pads and buttons move: which actuators, and how much.
//
// Owns its text in the store of the browser; what is wrong in it is left out.

import { STORED_NAME_LENGTH_MAX } from '../limits';
import type { Node } from '../robot/recording';
import { fieldsOf, isNumber } from './format';

export interface Button {
  path: string;
  /** In the unit of the actuator. */
  value: number;
}

/** An empty path moves nothing. */
export interface Setup {
  left: string;
  right: string;
  leftTurned: boolean;
  rightTurned: boolean;
  /** What the second pad moves. */
  x: string;
  y: string;
  buttons: Button[];
  /** How much of the full power is the most. */
  power_percent: number;
}

export const BUTTONS = 4;
const VERSION = 1;

/** What a pad may move: one number that has a rest. */
export function isMovable(node: Node): boolean {
  const fields = fieldsOf(node.format);
  return node.isWritten && node.rest !== '' && fields.length === 1 && fields.every(isNumber);
}

/** A first guess: the motors whose names say left and right, else the first two. */
export function guessed(nodes: readonly Node[]): Setup {
  const movable = nodes.filter(isMovable);
  const motors = movable.filter((node) => node.path.startsWith('motors/'));
  const byName = (name: string) =>
    movable.find((node) => [node.path, ...node.aliases].some((path) => path.endsWith(`/${name}`)));
  const left = byName('left') ?? motors[0];
  const right = byName('right') ?? motors.find((node) => node !== left);
  return {
    left: left?.path ?? '',
    right: right?.path ?? '',
    leftTurned: false,
    rightTurned: false,
    x: '',
    y: '',
    buttons: Array.from({ length: BUTTONS }, () => ({ path: '', value: 0 })),
    power_percent: 60,
  };
}

function path(value: unknown, otherwise: string): string {
  return typeof value === 'string' && value.length <= STORED_NAME_LENGTH_MAX ? value : otherwise;
}

function button(value: unknown): Button {
  const { path: at, value: much } = (value ?? {}) as Record<string, unknown>;
  const isValue = typeof much === 'number' && Number.isFinite(much);
  return { path: path(at, ''), value: isValue ? much : 0 };
}

/** A setup of a text; what is not in it is as guessed. */
export function read(text: string | null, otherwise: Setup): Setup {
  let value: unknown;
  try {
    value = JSON.parse(text ?? '');
  } catch {
    return otherwise;
  }
  if (typeof value !== 'object' || value === null) return otherwise;
  const all = value as Record<string, unknown>;
  if (all.version !== VERSION) return otherwise;
  const buttons = Array.isArray(all.buttons) ? all.buttons : [];
  const power = all.power_percent;
  return {
    left: path(all.left, otherwise.left),
    right: path(all.right, otherwise.right),
    leftTurned: all.leftTurned === true,
    rightTurned: all.rightTurned === true,
    x: path(all.x, ''),
    y: path(all.y, ''),
    buttons: Array.from({ length: BUTTONS }, (_, at) => button(buttons[at])),
    power_percent:
      typeof power === 'number' && power >= 10 && power <= 100 ? Math.round(power) : otherwise.power_percent,
  };
}

export function text(setup: Setup): string {
  return JSON.stringify({ version: VERSION, ...setup });
}
