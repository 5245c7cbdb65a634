/*
 * The converter battery_mean: README.md says how it is built and tested, trikfs_converter.h what it may rely on.
 *
 * The example to replace by your own: the battery of the TRIK controller behind its voltage divider. The low 10 bits of
 * a little-endian 16-bit word are the voltage, and 1023 stands for 13256 mV. The result is a little-endian 32-bit number
 * of millivolts: each output is the mean of `count` inputs, and the inputs in between give none.
 */
#include "trikfs_converter.h"

#include <stdlib.h>
#include <string.h>

enum { COUNT_DEFAULT = 4, COUNT_MAX = 1000 };

/* Fault codes of our own; explain turns them into texts. */
enum { BAD_COUNT = 2, BAD_SIZES = 3, NO_MEMORY = 4, BAD_WORD = 5 };

/* The state of one open file. */
struct battery_mean_state {
  uint32_t count; /* inputs for one output */
  uint32_t taken; /* inputs since the last output */
  uint32_t sum;   /* of their raw values: at most 1000 * 1023 */
};

static int battery_mean_open(const trikfs_open_info *info, void **state)
{
  double count = COUNT_DEFAULT;
  struct battery_mean_state *mean;
  uint32_t i;

  if (info->input_size != 2 || info->output_size != 4)
    return BAD_SIZES;
  for (i = 0; i < info->param_count; i++)
    if (strcmp(info->params[i].name, "count") == 0)
      count = info->params[i].value;
  if (!(count >= 1 && count <= COUNT_MAX)) /* written so that NaN is refused as well */
    return BAD_COUNT;

  mean = calloc(1, sizeof *mean);
  if (mean == NULL)
    return NO_MEMORY;
  mean->count = (uint32_t)count;
  *state = mean;
  return TRIKFS_OK;
}

static int battery_mean_convert(void *state, const uint8_t *in, uint32_t in_size, uint8_t *out, uint32_t out_size)
{
  struct battery_mean_state *mean = state;
  uint32_t raw = in[0] | (uint32_t)in[1] << 8;
  uint32_t millivolts;

  (void)in_size; /* the sizes are those of open */
  (void)out_size;
  if (raw == 0xffff) /* nothing answers on the bus: never invent a voltage */
    return BAD_WORD;
  mean->sum += raw & 1023u;
  mean->taken += 1;
  if (mean->taken < mean->count)
    return TRIKFS_CONSUMED;

  millivolts = (uint32_t)(((uint64_t)mean->sum * 13256u + 511u * mean->count) / (1023u * mean->count));
  mean->sum = 0;
  mean->taken = 0;
  out[0] = (uint8_t)millivolts;
  out[1] = (uint8_t)(millivolts >> 8);
  out[2] = (uint8_t)(millivolts >> 16);
  out[3] = (uint8_t)(millivolts >> 24);
  return TRIKFS_OK;
}

static void battery_mean_close(void *state)
{
  free(state);
}

static const char *battery_mean_explain(void *state, int code)
{
  (void)state; /* NULL after a refused open */
  switch (code) {
  case BAD_COUNT:
    return "battery_mean: count must be from 1 to 1000";
  case BAD_SIZES:
    return "battery_mean: it turns tuples of 2 bytes into tuples of 4";
  case NO_MEMORY:
    return "battery_mean: out of memory";
  case BAD_WORD:
    return "battery_mean: the converter chip does not answer";
  default:
    return NULL;
  }
}

static const trikfs_converter battery_mean_converter = {
  TRIKFS_ABI_VERSION,
  sizeof(trikfs_converter),
  "battery_mean",
  "voltage of the battery in millivolts, mean of `count` samples",
  2,
  4,
  battery_mean_open,
  battery_mean_convert,
  battery_mean_close,
  battery_mean_explain,
};

/* One line for each converter of the library. */
static const trikfs_converter *const converters[] = {
  &battery_mean_converter,
};

static const trikfs_library library = {
  TRIKFS_ABI_VERSION,
  sizeof(trikfs_library),
  sizeof converters / sizeof converters[0],
  converters,
};

TRIKFS_EXPORT const trikfs_library *trikfs_library_entry(void)
{
  return &library;
}
