/*
 * trikfs_converter.h - the contract between trikfs and converters in shared libraries.
 *
 * A converter turns one tuple of bytes into another: what a device sends into what a program wants to read, or what a
 * program writes into what a device takes. Include this file, export one of the two forms below, build a shared
 * library and name it in the configuration. `trikfs new-converter --lang c NAME` writes a whole project.
 *
 * Valid C99 and C++. It needs no other header of this project and no library to link with.
 *
 * THE TWO FORMS
 *
 *   Plain:      int converter(int in_s, char *in, int out_s, char *out);
 *               One function, no state, no parameters. For a fixed formula nothing more is needed.
 *
 *   Versioned:  const trikfs_library *trikfs_library_entry(void);
 *               Any number of converters by name, a state for each open file, parameters, texts for faults.
 *
 * A library that exports both is read as versioned.
 *
 * THREADS
 *
 *   Each open file and direction has a state of its own. With one state there is never more than one call at a time,
 *   but successive calls may come from different threads. Calls with different states may happen at the same time, so
 *   global and static variables must be constant or protected; the same holds for every variable of a plain converter.
 *   A converter may start no thread that outlives its close.
 *
 * POINTERS
 *
 *   A pointer that the host passes is valid during that call only, and what it points to belongs to the host; copy what
 *   must be kept. The same the other way: a text that explain returns must stay valid until the next call with the same
 *   state. Descriptors (trikfs_library and everything it points to) must be constant and stay valid as long as the
 *   library is loaded, which is until the process ends: libraries are never unloaded.
 *   Only the state pointer survives a call. The host never looks behind it.
 *   Host and converter may therefore live in different processes.
 *
 * TIME
 *
 *   Calls happen on the way of somebody's read or write. Never wait in convert: no sleep, no lock held for long, no
 *   device. A converter that hangs or crashes takes the filesystem with it, unless its node says isolate = true: native
 *   code is trusted code.
 *   No C++ exception and no longjmp may leave a function of the converter.
 *
 * TEXTS are UTF-8, end with a zero byte, lower case, without a full stop. At most 1024 bytes are used, the rest is cut.
 */
#ifndef TRIKFS_CONVERTER_H
#define TRIKFS_CONVERTER_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Stands before every exported function. */
#if defined(__GNUC__)
#define TRIKFS_EXPORT __attribute__((visibility("default")))
#else
#define TRIKFS_EXPORT
#endif

/*
 * The version that this header describes. It changes only when an old library can no longer be used; new members are
 * added at the end of a struct, and `size` says how many a library or a host knows.
 */
#define TRIKFS_ABI_VERSION 1u

/* What open and convert return. Every other value is a fault, whose text explain knows. */
enum {
  TRIKFS_OK = 0,      /* done; from convert: the output tuple is complete */
  TRIKFS_CONSUMED = 1 /* from convert only: the input was taken, there is no output yet */
};

/* What trikfs_open_info.direction holds. */
enum {
  TRIKFS_READ = 0, /* from the device to the program */
  TRIKFS_WRITE = 1 /* from the program to the device */
};

/* One number from the `params` table of the node. */
typedef struct trikfs_param {
  const char *name; /* at most 64 bytes */
  double value;     /* any number, NaN and the infinities included: check it */
} trikfs_param;

/* What a converter is told at open. Valid during that call, with everything it points to. */
typedef struct trikfs_open_info {
  uint32_t size;              /* sizeof of this struct as the host knows it; never less than it is here */
  uint32_t direction;         /* TRIKFS_READ or TRIKFS_WRITE */
  uint32_t input_size;        /* bytes of every input tuple of this open file, 1 to 65536 */
  uint32_t output_size;       /* bytes of every output tuple, 1 to 65536 */
  uint32_t param_count;       /* at most 1024 */
  const trikfs_param *params; /* in no particular order; NULL when there are none */
  const char *node;           /* path of the node in the tree, for messages */
  void *host;                 /* first argument of log */
  void (*log)(void *host, const char *text); /* writes a line to the log of the filesystem; only during open; never NULL */
} trikfs_open_info;

/* One converter. */
typedef struct trikfs_converter {
  uint32_t abi_version;    /* TRIKFS_ABI_VERSION */
  uint32_t size;           /* sizeof(trikfs_converter) */
  const char *name;        /* 1 to 64 bytes of a-z 0-9 _ ; unlike every other name of the library */
  const char *description; /* one sentence; may be NULL */
  uint32_t input_size;     /* bytes of the input tuple it insists on, at most 65536; 0 = any, open decides */
  uint32_t output_size;    /* likewise for the output tuple */

  /*
   * Makes the state of one open file and stores it in *state, which is NULL before the call.
   * Returns TRIKFS_OK, or anything else to refuse: sizes or parameters that make no sense are refused here, so that
   * the mistake is reported when the file is opened and not as a strange value later.
   * After a refusal the host still calls explain, and then close if *state is not NULL: a state that holds nothing
   * but the text of the refusal is allowed.
   * May be NULL when there is no state: the state stays NULL.
   */
  int (*open)(const trikfs_open_info *info, void **state);

  /*
   * Turns one tuple into another. in_size and out_size are those of open, always.
   * `out` is zeroed by the host; `in` and `out` never overlap and have no particular alignment.
   * Returns TRIKFS_OK, TRIKFS_CONSUMED, or a fault: the tuple is lost and its reader gets an error, the next call is
   * made as usual. What was written to `out` counts after TRIKFS_OK only.
   * Never NULL.
   */
  int (*convert)(void *state, const uint8_t *in, uint32_t in_size, uint8_t *out, uint32_t out_size);

  /*
   * Frees the state. Called once with whatever open left in *state, unless that is NULL; nothing is called with it
   * afterwards. May be NULL.
   */
  void (*close)(void *state);

  /*
   * The reason behind `code`, which open or convert has just returned for this state (NULL if open left none).
   * The text belongs to the converter. May return NULL, may be NULL.
   */
  const char *(*explain)(void *state, int code);
} trikfs_converter;

/* What the library holds. */
typedef struct trikfs_library {
  uint32_t abi_version;                      /* TRIKFS_ABI_VERSION */
  uint32_t size;                             /* sizeof(trikfs_library) */
  uint32_t count;                            /* how many converters, 1 to 256 */
  const trikfs_converter *const *converters; /* that many pointers, none of them NULL */
} trikfs_library;

/*
 * The versioned entry. Called when the library has been loaded, possibly more than once and from any thread; it does
 * nothing but return the address of a constant. Define it in the library, with these very words in front.
 */
TRIKFS_EXPORT const trikfs_library *trikfs_library_entry(void);

/*
 * The plain form, instead of the entry. Sizes are those of the configuration. Returns 0 for success; any other value is
 * a fault. It may scribble over `in`, which is a copy. `char` may be signed: convert to unsigned char before computing.
 */
TRIKFS_EXPORT int converter(int in_s, char *in, int out_s, char *out);

#ifdef __cplusplus
}
#endif

#endif
