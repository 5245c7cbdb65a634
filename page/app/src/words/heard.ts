// Sentences of the robot in the language of the page.
//
// Owns how a sentence is known by its pattern, where `{why}` is any text. Which sentences these are stands with the words of the
// language; what is not among them stays as it is.

import type { Heard } from './en';

interface Known {
  pattern: RegExp;
  names: string[];
  translation: string;
}

/** Letters of a sentence that are looked at. */
const LETTERS_MAX = 600;
/** Sentences within sentences: what was said about a program says why. */
const DEPTH_MAX = 3;

const NAME = /\{(\w+)\}/g;
/** What stands for a sentence, which is translated too. */
const WHY = 'why';

function known([english, translation]: Heard): Known {
  const names = [...english.matchAll(NAME)].map(([, name]) => name ?? '');
  const parts = english.split(/\{\w+\}/).map((part) => part.replace(/[.*+?^${}()|[\]\\]/g, '\\$&'));
  return { pattern: new RegExp(`^${parts.join('(.+?)')}$`, 's'), names, translation };
}

/** A translator for these sentences. */
export function translator(all: readonly Heard[]): (text: string) => string {
  const patterns = all.map(known);
  const translate = (text: string, depth: number): string => {
    if (text.length > LETTERS_MAX || depth > DEPTH_MAX) return text;
    for (const { pattern, names, translation } of patterns) {
      const found = pattern.exec(text);
      if (!found) continue;
      return translation.replace(NAME, (_, name: string) => {
        const value = found[1 + names.indexOf(name)] ?? '';
        return name === WHY ? translate(value, depth + 1) : value;
      });
    }
    return text;
  };
  return (text) => translate(text, 0);
}
