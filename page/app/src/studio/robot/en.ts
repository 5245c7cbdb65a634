// What the studio says of a robot, in English.

export const en = {
  robot: (name: string) => `Robot ${name}`,
  connecting: 'The robot is not reached; it is tried again.',
  absent: (why: string) => `The robot takes no programs now: ${why}`,
  onlyLook:
    'This computer may only look: pair it with the robot, by Enter on the robot after a first attempt, or by its pairing code.',
  holder: (who: string) => `${who} is in control.`,
  take: 'Take control',
  send: 'Send and run',
  sendHint: 'The robot keeps the project under its name and runs it',
  stop: 'Stop',
  stopHint: 'Everything to rest, and the program to its end: the space bar too',
  pause: 'Pause',
  step: 'Step',
  goOn: 'Go on',
  live: 'Changes at once',
  liveHint: 'What you draw goes to the robot while the program runs',
  runs: (name: string) => `${name} runs.`,
  stopped: (name: string) => `${name} is stopped; motors rest.`,
  runsOther: (name: string) => `${name} runs, which is not what is open here.`,
  nothing: 'No program runs.',
  mistakes: 'The drawing has a mistake, so the robot goes on with the version before.',
  newest: 'The robot runs this version.',
  older: 'The robot runs an older version.',
  notSent: {
    name: 'The robot takes no program of this name: rename the project.',
    size: 'The project is too large for the robot.',
    offline: 'The robot is not reached.',
  },
  page: 'Its page',
  programs: 'Programs on the robot',
  open: (name: string) => `Open ${name}`,
  notOpened: (name: string, why: string) => `${name} is not opened: ${why}`,
  notDrawn: (name: string, why: string) => `${name} is not changed on the robot: ${why}`,

  elsewhere: 'To a robot',
  address: 'Address of the robot',
  code: 'Pairing code, if it wants one',
  go: 'Open there',
  goHint: 'The studio of the robot opens with this project; from there it is sent and run.',
  noAddress: 'An address is a name or numbers, as 192.168.77.1, with a port after a colon if it is not 8000.',
  tooLong: (kib: number) =>
    `The project is larger than ${kib} KiB: save it as a file, and open it in the studio of the robot.`,
};

export type Words = typeof en;
