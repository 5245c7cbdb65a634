// What moves, drawn at each picture: things, ways, beams and robots.
//
// Owns how they look. The context takes metres; `scale` is how many of its pixels are one.

import { MARKER_WIDTH } from './brush';
import type { Trail, Stroke } from './trail';
import type { Place, Scene, Sensor, Shape, Movable, WorldState } from './types';

/** Colours of the robots and their ways. They stand on the floor of the world, which no scheme of the page changes. */
const INKS = ['#c2185b', '#1565c0', '#2e7d32', '#6a1b9a'];
const BODY = '#eceff1';
const WHEEL = '#37474f';
const EDGE = '#37474f';
const BEAM = '#0277bd';
const RAY = '#00838f';
const BROKEN = '#d50000';

const RADIANS = Math.PI / 180;

type Context = CanvasRenderingContext2D;

/** Everything that moves, the lowest first. */
export function drawMoving(
  context: Context,
  scene: Scene,
  state: WorldState,
  trail: Trail | undefined,
  scale: number,
): void {
  const thin = 1.5 / scale;
  if (trail) {
    for (const mark of trail.marks) drawWay(context, mark, mark.colour, MARKER_WIDTH);
    trail.ways.forEach((way, number) => {
      drawWay(context, way, INKS[number % INKS.length] ?? BEAM, Math.max(thin, 0.004));
    });
  }
  drawStart(context, scene, thin);
  scene.things.forEach((thing, number) => {
    const at = state.things[number];
    if (at) drawThing(context, thing, at, thin);
  });
  state.robots.forEach((robot, number) => {
    const shape = scene.robots[number];
    if (!shape) return;
    const [x, y, degrees] = robot.at;
    context.save();
    context.translate(x, y);
    context.rotate(degrees * RADIANS);
    drawRays(context, shape, robot.rays, thin);
    shape.sensors.forEach((sensor, index) => drawBeam(context, sensor, robot.read[index], thin));
    drawBody(context, shape, INKS[number % INKS.length] ?? BEAM, robot.stuck, thin);
    shape.sensors.forEach((sensor, index) => {
      drawSensor(context, sensor, robot.read[index], sensor.port in state.faults, thin);
    });
    if (number === 0) drawLed(context, shape, state.led);
    context.restore();
  });
}

function drawWay(context: Context, { points }: Stroke, colour: string, width: number): void {
  if (points.length < 4) return;
  context.beginPath();
  let isDown = false;
  for (let index = 0; index + 1 < points.length; index += 2) {
    const x = points[index] ?? NaN;
    const y = points[index + 1] ?? NaN;
    if (Number.isNaN(x)) isDown = false;
    else if (isDown) context.lineTo(x, y);
    else {
      context.moveTo(x, y);
      isDown = true;
    }
  }
  context.strokeStyle = colour;
  context.lineWidth = width;
  context.stroke();
}

/** A cross where the robot begins. */
function drawStart(context: Context, { start: [x, y, degrees] }: Scene, thin: number): void {
  context.save();
  context.translate(x, y);
  context.rotate(degrees * RADIANS);
  context.beginPath();
  context.moveTo(-0.03, 0);
  context.lineTo(0.05, 0);
  context.moveTo(0, -0.03);
  context.lineTo(0, 0.03);
  context.strokeStyle = '#78909c';
  context.lineWidth = thin;
  context.stroke();
  context.restore();
}

function drawThing(context: Context, thing: Movable, [x, y, degrees]: Place, thin: number): void {
  const half = thing.size / 2;
  context.beginPath();
  if (thing.is === 'cube') {
    const angle = degrees * RADIANS;
    for (let corner = 0; corner < 4; corner++) {
      const at = angle + ((2 * corner + 1) * Math.PI) / 4;
      context.lineTo(x + half * Math.SQRT2 * Math.cos(at), y + half * Math.SQRT2 * Math.sin(at));
    }
    context.closePath();
  } else {
    context.arc(x, y, half, 0, 2 * Math.PI);
  }
  context.fillStyle = thing.colour;
  context.fill();
  context.strokeStyle = EDGE;
  context.lineWidth = thin;
  context.stroke();
}

/** What a lidar sees: a short stroke where each ray ends. */
function drawRays(context: Context, shape: Shape, rays: (number | null)[], thin: number): void {
  const lidar = shape.sensors.find((sensor) => sensor.is === 'lidar');
  if (!lidar || rays.length === 0) return;
  context.beginPath();
  rays.forEach((far, index) => {
    if (far === null) return;
    const angle = (lidar.degrees + (index * 360) / rays.length) * RADIANS;
    const [x, y] = [lidar.at[0] + far * Math.cos(angle), lidar.at[1] + far * Math.sin(angle)];
    context.moveTo(x + 2 * thin, y);
    context.arc(x, y, 2 * thin, 0, 2 * Math.PI);
  });
  context.fillStyle = RAY;
  context.globalAlpha = 0.65;
  context.fill();
  context.globalAlpha = 1;
}

function drawBeam(context: Context, sensor: Sensor, reading: number | null | undefined, thin: number): void {
  if (sensor.reach === 0 || sensor.is === 'lidar') return;
  const far = reading ?? sensor.reach;
  const angle = sensor.degrees * RADIANS;
  const half = (Math.max(sensor.beam, 1) / 2) * RADIANS;
  const [x, y] = sensor.at;
  context.beginPath();
  context.moveTo(x, y);
  context.arc(x, y, far, angle - half, angle + half);
  context.closePath();
  context.fillStyle = BEAM;
  context.globalAlpha = reading == null ? 0.07 : 0.16;
  context.fill();
  context.globalAlpha = reading == null ? 0.25 : 0.8;
  context.beginPath();
  context.arc(x, y, far, angle - half, angle + half);
  context.strokeStyle = BEAM;
  context.lineWidth = thin;
  context.stroke();
  context.globalAlpha = 1;
}

function drawBody(context: Context, shape: Shape, ink: string, isStuck: boolean, thin: number): void {
  const [length, width] = shape.size;
  context.beginPath();
  if (shape.round) context.arc(0, 0, length / 2, 0, 2 * Math.PI);
  else context.roundRect(-length / 2, -width / 2, length, width, 0.02);
  context.fillStyle = BODY;
  context.fill();
  context.strokeStyle = isStuck ? BROKEN : ink;
  context.lineWidth = Math.max(2 * thin, 0.006);
  context.stroke();
  context.fillStyle = WHEEL;
  for (const { at, radius } of shape.wheels) {
    context.fillRect(at[0] - radius, at[1] - 0.012, 2 * radius, 0.024);
  }
  context.beginPath();
  context.moveTo(0.1 * length, -0.18 * width);
  context.lineTo(0.4 * length, 0);
  context.lineTo(0.1 * length, 0.18 * width);
  context.closePath();
  context.fillStyle = ink;
  context.fill();
}

/** Colours of sensors; what one that measures no distance sees is how it is filled. */
function drawSensor(
  context: Context,
  sensor: Sensor,
  reading: number | null | undefined,
  isBroken: boolean,
  thin: number,
): void {
  const [x, y] = sensor.at;
  context.beginPath();
  context.arc(x, y, sensor.is === 'lidar' ? 0.02 : 0.011, 0, 2 * Math.PI);
  context.fillStyle = filling(sensor, reading ?? 0);
  context.fill();
  context.strokeStyle = isBroken ? BROKEN : EDGE;
  context.lineWidth = isBroken ? 2 * thin : thin;
  context.stroke();
  if (!isBroken) return;
  context.beginPath();
  context.moveTo(x - 0.018, y - 0.018);
  context.lineTo(x + 0.018, y + 0.018);
  context.moveTo(x - 0.018, y + 0.018);
  context.lineTo(x + 0.018, y - 0.018);
  context.stroke();
}

function filling(sensor: Sensor, reading: number): string {
  switch (sensor.is) {
    case 'light': {
      const grey = Math.round(255 * (1 - Math.min(1, Math.max(0, reading))));
      return `rgb(${grey} ${grey} ${grey})`;
    }
    case 'touch':
      return reading > 0 ? '#ffb300' : '#ffffff';
    case 'camera':
      return '#4527a0';
    case 'lidar':
      return RAY;
    case 'infrared':
    case 'sonar':
      return BEAM;
    default:
      return sensor.is satisfies never;
  }
}

const LIGHTS = { '': '#b0bec5', green: '#00c853', red: '#ff1744', orange: '#ff9100' };

function drawLed(context: Context, shape: Shape, led: WorldState['led']): void {
  context.beginPath();
  context.arc(-0.3 * shape.size[0], 0, 0.01, 0, 2 * Math.PI);
  context.fillStyle = LIGHTS[led];
  context.fill();
}
