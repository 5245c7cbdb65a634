// A small world for tests.

import type { Scene, WorldState } from './types';

export function scene(): Scene {
  return {
    bounds: [0, 0, 3, 2],
    floor: '#ffffff',
    items: [
      { is: 'line', points: [0, 0, 1, 0, 1, 1], stroke: '#000000', width: 0.03 },
      { is: 'wall', points: [0, 0, 3, 0], stroke: '#789', width: 0.01 },
      { is: 'wall', points: [3, 0, 3, 2], stroke: '#789', width: 0.01 },
    ],
    marks: [
      [0, 0, 1, 1, '#ff0000'],
      [1, 1, 2, 1, '#ff0000'],
    ],
    things: [{ is: 'ball', size: 0.07, colour: '#f00' }],
    start: [0.5, 0.5, 0],
    robots: [
      {
        size: [0.22, 0.22],
        round: true,
        wheels: [],
        sensors: [
          { is: 'sonar', port: 'D1', at: [0.11, 0], degrees: 0, reach: 4, beam: 20 },
          { is: 'light', port: 'A5', at: [0.09, 0], degrees: 0, reach: 0, beam: 0 },
          { is: 'sonar', port: 'D2', at: [0, 0.11], degrees: 90, reach: 4, beam: 20 },
        ],
      },
    ],
    locked: { world: false, robot: false },
    fields: true,
    devices: [],
  };
}

export function state(): WorldState {
  return {
    t: 1,
    paused: false,
    speed: 1,
    robots: [{ at: [1, 1, 370], read: [0.5, 0.2, null], rays: [], stuck: false, marker: '' }],
    things: [[2, 1, 0]],
    led: '',
    said: '',
    faults: {},
  };
}
