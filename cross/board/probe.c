/* What the shell of the emulated board cannot do: poll, hold files open, count, press a key, keep a pace. Each command prints one line and exits with 0, or says on standard error what went wrong and exits with 1. */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <linux/uinput.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/random.h>
#include <time.h>
#include <unistd.h>

static int fail(const char *what)
{
	perror(what);
	return 1;
}

static double now_ns(void)
{
	struct timespec at;

	clock_gettime(CLOCK_MONOTONIC, &at);
	return at.tv_sec * 1e9 + at.tv_nsec;
}

/* poll FILE MS: nothing to read at first, then something within the time. */
static int wait_for(const char *path, int ms)
{
	struct pollfd watched = { .fd = open(path, O_RDONLY | O_NONBLOCK), .events = POLLIN };
	char byte[64];

	if (watched.fd < 0)
		return fail(path);
	if (poll(&watched, 1, 0) != 0) {
		fprintf(stderr, "%s: ready before anything came\n", path);
		return 1;
	}
	printf("waiting\n");
	fflush(stdout);
	if (poll(&watched, 1, ms) != 1 || !(watched.revents & POLLIN)) {
		fprintf(stderr, "%s: nothing within %d ms\n", path, ms);
		return 1;
	}
	ssize_t got = read(watched.fd, byte, sizeof byte);
	if (got < 0)
		return fail(path);
	printf("woke with %zd bytes, the first is %d\n", got, byte[0]);
	return 0;
}

/* reads FILE COUNT SIZE: nanoseconds for one read, the least of ten rounds. */
static int time_reads(const char *path, int count, size_t size)
{
	char bytes[4096];
	double best = 1e18;
	int file = open(path, O_RDONLY);

	if (file < 0)
		return fail(path);
	for (int round = 0; round < 10; round++) {
		double start = now_ns();

		for (int i = 0; i < count; i++)
			if (pread(file, bytes, size, 0) != (ssize_t)size)
				return fail("pread");
		double each = (now_ns() - start) / count;
		if (each < best)
			best = each;
	}
	printf("%.0f\n", best);
	return 0;
}

/* hold FILE COUNT: opens it so often, reads each 100 times, says so and waits for the end of standard input. */
static int hold(const char *path, int count)
{
	char bytes[4];

	for (int i = 0; i < count; i++) {
		int file = open(path, O_RDONLY);

		if (file < 0)
			return fail(path);
		for (int turn = 0; turn < 100; turn++)
			if (pread(file, bytes, sizeof bytes, 0) != sizeof bytes)
				return fail("pread");
	}
	printf("holding %d\n", count);
	fflush(stdout);
	return read(0, bytes, 1) < 0;
}

static int emit(int file, int type, int code, int value)
{
	struct input_event event = { .type = type, .code = code, .value = value };

	return write(file, &event, sizeof event) == sizeof event ? 0 : fail("uinput");
}

/* An input device with ENTER. */
static int make_keyboard(void)
{
	struct uinput_setup setup = { .id = { .bustype = BUS_VIRTUAL }, .name = "board keys" };
	int file = open("/dev/uinput", O_WRONLY);

	if (file < 0) {
		perror("/dev/uinput");
		return -1;
	}
	if (ioctl(file, UI_SET_EVBIT, EV_KEY) || ioctl(file, UI_SET_KEYBIT, KEY_ENTER) ||
	    ioctl(file, UI_DEV_SETUP, &setup) || ioctl(file, UI_DEV_CREATE)) {
		perror("uinput");
		return -1;
	}
	printf("made\n");
	fflush(stdout);
	return file;
}

/* keyboard: presses and releases its key at each line of standard input. */
static int keyboard(void)
{
	int file = make_keyboard();

	if (file < 0)
		return 1;
	for (int c; (c = getchar()) != EOF;)
		if (c == '\n')
			for (int value = 1; value >= 0; value--)
				if (emit(file, EV_KEY, KEY_ENTER, value) || emit(file, EV_SYN, SYN_REPORT, 0))
					return 1;
	return 0;
}

static void pause_ns(long ns)
{
	struct timespec time = { .tv_nsec = ns };

	nanosleep(&time, NULL);
}

/* pace HZ SECONDS FILE...: reads each file so often, and writes those that are given as FILE=TEXT; how many turns there
 * were, how many of them were late by more than a period, and how many calls failed. */
static int pace(int hz, int seconds, int count, char **paths)
{
	int files[16];
	char bytes[256];
	long period_ns = 1000000000L / hz, late = 0, failed = 0;
	struct timespec next;

	for (int at = 0; at < count && at < 16; at++) {
		char *text = strchr(paths[at], '=');

		if (text)
			*text = 0;
		files[at] = open(paths[at], text ? O_WRONLY : O_RDONLY);
		if (files[at] < 0)
			return fail(paths[at]);
		if (text)
			*text = '=';
	}
	clock_gettime(CLOCK_MONOTONIC, &next);
	for (long turn = 0; turn < (long)hz * seconds; turn++) {
		for (int at = 0; at < count; at++) {
			char *text = strchr(paths[at], '=');
			ssize_t done = text ? pwrite(files[at], text + 1, strlen(text + 1), 0) :
					      pread(files[at], bytes, sizeof bytes, 0);

			failed += done < 0;
		}
		next.tv_nsec += period_ns;
		if (next.tv_nsec >= 1000000000L) {
			next.tv_nsec -= 1000000000L;
			next.tv_sec++;
		}
		late += now_ns() > next.tv_sec * 1e9 + next.tv_nsec + period_ns;
		clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &next, NULL);
	}
	printf("turns %ld late %ld failed %ld\n", (long)hz * seconds, late, failed);
	return 0;
}

/* entropy: whether the kernel has random numbers already. */
static int entropy(void)
{
	char byte;

	if (getrandom(&byte, 1, GRND_NONBLOCK) == 1)
		printf("yes\n");
	else if (errno == EAGAIN)
		printf("no\n");
	else
		return fail("getrandom");
	return 0;
}

int main(int argc, char **argv)
{
	const char *command = argc > 1 ? argv[1] : "";

	if (!strcmp(command, "poll") && argc == 4)
		return wait_for(argv[2], atoi(argv[3]));
	if (!strcmp(command, "reads") && argc == 5)
		return time_reads(argv[2], atoi(argv[3]), atoi(argv[4]));
	if (!strcmp(command, "hold") && argc == 4)
		return hold(argv[2], atoi(argv[3]));
	if (!strcmp(command, "keyboard") && argc == 2)
		return keyboard();
	if (!strcmp(command, "entropy") && argc == 2)
		return entropy();
	if (!strcmp(command, "wait") && argc == 3)
		return pause_ns(atol(argv[2]) * 1000000), 0;
	if (!strcmp(command, "pace") && argc > 4 && argc <= 20)
		return pace(atoi(argv[2]), atoi(argv[3]), argc - 4, argv + 4);
	fprintf(stderr, "probe: poll FILE MS | reads FILE COUNT SIZE | hold FILE COUNT | keyboard | entropy | wait MS |\n"
			"  pace HZ SECONDS FILE[=TEXT]...\n");
	return 2;
}
