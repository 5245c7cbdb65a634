/* Follows a dark line on a bright floor until Ctrl-C: cc -o line line.c && ./line [TREE] */
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

static int read_number(int fd)
{
  char text[64];
  ssize_t length = pread(fd, text, sizeof text - 1, 0);

  if (length <= 0) {
    perror("read");
    exit(1);
  }
  text[length] = '\0';
  return atoi(text);
}

static void pause_ms(int ms)
{
  struct timespec time = { 0, ms * 1000000L };

  nanosleep(&time, NULL);
}

int main(int argc, char **argv)
{
  int floor_left, floor_right, turn;

  if (getenv("TRIK_TREE"))
    tree = getenv("TRIK_TREE");
  if (argc > 1)
    tree = argv[1];
  left_motor = open_file("motors/left/value", O_WRONLY);
  right_motor = open_file("motors/right/value", O_WRONLY);
  floor_left = open_file("sensors/floor_left/value", O_RDONLY);
  floor_right = open_file("sensors/floor_right/value", O_RDONLY);

  for (;;) {
    /* The sensors look at the floor beside the line; the one that sees the line has the larger number. */
    turn = (read_number(floor_left) - read_number(floor_right)) / 4;
    drive(20 - turn, 20 + turn);
    pause_ms(20);
  }
}
