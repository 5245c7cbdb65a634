// What the compiler of components does: TypeScript in them is checked by svelte-check, not here.
import { vitePreprocess } from '@sveltejs/vite-plugin-svelte';

export default { preprocess: vitePreprocess(), compilerOptions: { runes: true } };
