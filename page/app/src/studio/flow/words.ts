// What the studio says of programs of data flow, in the language of the browser.

import { language } from '../../words';
import { en, type Words } from './en';
import { ru } from './ru';

export const words: Words = { en, ru }[language];
