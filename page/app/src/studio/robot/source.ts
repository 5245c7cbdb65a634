// What can be sent to a robot: the drawing, or a program with text that is open above it.
//
// Owns what both have in common. How it is sent is known to the robot.

import type { Script } from '../script/script.svelte';
import type { Studio } from '../studio.svelte';

export interface Source {
  /** The name that it has on the robot. */
  name: string;
  /** Another one for another program. */
  program: string;
  /** Another one for another version. */
  version: unknown;
  /** The robot could not run it. */
  hasMistakes: boolean;
  /** It is drawn: it can be held, and changed while it runs. */
  isDrawn: boolean;
  bytes(): Promise<Uint8Array | undefined>;
}

/** What is looked at. */
export function sourceOf(studio: Studio, script: Script): Source {
  if (script.isOpen) {
    return {
      name: script.name,
      program: `text ${script.opened}`,
      version: script.text,
      hasMistakes: false,
      isDrawn: false,
      bytes: () => Promise.resolve(script.bytes()),
    };
  }
  return {
    name: studio.name,
    program: `drawing ${studio.opened}`,
    version: studio.looks,
    hasMistakes: studio.looks.findings.some(({ level }) => level === 'error'),
    isDrawn: true,
    bytes: () => studio.bytes(),
  };
}
