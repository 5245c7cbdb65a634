/*
 * The shared library of the example configuration hello.lua: the plain form of a converter.
 * Each byte of the output is the last decimal digit of the input byte as a character, moved on by its position from 1.
 *
 * To build it by hand: cc -shared -fPIC -O2 -o libhello.so hello.c
 */

int converter(int in_s, char *in, int out_s, char *out);

int converter(int in_s, char *in, int out_s, char *out) {
  int i;
  if (in_s != out_s) {
    return 1;
  }
  for (i = 0; i < out_s; i++) {
    /* Through unsigned char: whether char has a sign depends on the processor, and Lua sees 0 to 255. */
    out[i] = (char)((unsigned char)in[i] % 10 + '0' + i + 1);
  }
  return 0;
}
