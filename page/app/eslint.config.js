// Rules of the page's code.
import svelte from 'eslint-plugin-svelte';
import globals from 'globals';
import ts from 'typescript-eslint';
import config from './svelte.config.js';

export default ts.config(
  { ignores: ['dist', 'node_modules'] },
  ...ts.configs.strict,
  ...svelte.configs.recommended,
  { languageOptions: { globals: { ...globals.browser, ...globals.node } } },
  {
    files: ['**/*.svelte', '**/*.svelte.ts'],
    languageOptions: {
      parserOptions: { parser: ts.parser, extraFileExtensions: ['.svelte'], svelteConfig: config },
    },
  },
  {
    rules: {
      '@typescript-eslint/switch-exhaustiveness-check': 'off',
      'svelte/no-at-html-tags': 'error',
      'no-console': ['error', { allow: ['info'] }],
      // What changes thousands of times in a second is no state of components: `tick` says that it has changed.
      'svelte/prefer-svelte-reactivity': 'off',
    },
  },
);
