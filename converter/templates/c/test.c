/*
 * Tests of battery_mean without trikfs: ./test_battery_mean vectors.txt [SEED]
 *
 * The vectors of the file, and what must be true of every converter whatever bytes it gets. The library is asked like
 * trikfs asks it, through trikfs_library_entry. Change SIZES, PARAMS and check_output when you change the converter.
 */
#include "trikfs_converter.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { INPUT_SIZE = 2, OUTPUT_SIZE = 4, TUPLES = 100000, GUARD = 64, LINE_MAX_BYTES = 4096 };

static const trikfs_param params[] = { { "count", 2 } };

static const trikfs_converter *tested;
static unsigned long seed;

static void fail(const char *where, unsigned long number, const char *what)
{
  fprintf(stderr, "FAILED: %s %lu: %s (seed %lu)\n", where, number, what, seed);
  exit(1);
}

static void print_log(void *host, const char *text)
{
  (void)host;
  printf("%s\n", text);
}

static void *open_one(void)
{
  trikfs_open_info info;
  void *state = NULL;

  memset(&info, 0, sizeof info);
  info.size = sizeof info;
  info.direction = TRIKFS_READ;
  info.input_size = INPUT_SIZE;
  info.output_size = OUTPUT_SIZE;
  info.param_count = sizeof params / sizeof params[0];
  info.params = params;
  info.node = "test";
  info.log = print_log;
  if (tested->open != NULL && tested->open(&info, &state) != TRIKFS_OK)
    fail("open", 0, "refused");
  return state;
}

static void close_one(void *state)
{
  if (tested->open != NULL && tested->close != NULL && state != NULL)
    tested->close(state);
}

/* One call, as trikfs makes it: into zeros, with nothing allowed to change around them. */
static int convert(void *state, const uint8_t *in, uint8_t *out, unsigned long number)
{
  uint8_t guarded[GUARD + OUTPUT_SIZE + GUARD];
  int code, i;

  memset(guarded, 0xa5, sizeof guarded);
  memset(guarded + GUARD, 0, OUTPUT_SIZE);
  code = tested->convert(state, in, INPUT_SIZE, guarded + GUARD, OUTPUT_SIZE);
  for (i = 0; i < GUARD; i++)
    if (guarded[i] != 0xa5 || guarded[GUARD + OUTPUT_SIZE + i] != 0xa5)
      fail("tuple", number, "wrote outside its output");
  memcpy(out, guarded + GUARD, OUTPUT_SIZE);
  return code;
}

/* What must be true of every output. For floats: that they are finite. Here: a voltage that the divider can measure. */
static void check_output(const uint8_t *out, unsigned long number)
{
  uint32_t millivolts = out[0] | (uint32_t)out[1] << 8 | (uint32_t)out[2] << 16 | (uint32_t)out[3] << 24;

  if (millivolts > 13256)
    fail("tuple", number, "more than the greatest voltage");
}

/* Reads `size` bytes in hexadecimal. */
static int parse_hex(const char *text, uint8_t *bytes, int size)
{
  unsigned byte;
  int i;

  for (i = 0; i < size; i++) {
    if (strspn(text + 2 * i, "0123456789abcdefABCDEF") < 2 || sscanf(text + 2 * i, "%2x", &byte) != 1)
      return 0;
    bytes[i] = (uint8_t)byte;
  }
  return 1;
}

static void test_vectors(const char *name)
{
  char line[LINE_MAX_BYTES], in_text[LINE_MAX_BYTES], out_text[LINE_MAX_BYTES];
  uint8_t in[INPUT_SIZE], out[OUTPUT_SIZE], expected[OUTPUT_SIZE];
  unsigned long number = 0, tried = 0;
  void *state = open_one();
  FILE *file = fopen(name, "r");
  int code, good;

  if (file == NULL)
    fail(name, 0, "cannot be opened");
  while (fgets(line, sizeof line, file) != NULL) {
    number++;
    if (line[0] == '#' || sscanf(line, "%s > %s", in_text, out_text) != 2)
      continue;
    if (!parse_hex(in_text, in, INPUT_SIZE))
      fail("line", number, "the input is not hexadecimal, or too short");
    code = convert(state, in, out, number);
    if (strcmp(out_text, "consumed") == 0)
      good = code == TRIKFS_CONSUMED;
    else if (strcmp(out_text, "fault") == 0)
      good = code != TRIKFS_OK && code != TRIKFS_CONSUMED;
    else if (parse_hex(out_text, expected, OUTPUT_SIZE))
      good = code == TRIKFS_OK && memcmp(out, expected, OUTPUT_SIZE) == 0;
    else
      good = 0;
    if (!good)
      fail("line", number, "gives something else");
    tried++;
  }
  fclose(file);
  close_one(state);
  if (tried == 0)
    fail(name, 0, "has no vectors");
  printf("%lu vectors hold\n", tried);
}

/* Marsaglia's xorshift: the same bytes for the same seed everywhere. */
static uint32_t next_random(uint32_t *random)
{
  *random ^= *random << 13;
  *random ^= *random >> 17;
  *random ^= *random << 5;
  return *random;
}

/* Random bytes; now and then zeros, which devices send before they are ready, or ones, as a bus without a device. */
static void random_tuple(uint32_t *random, uint8_t *in)
{
  uint32_t kind = next_random(random) >> 8 & 15;
  int i;

  for (i = 0; i < INPUT_SIZE; i++)
    in[i] = kind == 0 ? 0 : kind == 1 ? 0xff : (uint8_t)(next_random(random) >> 8);
}

static void test_random(void)
{
  static uint8_t kept[TUPLES][OUTPUT_SIZE];
  static int codes[TUPLES];
  uint8_t in[INPUT_SIZE], out[OUTPUT_SIZE];
  uint32_t start = (uint32_t)seed | 1, random = start, other = ~start | 1;
  unsigned long i, refused = 0;
  void *state = open_one(), *again, *beside;

  for (i = 0; i < TUPLES; i++) {
    random_tuple(&random, in);
    codes[i] = convert(state, in, kept[i], i);
    if (codes[i] == TRIKFS_OK)
      check_output(kept[i], i);
    else if (codes[i] != TRIKFS_CONSUMED)
      refused++;
  }
  close_one(state);

  /* Opened again, with another one beside it: the same comes out, so no state is shared or left over. */
  again = open_one();
  beside = open_one();
  random = start;
  for (i = 0; i < TUPLES; i++) {
    random_tuple(&other, in);
    convert(beside, in, out, i);
    random_tuple(&random, in);
    if (convert(again, in, out, i) != codes[i])
      fail("tuple", i, "another code after opening again");
    if (codes[i] == TRIKFS_OK && memcmp(out, kept[i], OUTPUT_SIZE) != 0)
      fail("tuple", i, "another output after opening again");
  }
  close_one(again);
  close_one(beside);
  if (refused == TUPLES)
    fail("tuple", refused, "all were refused, so nothing was tried");
  printf("%d random tuples, %lu of them refused: good (seed %lu)\n", (int)TUPLES, refused, seed);
}

int main(int count, char **words)
{
  const trikfs_library *library = trikfs_library_entry();

  seed = count > 2 ? strtoul(words[2], NULL, 10) : (unsigned long)time(NULL);
  tested = library->converters[0];
  test_vectors(count > 1 ? words[1] : "vectors.txt");
  test_random();
  return 0;
}
