// Nodes of a real robot that say where it is and how far something is away.
//
// Owns which nodes these are, and where a sensor looks, which a tree does not know: names say it. Knows no drawing.

import { type Field, fieldsOf, isNumber, unitsOf } from '../instruments/format';
import { leaf } from '../instruments/groups';
import type { Fields, Node } from '../robot/recording';
import type { Sensor } from './types';

/** Metres in one of a unit of length. */
export const UNITS_OF_LENGTH: ReadonlyMap<string, number> = new Map([
  ['mm', 1e-3],
  ['cm', 1e-2],
  ['m', 1],
]);
/** Degrees in one of a unit of angle. */
const DEGREES = new Map([
  ['deg', 1],
  ['rad', 180 / Math.PI],
]);
/** Distances that are a scan; fewer are so many sensors. The recorder has the same rule. */
export const SCAN_NUMBERS_MIN = 8;
/** How far sensors look, which a tree does not know either: those that are shipped. */
const SONAR_M = 4;
const INFRARED_M = 1;
const LIDAR_M = 8;
/** From the middle of the body, whose size nobody knows, to a sensor. */
const EDGE_M = 0.09;

/** A number of a node, in another unit. */
interface Scaled {
  name: string;
  factor: number;
}

/** A node that says where the robot is. */
export interface Pose {
  path: string;
  x: Scaled;
  y: Scaled;
  heading: Scaled;
}

/** A node that says how far something is away: one number, or one for each direction, clockwise from ahead. */
export interface Ranger {
  path: string;
  sensor: Sensor;
  numbers: Scaled[];
}

interface Measured extends Field {
  unit: string;
}

function measured(node: Node): Measured[] {
  const fields = fieldsOf(node.format);
  const units = unitsOf(node.units, fields.length);
  return fields.map((field, at) => ({ ...field, unit: units[at] ?? '' }));
}

function scaled(field: Measured | undefined, units: ReadonlyMap<string, number>): Scaled | undefined {
  const factor = units.get(field?.unit ?? '');
  return field && factor !== undefined && isNumber(field) ? { name: field.name, factor } : undefined;
}

/**
 * The place and heading that a node gives; undefined if it gives none. Units are `mm, deg`; without any, those of the node that the
 * controller's own configuration has. The recorder has the same rule for `Odometry`.
 */
export function poseOf(node: Node): Pose | undefined {
  const fields = measured(node);
  const [x, y, heading] = fields;
  const isPlace = fields.length === 3 && x?.name === 'x' && y?.name === 'y';
  if (!isPlace || !heading || !['heading', 'theta'].includes(heading.name)) return undefined;
  const isOurs = node.path === 'odometry' && heading.name === 'heading' && node.units === '';
  const units = (isOurs ? 'mm, deg' : node.units).split(',').map((unit) => unit.trim());
  if (units.slice(0, -1).some((unit) => unit !== units[0])) return undefined;
  const of = (field: Measured, unit: string | undefined, all: ReadonlyMap<string, number>) =>
    scaled({ ...field, unit: unit ?? '' }, all);
  const pose = {
    x: of(x, units[0], UNITS_OF_LENGTH),
    y: of(y, units[0], UNITS_OF_LENGTH),
    heading: of(heading, units.at(-1), DEGREES),
  };
  return pose.x && pose.y && pose.heading
    ? { path: node.path, x: pose.x, y: pose.y, heading: pose.heading }
    : undefined;
}

/** The distances that a node gives; undefined if it gives none. */
export function rangerOf(node: Node): Ranger | undefined {
  const fields = measured(node);
  const scan = fields.filter(({ name }, at) => name === `d${at}`);
  if (scan.length >= SCAN_NUMBERS_MIN && scan.length === fields.length) {
    const numbers = scan.map((field) => scaled(field, UNITS_OF_LENGTH)).filter((one) => one !== undefined);
    if (numbers.length !== scan.length) return undefined;
    return { path: node.path, numbers, sensor: mounted(node, 'lidar', LIDAR_M, 0) };
  }
  const [field, ...others] = fields;
  const number = scaled(field, UNITS_OF_LENGTH);
  if (!field || !number || others.length > 0 || !['distance', 'range'].includes(field.name)) return undefined;
  const isInfrared = namesOf(node).some((name) => /infrared|sharp/.test(name));
  const sensor = isInfrared ? mounted(node, 'infrared', INFRARED_M, 4) : mounted(node, 'sonar', SONAR_M, 20);
  return { path: node.path, numbers: [number], sensor };
}

function namesOf(node: Node): string[] {
  return [node.path, ...node.aliases].map((path) => leaf(path).toLowerCase());
}

function mounted(node: Node, is: Sensor['is'], reach: number, beam: number): Sensor {
  const degrees = is === 'lidar' ? 0 : directionOf(namesOf(node));
  const radians = (degrees * Math.PI) / 180;
  const edge = is === 'lidar' ? 0 : EDGE_M;
  const at: [number, number] = [edge * Math.cos(radians), edge * Math.sin(radians)];
  return { is, port: leaf(node.path), at, degrees, reach, beam };
}

/** Where a sensor of these names looks, counter-clockwise from ahead; ahead if none of them says it. */
export function directionOf(names: readonly string[]): number {
  for (const name of names) {
    const words = new Set(name.split(/[^a-z]+/));
    const isBack = words.has('back') || words.has('rear') || words.has('behind');
    const isAhead = words.has('front') || words.has('ahead');
    const side = Number(words.has('left')) - Number(words.has('right'));
    if (isBack) return side === 0 ? 180 : side * 135;
    if (isAhead) return side * 45;
    if (side !== 0) return side * 90;
  }
  return 0;
}

/** A number of a sample in metres or degrees; NaN without one. */
export function numberIn(fields: Fields | undefined, { name, factor }: Scaled): number {
  const value = fields?.[name];
  return typeof value === 'number' || typeof value === 'bigint' ? Number(value) * factor : NaN;
}
