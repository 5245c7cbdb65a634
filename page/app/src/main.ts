// Where the page begins: that of a robot, or at another path that of a class, which is loaded for it alone.

import { mount } from 'svelte';
import './ui/page.css';
import App from './ui/App.svelte';
import { language } from './words';

document.documentElement.lang = language;
const target = document.getElementById('page');
if (target && location.pathname === '/class') {
  void import('./class/Class.svelte').then(({ default: Class }) => mount(Class, { target }));
} else if (target) mount(App, { target });
