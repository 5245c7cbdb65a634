// Why a person can do nothing from this page now.
//
// Owns which reason comes first. Knows no view.

import type { Robot } from '../robot/robot.svelte';
import { words } from '../words';

/** In a sentence; empty if something can be done. */
export function reasonOf(robot: Robot): string {
  if (robot.mayAct) return '';
  if (robot.past) return words.past.onlyLook;
  if (!robot.isConnected) return words.connecting;
  if (robot.absence) return words.robotAbsent(robot.absence);
  if (!robot.mayDrive) return words.onlyLook;
  return words.takeFirst(words.otherControl(robot.holder));
}
