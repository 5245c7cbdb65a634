/* Goes to the wall ahead and stops 20 cm before it: cc -o wall wall.c && ./wall [TREE] */
#define _POSIX_C_SOURCE 200809L
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

static const char *tree = "/trikfs";
static int left_motor, right_motor;

/* Motors that stay open until the program ends come to rest then, also after Ctrl-C. */
static int open_file(const char *name, int flags)
{
  char path[4096];
  int fd;

  snprintf(path, sizeof path, "%s/%s", tree, name);
  fd = open(path, flags);
  if (fd < 0) {
    perror(path);
    exit(1);
  }
  return fd;
}

static void write_number(int fd, int number)
{
  if (dprintf(fd, "%d", number) < 0) {
    perror("write");
    exit(1);
  }
}

static void drive(int left, int right)
{
  write_number(left_motor, left);
  write_number(right_motor, right);
}

/* Gives 0 if there is a number. */
static int read_number(int fd, int *number)
{
  char text[64];
  ssize_t length = pread(fd, text, sizeof text - 1, 0);

  if (length <= 0)
    return -1;
  text[length] = '\0';
  *number = atoi(text);
  return 0;
}

static void pause_ms(int ms)
{
  struct timespec time = { 0, ms * 1000000L };

  nanosleep(&time, NULL);
}

int main(int argc, char **argv)
{
  int front, distance, power;

  if (getenv("TRIK_TREE"))
    tree = getenv("TRIK_TREE");
  if (argc > 1)
    tree = argv[1];
  left_motor = open_file("motors/left/value", O_WRONLY);
  right_motor = open_file("motors/right/value", O_WRONLY);
  front = open_file("sensors/front/value", O_RDONLY);

  for (;;) {
    if (read_number(front, &distance) == 0) {
      power = (distance - 20) * 2;
      if (power == 0)
        break;
      if (power > 30)
        power = 30;
      if (power < -30)
        power = -30;
      drive(power, power);
    } else {
      /* No echo: nobody knows how far the wall is. */
      drive(0, 0);
    }
    pause_ms(20);
  }
  drive(0, 0);
  return 0;
}
