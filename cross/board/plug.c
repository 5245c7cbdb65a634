/* Devices that are plugged into the board from a program: each command makes one, says on standard output what the
 * kernel tells it, and takes orders in lines of standard input. Its end takes the device away. */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <linux/uinput.h>
#include <linux/uleds.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

static int fail(const char *what)
{
	perror(what);
	return 1;
}

/* The next line of standard input without its end, read byte by byte so that poll knows what is left; 0 at the end. */
static int line(char *into, size_t size)
{
	size_t length = 0;
	char byte;

	while (read(0, &byte, 1) == 1) {
		if (byte == '\n') {
			into[length] = 0;
			return 1;
		}
		if (length + 1 < size)
			into[length++] = byte;
	}
	return 0;
}

/* Waits for an order or for news of the device. */
static int wait_for(int device, int *news, int *orders)
{
	struct pollfd watched[2] = { { .fd = device, .events = POLLIN }, { .fd = 0, .events = POLLIN } };

	if (poll(watched, 2, -1) < 0)
		return fail("poll");
	*news = watched[0].revents & POLLIN;
	*orders = watched[1].revents != 0;
	return 0;
}

static int emit(int file, int type, int code, int value)
{
	struct input_event event = { .type = type, .code = code, .value = value };

	return write(file, &event, sizeof event) == sizeof event ? 0 : fail("uinput");
}

static int range(int file, int code, int least, int most)
{
	struct uinput_abs_setup axis = { .code = code, .absinfo = { .minimum = least, .maximum = most } };

	return ioctl(file, UI_ABS_SETUP, &axis);
}

/* input NAME: a gamepad with a key, two axes and a lamp. Orders: `TYPE CODE VALUE` is an event, `flood COUNT` so many
 * reports at once. Says `lamp 0` and `lamp 1` when the lamp of CAPS LOCK is switched. */
static int input(const char *name)
{
	struct uinput_setup setup = { .id = { .bustype = BUS_VIRTUAL, .vendor = 1, .product = 1 } };
	struct input_event event;
	char order[80];
	int type, code, value, news, orders;
	int file = open("/dev/uinput", O_RDWR | O_NONBLOCK);

	snprintf(setup.name, sizeof setup.name, "%s", name);
	if (file < 0)
		return fail("/dev/uinput");
	if (ioctl(file, UI_SET_EVBIT, EV_KEY) || ioctl(file, UI_SET_KEYBIT, BTN_SOUTH) || ioctl(file, UI_SET_KEYBIT, KEY_ENTER) ||
	    ioctl(file, UI_SET_EVBIT, EV_ABS) || range(file, ABS_X, -100, 100) || range(file, ABS_Y, -100, 100) ||
	    ioctl(file, UI_SET_EVBIT, EV_LED) || ioctl(file, UI_SET_LEDBIT, LED_CAPSL) || ioctl(file, UI_DEV_SETUP, &setup) ||
	    ioctl(file, UI_DEV_CREATE))
		return fail("uinput");
	printf("made, an event has %zu bytes\n", sizeof event);
	for (;;) {
		fflush(stdout);
		if (wait_for(file, &news, &orders))
			return 1;
		while (news && read(file, &event, sizeof event) == sizeof event)
			if (event.type == EV_LED && event.code == LED_CAPSL)
				printf("lamp %d\n", event.value);
		if (!orders)
			continue;
		if (!line(order, sizeof order))
			return 0;
		if (sscanf(order, "flood %d", &value) == 1) {
			for (int turn = 0; turn < value; turn++)
				if (emit(file, EV_ABS, ABS_X, turn % 100) || emit(file, EV_SYN, SYN_REPORT, 0))
					return 1;
		} else if (sscanf(order, "%i %i %i", &type, &code, &value) == 3) {
			if (emit(file, type, code, value))
				return 1;
		} else {
			fprintf(stderr, "no order: %s\n", order);
			return 1;
		}
	}
}

/* led NAME MAX: a lamp. Says each brightness that it is given. */
static int led(const char *name, int most)
{
	struct uleds_user_dev setup = { .max_brightness = most };
	int value, news, orders;
	char order[80];
	int file = open("/dev/uleds", O_RDWR);

	snprintf(setup.name, sizeof setup.name, "%s", name);
	if (file < 0)
		return fail("/dev/uleds");
	if (write(file, &setup, sizeof setup) != sizeof setup)
		return fail("uleds");
	printf("made\n");
	for (;;) {
		fflush(stdout);
		if (wait_for(file, &news, &orders))
			return 1;
		if (news && read(file, &value, sizeof value) == sizeof value)
			printf("brightness %d\n", value);
		if (orders && !line(order, sizeof order))
			return 0;
	}
}

/* serial LINK: a serial line whose near end is LINK. An order is bytes in hexadecimal that arrive there; says in the
 * same form what is sent. */
static int serial(const char *link)
{
	unsigned char bytes[256];
	char order[600];
	int news, orders, used;
	int file = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);

	if (file < 0 || grantpt(file) || unlockpt(file))
		return fail("/dev/ptmx");
	unlink(link);
	if (symlink(ptsname(file), link))
		return fail(link);
	/* Held, because a line without an opening is at its end for the far side. */
	if (open(link, O_RDWR | O_NOCTTY) < 0)
		return fail(link);
	printf("made\n");
	for (;;) {
		fflush(stdout);
		if (wait_for(file, &news, &orders))
			return 1;
		ssize_t got = news ? read(file, bytes, sizeof bytes) : 0;

		if (got > 0) {
			printf("heard");
			for (ssize_t at = 0; at < got; at++)
				printf(" %02x", bytes[at]);
			printf("\n");
		}
		if (!orders)
			continue;
		if (!line(order, sizeof order))
			return 0;
		size_t count = 0;

		for (char *at = order; count < sizeof bytes && sscanf(at, "%2hhx%n", &bytes[count], &used) == 1; at += used)
			count++;
		if (write(file, bytes, count) != (ssize_t)count)
			return fail("write");
	}
}

int main(int argc, char **argv)
{
	const char *command = argc > 1 ? argv[1] : "";

	if (!strcmp(command, "input") && argc == 3)
		return input(argv[2]);
	if (!strcmp(command, "led") && argc == 4)
		return led(argv[2], atoi(argv[3]));
	if (!strcmp(command, "serial") && argc == 3)
		return serial(argv[2]);
	fprintf(stderr, "plug: input NAME | led NAME MAX | serial LINK\n");
	return 2;
}
