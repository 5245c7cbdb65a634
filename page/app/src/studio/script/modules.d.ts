// What the builder makes of files that are no modules.

declare module 'robot-script:*' {
  const script: (given: unknown) => unknown;
  export default script;
}
