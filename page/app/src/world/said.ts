// The world in words, for people who do not see the picture.
//
// Owns which facts are told. The words are those of `words`.

import { words } from '../words';
import { within } from './hold';
import type { Scene, WorldState } from './types';

/** Where the robot is, what its distance sensors see, and how time runs. */
export function said(scene: Scene, state: WorldState): string {
  const robot = state.robots[0];
  const shape = scene.robots[0];
  if (!robot || !shape) return '';
  const [x, y, degrees] = robot.at;
  const parts = [words.worldPose(x.toFixed(2), y.toFixed(2), Math.round(within(degrees)))];
  if (robot.stuck) parts.push(words.worldStuck);
  shape.sensors.forEach((sensor, index) => {
    const far = robot.read[index];
    if (sensor.reach > 0 && sensor.is !== 'lidar') {
      parts.push(words.worldDistance(sensor.port, far == null ? null : Math.round(far * 100)));
    }
  });
  if (state.paused) parts.push(words.worldPaused);
  return parts.join(' ');
}
