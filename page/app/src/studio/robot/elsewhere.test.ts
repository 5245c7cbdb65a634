import { expect, test } from 'vitest';
import { studioAt } from './elsewhere';

test.each([
  ['192.168.77.1', 'http://192.168.77.1:8000/studio/'],
  [' trik-abc.local:8080 ', 'http://trik-abc.local:8080/studio/'],
  ['http://127.0.0.1:8000/', 'http://127.0.0.1:8000/studio/'],
  ['[fe80::1]', 'http://[fe80::1]:8000/studio/'],
])('%s is an address', (text, address) => {
  expect(studioAt(text)).toBe(address);
});

test.each([
  '',
  'a b',
  'https://robot',
  'javascript:alert(1)',
  'robot/../x',
  'robot@evil',
  'robot:0',
  'robot:65536',
  '999.1.1.1',
  '[zz]',
])('%s is none', (text) => {
  expect(studioAt(text)).toBeUndefined();
});
