// The language of the page: that of the browser, Russian or English.

import { en, type Words } from './en';
import { ru } from './ru';

export const language: 'en' | 'ru' = navigator.language.toLowerCase().startsWith('ru') ? 'ru' : 'en';

export const words: Words = { en, ru }[language];
