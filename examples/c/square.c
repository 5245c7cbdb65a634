/* Drives a square of 30 cm by its encoders: cc -o square square.c && ./square [TREE] */
#define _POSIX_C_SOURCE 200809L
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

/* Degrees of a wheel of 56 mm for 300 mm ahead, and for a quarter of a turn with wheels 155 mm apart. */
enum { SIDE = 614, CORNER = 249 };

static const char *tree = "/trikfs";
static int left_motor, right_motor, left_wheel, right_wheel;
static int left_goal, right_goal;

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

/* The power that brings a wheel nearer to its goal. */
static int power_for(int missing)
{
  int power = missing / 5;

  if (power > 30)
    return 30;
  if (power < -30)
    return -30;
  return power;
}

/* Turns the wheels by so many degrees. Goals grow from leg to leg, so small errors do not add up. */
static void turn_wheels(int left_degrees, int right_degrees)
{
  int left_power, right_power;

  left_goal += left_degrees;
  right_goal += right_degrees;
  for (;;) {
    left_power = power_for(left_goal - read_number(left_wheel));
    right_power = power_for(right_goal - read_number(right_wheel));
    drive(left_power, right_power);
    if (left_power == 0 && right_power == 0)
      return;
    pause_ms(20);
  }
}

int main(int argc, char **argv)
{
  int leg;

  if (getenv("TRIK_TREE"))
    tree = getenv("TRIK_TREE");
  if (argc > 1)
    tree = argv[1];
  left_motor = open_file("motors/left/value", O_WRONLY);
  right_motor = open_file("motors/right/value", O_WRONLY);
  left_wheel = open_file("encoders/left/value", O_RDONLY);
  right_wheel = open_file("encoders/right/value", O_RDONLY);

  left_goal = read_number(left_wheel);
  right_goal = read_number(right_wheel);
  for (leg = 0; leg < 4; leg++) {
    turn_wheels(SIDE, SIDE);
    turn_wheels(-CORNER, CORNER);
  }
  return 0;
}
