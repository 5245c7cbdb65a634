import { expect, it } from 'vitest';
import { request } from './wanted';

it('a request names nodes, and no path is more than a path', () => {
  expect(request(['camera/picture', 'a'])).toBe('stream:camera/picture,a;hz=10');
  expect(request(['a;hz=1', '*', 'a,b'])).toBe('');
  expect(request([])).toBe('');
  expect(request(Array.from({ length: 99 }, (_, at) => `n${at}`)).split(',').length).toBe(64);
});
