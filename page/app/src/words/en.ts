// What the page says, in English. `ru.ts` has the same in Russian; a text that is missing there does not compile.

export const en = {
  title: (robot: string) => (robot ? `${robot} - TRIK` : 'TRIK'),
  stop: 'Stop',
  stopHint: 'Everything to rest, the program to its end (space bar)',
  connecting: 'The page is not connected; it tries again.',
  robotAbsent: (why: string) => `The robot is not reached: ${why}`,
  world: 'World',
  instruments: 'Instruments',
  program: 'Program',
  diagram: 'Diagram',
  log: 'Log',
  inControl: 'You are in control',
  otherControl: (who: string) => `${who} is in control`,
  nobodyControl: 'Nobody is in control',
  takeControl: 'Take control',
  leaveControl: 'Leave control',
  onlyLook: 'This computer may only look',
  dismiss: 'Dismiss',
};

export type Words = typeof en;
