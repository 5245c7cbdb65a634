/* Samples of a mounted tree out of shared memory: one header, no library, C99 and C++ with GCC or clang.
 * With -std=c99 or -std=c11 include it before all other headers.
 *
 *     struct trikfs_samples samples;
 *     if (trikfs_samples_open(&samples, "/trikfs", "sensors/A1") != 0) perror("sensors/A1");
 *     int32_t value; struct trikfs_event event;
 *     if (trikfs_samples_newest(&samples, &value, sizeof value, &event) == 0) printf("%d\n", value);
 *
 * Functions return 0, or -1 with a reason in errno. Reading makes no system call and waits for nobody.
 * docs/user/sample-bus.md explains the layout and the errors. */
#ifndef TRIKFS_SAMPLES_H
#define TRIKFS_SAMPLES_H

/* Compilers that were told to know nothing but the standard (-std=c99) hide POSIX, unless it is asked for before the
 * first header of the system. */
#if defined(__STRICT_ANSI__) && !defined(_GNU_SOURCE) && !defined(_DEFAULT_SOURCE)
#define _DEFAULT_SOURCE 1
#endif

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#if !defined(PATH_MAX) || !defined(O_CLOEXEC) || !defined(CLOCK_MONOTONIC)
#error "include trikfs_samples.h before all other headers, or compile with -D_DEFAULT_SOURCE"
#endif

/* The first bytes of a ring. All numbers have the byte order of the machine. */
struct trikfs_ring {
    char magic[8];         /* "TRIKSMP1" */
    uint32_t header_bytes; /* 64: where the slots begin */
    uint32_t slot_bytes;   /* distance between two slots */
    uint32_t slots;        /* a power of two; event N is in slot N & (slots - 1) */
    uint32_t tuple_bytes;  /* room for a tuple */
    uint32_t stale_ms;     /* a sample older than this is not the newest value; 0: never too old */
    uint32_t state;        /* 0: live; 1: the node is gone */
    uint32_t newest;       /* number of the newest event; 0: none yet */
    uint32_t reserved[7];
};

/* One event. It is whole if end, read before the rest, and begin, read after the rest, both are its number. */
struct trikfs_slot {
    uint32_t begin;
    uint32_t end;
    uint32_t size;    /* bytes of the tuple */
    int32_t error;    /* 0: a sample; else an errno, and no tuple */
    uint64_t time_ns; /* CLOCK_MONOTONIC */
    uint64_t reserved;
    /* then the tuple */
};

struct trikfs_event {
    uint32_t sequence; /* 1 for the first event of a ring; 0 is left out when it wraps */
    uint32_t size;
    int32_t error;
    uint64_t time_ns;
    const void *in_place; /* the tuple in shared memory; see trikfs_samples_is_whole */
};

struct trikfs_samples {
    const struct trikfs_ring *ring;
    size_t bytes;
    uint32_t slots, slot_bytes, tuple_bytes;
    uint32_t last; /* the last event that trikfs_samples_next gave */
    int value;     /* the node's value, open so that the node is sampled; -1: not open */
    dev_t device;
    ino_t file;
    char path[PATH_MAX];
};

static inline int trikfs_samples_fail(int error) {
    errno = error;
    return -1;
}

/* Appends a path as it is written in names of files: / is +, unusual bytes are % and two hexadecimal digits. */
static inline int trikfs_samples_append(char *to, size_t room, const char *path) {
    size_t at = strlen(to);
    for (; *path; path++) {
        unsigned char byte = (unsigned char)*path;
        int plain = (byte >= 'a' && byte <= 'z') || (byte >= 'A' && byte <= 'Z') ||
                    (byte >= '0' && byte <= '9') || byte == '.' || byte == '_' || byte == '-';
        if (at + 4 > room) return trikfs_samples_fail(ENAMETOOLONG);
        if (plain || byte == '/') {
            to[at++] = byte == '/' ? '+' : (char)byte;
        } else {
            snprintf(to + at, 4, "%%%02X", (unsigned)byte);
            at += 3;
        }
        to[at] = 0;
    }
    return 0;
}

static inline int trikfs_samples_close(struct trikfs_samples *samples) {
    if (samples->value >= 0) close(samples->value);
    samples->value = -1;
    return munmap((void *)(uintptr_t)samples->ring, samples->bytes);
}

/* Opens a ring by the path of its file. Nothing tells the daemon that somebody needs the samples. */
static inline int trikfs_samples_open_file(struct trikfs_samples *samples, const char *path) {
    struct trikfs_ring ring;
    struct stat found;
    memset(samples, 0, sizeof *samples);
    samples->value = -1;
    if (strlen(path) >= sizeof samples->path) return trikfs_samples_fail(ENAMETOOLONG);
    strcpy(samples->path, path);
    int file = open(path, O_RDONLY | O_CLOEXEC);
    if (file < 0) return -1;
    ssize_t got = read(file, &ring, sizeof ring);
    if (got < 0 || fstat(file, &found) != 0) {
        close(file);
        return -1;
    }
    uint64_t bytes = (uint64_t)ring.slots * ring.slot_bytes + sizeof ring;
    if (got != sizeof ring || memcmp(ring.magic, "TRIKSMP1", 8) != 0 || ring.header_bytes != sizeof ring ||
        ring.slots == 0 || (ring.slots & (ring.slots - 1)) != 0 || ring.slots > 65536 ||
        ring.slot_bytes % 8 != 0 || ring.tuple_bytes > 64u << 20 ||
        ring.slot_bytes < sizeof(struct trikfs_slot) + ring.tuple_bytes || bytes > (uint64_t)found.st_size) {
        close(file);
        return trikfs_samples_fail(EPROTO);
    }
    void *map = mmap(NULL, (size_t)bytes, PROT_READ, MAP_SHARED, file, 0);
    close(file);
    if (map == MAP_FAILED) return -1;
    samples->ring = (const struct trikfs_ring *)map;
    samples->bytes = (size_t)bytes;
    samples->slots = ring.slots;
    samples->slot_bytes = ring.slot_bytes;
    samples->tuple_bytes = ring.tuple_bytes;
    samples->device = found.st_dev;
    samples->file = found.st_ino;
    return 0;
}

/* Opens the file of a node that says that its samples are needed; an attribute is a file itself. -1: the tree does not
 * answer, so it samples nothing. */
static inline int trikfs_samples_value(const char *mountpoint, const char *node) {
    char path[2 * PATH_MAX + 8];
    snprintf(path, sizeof path, "%s/%s/value", mountpoint, node);
    int value = open(path, O_RDONLY | O_CLOEXEC);
    if (value >= 0) return value;
    snprintf(path, sizeof path, "%s/%s", mountpoint, node);
    return open(path, O_RDONLY | O_CLOEXEC);
}

/* Opens the ring of a node of a mounted tree. ENOENT: the node is not sampled in the background, or the tree has no
 * sample bus. EACCES: the tree is another user's, or somebody else has put something into its place. */
static inline int trikfs_samples_open(struct trikfs_samples *samples, const char *mountpoint, const char *node) {
    char real[PATH_MAX], path[PATH_MAX] = "/dev/shm/trikfs";
    struct stat tree, directory;
    if (realpath(mountpoint, real) == NULL || stat(real, &tree) != 0) return -1;
    if (trikfs_samples_append(path, sizeof path - 2, real) != 0 || lstat(path, &directory) != 0) return -1;
    if (!S_ISDIR(directory.st_mode) || directory.st_uid != tree.st_uid) return trikfs_samples_fail(EACCES);
    strcat(path, "/");
    if (trikfs_samples_append(path, sizeof path, node) != 0) return -1;
    /* First, so that what the ring has is new. */
    int value = trikfs_samples_value(real, node);
    if (trikfs_samples_open_file(samples, path) != 0) {
        int why = errno;
        if (value >= 0) close(value);
        return trikfs_samples_fail(why);
    }
    samples->value = value;
    return 0;
}

static inline const struct trikfs_slot *trikfs_samples_slot(const struct trikfs_samples *samples, uint32_t sequence) {
    size_t at = sizeof(struct trikfs_ring) + (size_t)(sequence & (samples->slots - 1)) * samples->slot_bytes;
    return (const struct trikfs_slot *)((const char *)samples->ring + at);
}

/* Whether an event is still whole: what was read of it in place is good if this holds afterwards. */
static inline int trikfs_samples_is_whole(const struct trikfs_samples *samples, const struct trikfs_event *event) {
    __atomic_thread_fence(__ATOMIC_ACQUIRE);
    return __atomic_load_n(&trikfs_samples_slot(samples, event->sequence)->begin, __ATOMIC_RELAXED) == event->sequence;
}

/* Finds one event; its bytes are event->in_place. ENOENT: it is not there yet, or no longer. */
static inline int trikfs_samples_find(const struct trikfs_samples *samples, uint32_t sequence,
                                      struct trikfs_event *event) {
    const struct trikfs_slot *slot = trikfs_samples_slot(samples, sequence);
    uint32_t end = __atomic_load_n(&slot->end, __ATOMIC_RELAXED);
    __atomic_thread_fence(__ATOMIC_ACQUIRE);
    if (end != sequence || sequence == 0) return trikfs_samples_fail(ENOENT);
    event->sequence = sequence;
    event->size = slot->size < samples->tuple_bytes ? slot->size : samples->tuple_bytes;
    event->error = slot->error;
    event->time_ns = slot->time_ns;
    event->in_place = slot + 1;
    return trikfs_samples_is_whole(samples, event) ? 0 : trikfs_samples_fail(ENOENT);
}

/* Copies one event's tuple, at most room bytes of it. */
static inline int trikfs_samples_get(const struct trikfs_samples *samples, uint32_t sequence, void *tuple, size_t room,
                                     struct trikfs_event *event) {
    if (trikfs_samples_find(samples, sequence, event) != 0) return -1;
    memcpy(tuple, event->in_place, event->size < room ? event->size : room);
    return trikfs_samples_is_whole(samples, event) ? 0 : trikfs_samples_fail(ENOENT);
}

/* The newest value. EAGAIN: there is none yet. ETIMEDOUT: it is too old. ESTALE: the node is gone, open again.
 * Any other: the sample could not be taken. */
static inline int trikfs_samples_newest(const struct trikfs_samples *samples, void *tuple, size_t room,
                                        struct trikfs_event *event) {
    if (__atomic_load_n(&samples->ring->state, __ATOMIC_RELAXED) != 0) return trikfs_samples_fail(ESTALE);
    int attempt = 0;
    for (; attempt < 8; attempt++) {
        uint32_t newest = __atomic_load_n(&samples->ring->newest, __ATOMIC_ACQUIRE);
        if (newest != 0 && trikfs_samples_get(samples, newest, tuple, room, event) == 0) break;
    }
    if (attempt == 8) return trikfs_samples_fail(EAGAIN);
    if (event->error != 0) return trikfs_samples_fail(event->error);
    uint32_t stale_ms = __atomic_load_n(&samples->ring->stale_ms, __ATOMIC_RELAXED);
    if (stale_ms != 0) {
        struct timespec now;
        clock_gettime(CLOCK_MONOTONIC, &now);
        uint64_t now_ns = (uint64_t)now.tv_sec * 1000000000u + (uint64_t)now.tv_nsec;
        if (now_ns > event->time_ns && now_ns - event->time_ns > (uint64_t)stale_ms * 1000000u)
            return trikfs_samples_fail(ETIMEDOUT);
    }
    return 0;
}

/* The event after the last one, at first the oldest that is kept; adds to *missed what was overwritten before it was
 * read. EAGAIN: nothing yet. An event with event->error is a failure, in its place among the samples. */
static inline int trikfs_samples_next(struct trikfs_samples *samples, void *tuple, size_t room,
                                      struct trikfs_event *event, uint32_t *missed) {
    uint32_t newest = __atomic_load_n(&samples->ring->newest, __ATOMIC_ACQUIRE);
    uint32_t kept = samples->slots > 1 ? samples->slots - 1 : 1;
    uint32_t next = samples->last + 1 ? samples->last + 1 : 1;
    if (newest == 0 || newest == samples->last) return trikfs_samples_fail(EAGAIN);
    if (newest - next >= kept) {
        uint32_t oldest = newest - (kept - 1) ? newest - (kept - 1) : 1;
        if (samples->last != 0) *missed += oldest - next;
        samples->last = oldest - 1;
        next = oldest;
    }
    if (trikfs_samples_get(samples, next, tuple, room, event) != 0) return trikfs_samples_fail(EAGAIN);
    samples->last = next;
    return 0;
}

/* Whether this is still the node's ring. It makes a system call: ask when nothing has come for a while. */
static inline int trikfs_samples_is_current(const struct trikfs_samples *samples) {
    struct stat found;
    return __atomic_load_n(&samples->ring->state, __ATOMIC_RELAXED) == 0 && stat(samples->path, &found) == 0 &&
           found.st_dev == samples->device && found.st_ino == samples->file;
}

#endif
