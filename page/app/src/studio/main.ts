// Where the studio begins: a page of its own, which needs no server.

import { mount } from 'svelte';
import '../ui/page.css';
import { language } from '../words';
import StudioPage from './StudioPage.svelte';

document.documentElement.lang = language;
const target = document.getElementById('page');
if (target) mount(StudioPage, { target });

// Where the browser allows none, the page needs its server each time.
if ('serviceWorker' in navigator) void navigator.serviceWorker.register('./sw.js').catch(() => undefined);
