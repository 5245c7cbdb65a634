// The language of the page: that of the browser, Russian or English.

import { en, type Words } from './en';
import { translator } from './heard';
import { ru } from './ru';

// Tests of single files have no browser.
const spoken = typeof navigator === 'undefined' ? 'en' : navigator.language;

export const language: 'en' | 'ru' = spoken.toLowerCase().startsWith('ru') ? 'ru' : 'en';

export const words: Words = { en, ru }[language];

/** A sentence of the robot as the person reads it. */
export const heard = translator(words.heard);
