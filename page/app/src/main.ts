// Where the page begins.

import { mount } from 'svelte';
import './ui/page.css';
import App from './ui/App.svelte';
import { language } from './words';

document.documentElement.lang = language;
const target = document.getElementById('page');
if (target) mount(App, { target });
