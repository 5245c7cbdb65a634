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

test('a pairing code goes along, and only as what it is', () => {
  expect(studioAt('robot', ' 482 913 ')).toBe('http://robot:8000/studio/?code=482913');
  expect(studioAt('robot', '1&x=#2')).toBe('http://robot:8000/studio/?code=1%26x%3D%232');
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
