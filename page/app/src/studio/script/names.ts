// Which files are programs with text.

export type ScriptLanguage = 'py' | 'js';

/** By the end of a name. */
export function languageOf(name: string): ScriptLanguage | undefined {
  if (name.endsWith('.py')) return 'py';
  return name.endsWith('.js') ? 'js' : undefined;
}

export const isScript = (name: string): boolean => languageOf(name) !== undefined;
