// Where the page begins: that of a robot, or at other paths that of a class and that of marks, each loaded for itself alone.

import { mount } from 'svelte';
import './ui/page.css';
import App from './ui/App.svelte';
import { language } from './words';

document.documentElement.lang = language;
const target = document.getElementById('page');
if (target && location.pathname === '/class') {
  void import('./class/Class.svelte').then(({ default: Class }) => mount(Class, { target }));
} else if (target && location.pathname === '/marks') {
  void import('./marks/Marks.svelte').then(({ default: Marks }) => mount(Marks, { target }));
} else if (target) mount(App, { target });
