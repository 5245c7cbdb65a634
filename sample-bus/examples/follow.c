/* Prints every event of a node, with a note where some were missed: follow MOUNTPOINT NODE [COUNT].
 * cc -o follow -I sample-bus/include sample-bus/examples/follow.c */
#include "trikfs_samples.h"

int main(int words, char **word) {
    static unsigned char tuple[4 << 20];
    struct trikfs_samples samples;
    struct trikfs_event event;
    if (words < 3) {
        fprintf(stderr, "usage: follow MOUNTPOINT NODE [COUNT]\n");
        return 2;
    }
    long left = words > 3 ? atol(word[3]) : LONG_MAX;
    if (trikfs_samples_open(&samples, word[1], word[2]) != 0) {
        perror(word[2]);
        return 1;
    }
    uint32_t missed = 0;
    int idle_ms = 0;
    struct timespec pause = {0, 1000000};
    while (left > 0) {
        if (trikfs_samples_next(&samples, tuple, sizeof tuple, &event, &missed) != 0) {
            /* Nothing yet. Once in a while, look whether the node is still there. */
            if (++idle_ms % 100 == 0 && !trikfs_samples_is_current(&samples)) {
                fprintf(stderr, "%s: gone\n", word[2]);
                return 3;
            }
            nanosleep(&pause, NULL);
            continue;
        }
        idle_ms = 0;
        left--;
        if (missed > 0) printf("missed %u\n", (unsigned)missed);
        missed = 0;
        printf("%u %llu ", (unsigned)event.sequence, (unsigned long long)event.time_ns);
        if (event.error != 0) {
            printf("error %s\n", strerror(event.error));
        } else {
            for (uint32_t at = 0; at < event.size && at < 16; at++) printf("%02x", tuple[at]);
            printf("\n");
        }
        fflush(stdout);
    }
    return trikfs_samples_close(&samples) == 0 ? 0 : 1;
}
