/*
 * A plain converter, to copy: one function, no state, no header needed. Build it with one command:
 *
 *     cc -std=c99 -O2 -Wall -Wextra -fPIC -shared -o libplain.so plain.c
 *
 * and name it in a configuration (robot.lua beside this file does): converter = 'libplain.so'
 *
 * The battery of the TRIK controller behind its voltage divider: the low 10 bits of a little-endian 16-bit word are the
 * voltage, 1023 stands for 13256 mV. The result is a little-endian 32-bit number of millivolts.
 */

int converter(int in_s, char *in, int out_s, char *out);

int converter(int in_s, char *in, int out_s, char *out)
{
  const unsigned char *raw_bytes = (const unsigned char *)in;
  unsigned long raw, millivolts;

  if (in_s != 2 || out_s != 4)
    return 1; /* any value but 0 is a fault */

  raw = (raw_bytes[0] | (unsigned long)raw_bytes[1] << 8) & 1023u;
  millivolts = (raw * 13256u + 511u) / 1023u;

  out[0] = (char)(millivolts & 255u);
  out[1] = (char)(millivolts >> 8 & 255u);
  out[2] = (char)(millivolts >> 16 & 255u);
  out[3] = (char)(millivolts >> 24 & 255u);
  return 0;
}
