// What a lidar sees, as a picture from above: ahead is up, and each distance is a point.
//
// Owns which nodes are one, what is said of it, and its drawing. The recorder has the same rule for `LaserScan`.

import { SCAN_NUMBERS_MIN, UNITS_OF_LENGTH } from '../world/mount';
import { numberText } from './numbers';
import { numberOf, type Reading } from './reading';

/** Distances once around, clockwise from ahead. */
export interface Scan {
  unit: string;
  /** NaN: nothing came back. */
  far: number[];
}

/** The nearest thing. */
export interface Nearest {
  far: number;
  /** Clockwise from ahead, from -180 to 180. */
  degrees: number;
}

/** Rings of the picture at most. */
const RINGS = 4;
/** Pixels around the outermost ring, where its label is. */
const EDGE = 12;

/** The scan of a node; undefined if it is none. */
export function scanOf(all: readonly Reading[]): Scan | undefined {
  const unit = all[0]?.unit ?? '';
  const isScan =
    all.length >= SCAN_NUMBERS_MIN &&
    UNITS_OF_LENGTH.has(unit) &&
    all.every(
      ({ field, unit: other, isNumber }, at) => field.name === `d${at}` && other === unit && isNumber,
    );
  if (!isScan) return undefined;
  // A distance that is not positive is none.
  return { unit, far: all.map(numberOf).map((far) => (far > 0 && Number.isFinite(far) ? far : NaN)) };
}

/** The nearest thing; undefined if nothing is seen. */
export function nearestOf({ far }: Scan): Nearest | undefined {
  let best: Nearest | undefined;
  far.forEach((one, at) => {
    if (Number.isNaN(one) || (best && best.far <= one)) return;
    const degrees = (at * 360) / far.length;
    best = { far: one, degrees: degrees > 180 ? degrees - 360 : degrees };
  });
  return best;
}

/** In how many directions something is seen. */
export function seenOf({ far }: Scan): number {
  return far.filter((one) => !Number.isNaN(one)).length;
}

/** Distances of rings for a greatest distance: 1, 2 or 5 with zeros, the last one not below it. */
export function ringsOf(greatest: number): number[] {
  if (!(greatest > 0) || !Number.isFinite(greatest)) return [1];
  for (let power = Math.floor(Math.log10(greatest)) - 1; ; power++) {
    for (const step of [1, 2, 5]) {
      const ring = step * 10 ** power;
      const count = Math.ceil(greatest / ring - 1e-9);
      if (count <= RINGS) return Array.from({ length: Math.max(1, count) }, (_, at) => (at + 1) * ring);
    }
  }
}

/** Colours of the picture. */
export interface Inks {
  point: string;
  ring: string;
  label: string;
  /** Around labels, so that points do not run through them. */
  paper: string;
}

/** Draws it onto a square of so many pixels. */
export function drawScan(pen: CanvasRenderingContext2D, size: number, scan: Scan, inks: Inks): void {
  const middle = size / 2;
  const rings = ringsOf(scan.far.reduce((one, far) => (far > one ? far : one), 0));
  const scale = (middle - EDGE) / (rings.at(-1) ?? 1);
  pen.clearRect(0, 0, size, size);
  pen.lineWidth = 1;
  pen.strokeStyle = inks.ring;
  pen.fillStyle = inks.label;
  pen.font = '11px sans-serif';
  pen.textAlign = 'center';
  for (const ring of rings) {
    pen.beginPath();
    pen.arc(middle, middle, ring * scale, 0, 2 * Math.PI);
    pen.stroke();
  }
  pen.beginPath();
  for (const [x, y] of [
    [1, 0],
    [0, 1],
  ] as const) {
    pen.moveTo(middle - x * (middle - EDGE), middle - y * (middle - EDGE));
    pen.lineTo(middle + x * (middle - EDGE), middle + y * (middle - EDGE));
  }
  pen.stroke();
  pen.fillStyle = inks.point;
  scan.far.forEach((far, at) => {
    if (Number.isNaN(far)) return;
    const angle = (at * 2 * Math.PI) / scan.far.length;
    const [x, y] = [middle + far * scale * Math.sin(angle), middle - far * scale * Math.cos(angle)];
    pen.fillRect(x - 1.25, y - 1.25, 2.5, 2.5);
  });
  // The robot looks up.
  pen.beginPath();
  pen.moveTo(middle, middle - 7);
  pen.lineTo(middle + 5, middle + 5);
  pen.lineTo(middle - 5, middle + 5);
  pen.closePath();
  pen.fill();
  pen.fillStyle = inks.label;
  pen.strokeStyle = inks.paper;
  pen.lineWidth = 4;
  for (const ring of rings) {
    const label: [string, number, number] = [
      `${numberText(ring)} ${scan.unit}`,
      middle,
      middle + ring * scale - 3,
    ];
    pen.strokeText(...label);
    pen.fillText(...label);
  }
}
