// A list of things to paint, made of the scene: paths in metres with their colours, so that it is made once for each scene.
//
// Owns how each kind of item becomes a path. Knows the canvas only as something that takes paths.

import type { Item, Mark, Scene } from './types';

/** A path that can be painted. */
export interface Painted {
  is: 'path';
  path: Path2D;
  stroke: string | undefined;
  width: number;
  dash: number[];
  fill: string | undefined;
  alpha: number;
}

/** A text whose height does not change with the scale. */
export interface Caption {
  is: 'caption';
  x: number;
  y: number;
  text: string;
}

/** A picture in its place, once it is there. */
export interface Picture {
  is: 'picture';
  address: string;
  left: number;
  top: number;
  width: number;
  height: number;
}

export type Step = Painted | Caption | Picture;

/** Thinnest line that is seen, in pixels. */
const THIN = 1.2;

/** What stands still, the lowest first. Walls of one look are one path: there may be thousands. */
export function steps(scene: Scene): Step[] {
  const all: Step[] = [];
  for (const item of scene.items) {
    const step = stepOf(item);
    if (!step) continue;
    const before = all[all.length - 1];
    if (item.is === 'wall' && step.is === 'path' && before?.is === 'path' && isAlike(before, step)) {
      before.path.addPath(step.path);
    } else {
      all.push(step);
    }
  }
  all.push(...marked(scene.marks));
  return all;
}

function isAlike(one: Painted, other: Painted): boolean {
  return one.stroke === other.stroke && one.width === other.width && !one.fill && one.dash.length === 0;
}

/** A number of a list; 0 if it is not there. */
function at(points: number[], index: number): number {
  return points[index] ?? 0;
}

function stepOf(item: Item): Step | undefined {
  const p = item.points;
  const [left, right] = [Math.min(at(p, 0), at(p, 2)), Math.max(at(p, 0), at(p, 2))];
  const [bottom, top] = [Math.min(at(p, 1), at(p, 3)), Math.max(at(p, 1), at(p, 3))];
  const path = new Path2D();
  switch (item.is) {
    case 'text':
      return { is: 'caption', x: at(p, 0), y: at(p, 1), text: item.text ?? '' };
    case 'image': {
      const address = item.text ?? '';
      // Only what is in the scene itself is shown.
      if (!address.startsWith('data:image/')) return undefined;
      return { is: 'picture', address, left, top, width: right - left, height: top - bottom };
    }
    case 'rect':
      path.rect(left, bottom, right - left, top - bottom);
      break;
    case 'ellipse':
      path.ellipse(
        (left + right) / 2,
        (bottom + top) / 2,
        (right - left) / 2,
        (top - bottom) / 2,
        0,
        0,
        2 * Math.PI,
      );
      break;
    case 'curve':
      path.moveTo(at(p, 0), at(p, 1));
      path.bezierCurveTo(at(p, 2), at(p, 3), at(p, 4), at(p, 5), at(p, 6), at(p, 7));
      break;
    case 'strokes':
      for (let index = 0; index + 3 < p.length; index += 4) {
        path.moveTo(at(p, index), at(p, index + 1));
        path.lineTo(at(p, index + 2), at(p, index + 3));
      }
      break;
    case 'line':
    case 'wall':
      for (let index = 0; index + 1 < p.length; index += 2) {
        path.lineTo(at(p, index), at(p, index + 1));
      }
      break;
    default:
      item.is satisfies never;
      return undefined;
  }
  return {
    is: 'path',
    path,
    stroke: item.stroke,
    width: item.width ?? 0,
    dash: item.dash ?? [],
    fill: item.fill,
    alpha: item.alpha ?? 1,
  };
}

/** Marks of one colour are one path. */
function marked(marks: Mark[]): Painted[] {
  const paths = new Map<string, Path2D>();
  for (const [x, y, toX, toY, colour] of marks) {
    let path = paths.get(colour);
    if (!path) paths.set(colour, (path = new Path2D()));
    path.moveTo(x, y);
    path.lineTo(toX, toY);
  }
  return [...paths].map(([stroke, path]) => ({
    is: 'path',
    path,
    stroke,
    width: MARKER_WIDTH,
    dash: [],
    fill: undefined,
    alpha: 1,
  }));
}

/** Across the line that a marker leaves, in metres: six pixels of TRIK Studio. */
export const MARKER_WIDTH = 0.021;

/** Paints a path in a context that takes metres; `scale` is how many of its pixels are one. */
export function paint(context: CanvasRenderingContext2D, step: Painted, scale: number): void {
  if (step.fill) {
    context.globalAlpha = step.alpha;
    context.fillStyle = step.fill;
    context.fill(step.path);
    context.globalAlpha = 1;
  }
  if (step.stroke) {
    context.strokeStyle = step.stroke;
    context.lineWidth = Math.max(step.width, THIN / scale);
    context.setLineDash(step.dash);
    context.stroke(step.path);
    context.setLineDash([]);
  }
}
