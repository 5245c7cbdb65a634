//! Helpers of programs in C: what operators of the language do not do, and what each reading and command means for
//! the tree.
//!
//! Owns paths of the tree, as docs/user/trik.md has them.

/// What each program in C begins with.
pub(super) const HEAD: &str = "
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

typedef long long Whole;
typedef struct { char at[256]; } Text;
typedef struct { int count; double at[512]; } Table;

/* Where the files of the robot are. */
static const char *tree = \"/trikfs\";
static Whole started;

static void findTree(int count, char **arguments)
{
    const char *named = getenv(\"TRIK_TREE\");

    if (named && *named)
        tree = named;
    if (count > 1)
        tree = arguments[1];
}

static __attribute__((unused)) void fail(const char *what)
{
    fprintf(stderr, \"%s: %s\\n\", what, errno ? strerror(errno) : \"not possible\");
    exit(1);
}
";

/// Helpers in C; later ones may use earlier ones.
pub(super) const HELPERS: &[(&str, &str)] = &[
    (
        "milliseconds",
        "
static Whole milliseconds(void)
{
    struct timespec now;

    clock_gettime(CLOCK_MONOTONIC, &now);
    return (Whole)now.tv_sec * 1000 + now.tv_nsec / 1000000;
}",
    ),
    (
        "textOf",
        "
/* A text; what is too long is cut. */
static Text textOf(const char *from)
{
    Text result;

    snprintf(result.at, sizeof result.at, \"%s\", from);
    return result;
}",
    ),
    (
        "openFile",
        "
/* Files stay open: when the program ends, motors whose files it has open stop. */
static int openFile(const char *name)
{
    static struct { char name[64]; int file; } opened[64];
    static int count;
    char path[4096];
    int index;

    for (index = 0; index < count; index++)
        if (strcmp(opened[index].name, name) == 0)
            return opened[index].file;
    if (count == 64)
        fail(\"too many files\");
    snprintf(path, sizeof path, \"%s/%s\", tree, name);
    snprintf(opened[count].name, sizeof opened[count].name, \"%s\", name);
    opened[count].file = open(path, O_WRONLY);
    if (opened[count].file < 0)
        fail(path);
    return opened[count++].file;
}",
    ),
    (
        "writeFile",
        "
static void writeFile(const char *group, const char *port, const char *file, const char *value)
{
    char name[64];

    snprintf(name, sizeof name, \"%s%s%s\", group, port, file);
    if (write(openFile(name), value, strlen(value)) < 0)
        fail(name);
}",
    ),
    (
        "writeWhole",
        "
static void writeWhole(const char *group, const char *port, const char *file, Whole value)
{
    char digits[32];

    snprintf(digits, sizeof digits, \"%lld\", value);
    writeFile(group, port, file, digits);
}",
    ),
    (
        "readNumbers",
        "
/* All numbers of a file; none if it cannot be read. */
static Table readNumbers(const char *group, const char *port, const char *file)
{
    static char content[16384];
    char path[4096], *at = content, *end;
    Table numbers = { 0, { 0 } };
    ssize_t length = -1;
    int opened;

    snprintf(path, sizeof path, \"%s/%s%s%s\", tree, group, port, file);
    opened = open(path, O_RDONLY);
    if (opened >= 0) {
        length = read(opened, content, sizeof content - 1);
        close(opened);
    }
    content[length < 0 ? 0 : length] = 0;
    while (numbers.count < 512) {
        double number = strtod(at, &end);
        if (end == at)
            break;
        numbers.at[numbers.count++] = number;
        at = end;
    }
    return numbers;
}",
    ),
    (
        "readNumber",
        "
static Whole readNumber(const char *group, const char *port, const char *file)
{
    Table numbers = readNumbers(group, port, file);

    if (numbers.count == 0)
        fail(port);
    return (Whole)numbers.at[0];
}",
    ),
    super::threads::THREADS,
    (
        "wait",
        "
static void wait(Whole ms)
{
    if (ms < 10)
        ms = 10;
#ifdef HAS_THREADS
    pauseFor(ms);
#else
    struct timespec time = { ms / 1000, ms % 1000 * 1000000 };

    nanosleep(&time, NULL);
#endif
}",
    ),
    ("emptyTable", "\nstatic Table emptyTable(void)\n{\n    Table result = { 0, { 0 } };\n\n    return result;\n}"),
    (
        "tableOf",
        "
static Table tableOf(int count, const double *from)
{
    Table result = { 0, { 0 } };

    for (; result.count < count && result.count < 512; result.count++)
        result.at[result.count] = from[result.count];
    return result;
}",
    ),
    (
        "item",
        "
/* An element of a table, 0 beyond its end. */
static double item(Table of, Whole index)
{
    if (index < 0)
        fail(\"Negative index for a table\");
    return index < of.count ? of.at[index] : 0;
}",
    ),
    (
        "put",
        "
static void put(Table *of, Whole index, double value)
{
    if (index < 0 || index >= 512)
        fail(\"index of a table\");
    for (; of->count <= index; of->count++)
        of->at[of->count] = 0;
    of->at[index] = value;
}",
    ),
    (
        "randomWhole",
        "
static Whole randomWhole(Whole low, Whole high)
{
    static int seeded;

    if (!seeded) {
        srand((unsigned)time(NULL));
        seeded = 1;
    }
    return low + rand() % (high - low + 1);
}",
    ),
    ("sign", "\nstatic Whole sign(double number)\n{\n    return (number > 0) - (number < 0);\n}"),
    (
        "toWhole",
        "
/* The nearest whole number; halves go away from 0. */
static Whole toWhole(double number)
{
    return fabs(number) < 9e18 ? (int)(unsigned)llround(number) : 0;
}",
    ),
    (
        "toNumber",
        "
/* A text as a number; one that is none counts as 0. */
static double toNumber(Text words)
{
    char *end;
    double number = strtod(words.at, &end);

    while (*end == ' ')
        end++;
    return *end == 0 ? number : 0;
}",
    ),
    (
        "toTruth",
        "
static int toTruth(Text words)
{
    return words.at[0] != 0 && strcmp(words.at, \"0\") != 0 && strcasecmp(words.at, \"false\") != 0;
}",
    ),
    (
        "toText",
        "
/* A number as a text, with as few digits as it needs. */
static Text toText(double number)
{
    Text result;
    int digits;

    if (number == trunc(number) && fabs(number) < 1e15) {
        snprintf(result.at, sizeof result.at, \"%lld\", (Whole)number);
        return result;
    }
    for (digits = 1; digits <= 17; digits++) {
        snprintf(result.at, sizeof result.at, \"%.*g\", digits, number);
        if (strtod(result.at, NULL) == number)
            break;
    }
    return result;
}",
    ),
    ("toTextOfTruth", "\nstatic Text toTextOfTruth(int truth)\n{\n    return textOf(truth ? \"true\" : \"false\");\n}"),
    (
        "toPrinted",
        "
/* A text as a display shows it: numbers with at most six digits after the point. */
static Text toPrinted(Text from)
{
    char *end;
    double number = strtod(from.at, &end);
    size_t length;

    if (end == from.at || *end != 0)
        return from;
    snprintf(from.at, sizeof from.at, \"%.6f\", number);
    length = strlen(from.at);
    while (from.at[length - 1] == '0')
        length--;
    if (from.at[length - 1] == '.')
        length--;
    from.at[length] = 0;
    return from;
}",
    ),
    ("sameText", "\nstatic int sameText(Text left, Text right)\n{\n    return strcmp(left.at, right.at) == 0;\n}"),
    (
        "joinText",
        "
static Text joinText(Text left, Text right)
{
    size_t length = strlen(left.at);

    snprintf(left.at + length, sizeof left.at - length, \"%s\", right.at);
    return left;
}",
    ),
    (
        "letters",
        "
/* How many letters a text has. */
static Whole letters(Text words)
{
    const char *at;
    Whole count = 0;

    for (at = words.at; *at; at++)
        count += (*at & 0xC0) != 0x80;
    return count;
}",
    ),
    (
        "divide",
        "
static double divide(double left, double right)
{
    if (right == 0)
        fail(\"Division by zero\");
    return left / right;
}",
    ),
    (
        "divideWhole",
        "
static Whole divideWhole(Whole left, Whole right)
{
    if (right == 0)
        fail(\"Division by zero\");
    return left / right;
}",
    ),
    (
        "modulo",
        "
static Whole modulo(Whole left, Whole right)
{
    if (right == 0)
        fail(\"Division by zero\");
    return left % right;
}",
    ),
    ("shiftLeft", "\nstatic Whole shiftLeft(Whole number, Whole bits)\n{\n    return (int)((unsigned)number << (bits & 31));\n}"),
    ("shiftRight", "\nstatic Whole shiftRight(Whole number, Whole bits)\n{\n    return (int)number >> (bits & 31);\n}"),
    (
        "again",
        "
/* Whether a loop goes on. Its counter lives as long as the program: leaving part-way does not reset it. */
static struct Counter { Whole left; int isSet; } counters[1000];
static int again(struct Counter *counter, Whole times)
{
    counter->left = (counter->isSet ? counter->left : times) - 1;
    counter->isSet = counter->left >= 0;
    return counter->isSet;
}",
    ),
    (
        "sensor",
        "
/* -1 without an echo. */
static Whole sensor(const char *port)
{
    Table numbers = readNumbers(\"sensors/\", port, \"/value\");

    return numbers.count ? (Whole)numbers.at[0] : -1;
}",
    ),
    ("encoder", "\nstatic Whole encoder(const char *port)\n{\n    return readNumber(\"encoders/\", port, \"/value\");\n}"),
    (
        "gyroscope",
        "
/* Rates around x, y and z, time, tilt around x and y, heading. */
static Table gyroscope(void)
{
    Table result = readNumbers(\"gyroscope\", \"\", \"/value\");
    Table tilt = readNumbers(\"gyroscope\", \"\", \"/tilt\");

    result.at[3] = (double)milliseconds();
    result.at[4] = tilt.at[0];
    result.at[5] = tilt.at[1];
    result.at[6] = (double)readNumber(\"gyroscope\", \"\", \"/heading\");
    result.count = 7;
    return result;
}",
    ),
    ("accelerometer", "\nstatic Table accelerometer(void)\n{\n    return readNumbers(\"accelerometer\", \"\", \"/value\");\n}"),
    ("lineSensor", "\nstatic Table lineSensor(void)\n{\n    return readNumbers(\"camera/line\", \"\", \"/value\");\n}"),
    ("objectSensor", "\nstatic Table objectSensor(void)\n{\n    return readNumbers(\"camera/object\", \"\", \"/value\");\n}"),
    (
        "colorSensor",
        "
/* Red, green and blue in the middle of the picture. */
static Table colorSensor(void)
{
    Table result = readNumbers(\"camera/color\", \"\", \"/value\");
    int color = (int)result.at[4];

    result.at[0] = color / 65536;
    result.at[1] = color / 256 % 256;
    result.at[2] = color % 256;
    result.count = 3;
    return result;
}",
    ),
    ("lidar", "\nstatic Table lidar(void)\n{\n    return readNumbers(\"lidar\", \"\", \"/value\");\n}"),
    (
        "button",
        "
/* Whether the key with a code is pressed, 1 or 0. */
static Whole button(Whole code)
{
    static const Whole keys[] = { 116, 103, 1, 105, 106, 108, 28 };
    Table pressed = readNumbers(\"keys\", \"\", \"/value\");
    int index;

    for (index = 0; index < 7; index++)
        if (keys[index] == code)
            return (Whole)pressed.at[index];
    return 0;
}",
    ),
    (
        "anyButton",
        "
/* The code of a pressed key, or -1. */
static Whole anyButton(int waits)
{
    static const Whole keys[] = { 105, 106, 103, 108, 28, 1, 116 };
    int index;

    do {
        wait(20);
        for (index = 0; index < 7; index++)
            if (button(keys[index]))
                return keys[index];
    } while (waits);
    return -1;
}",
    ),
    ("padButton", "\nstatic Whole padButton(Whole number)\n{\n    return (Whole)readNumbers(\"gamepad/buttons\", \"\", \"/value\").at[number - 1];\n}"),
    ("pad", "\nstatic Whole pad(Whole number, int part)\n{\n    return (Whole)readNumbers(\"gamepad/pad\", number == 1 ? \"1\" : \"2\", \"/value\").at[part];\n}"),
    ("wheel", "\nstatic Whole wheel(void)\n{\n    return readNumber(\"gamepad/wheel\", \"\", \"/value\");\n}"),
    ("gamepadConnected", "\nstatic Whole gamepadConnected(void)\n{\n    return readNumbers(\"gamepad/buttons\", \"\", \"/value\").count > 0;\n}"),
    (
        "setPower",
        "
/* Percent, -100 to 100. */
static void setPower(const char *port, Whole percent)
{
    writeWhole(\"motors/\", port, \"/value\", percent > 100 ? 100 : percent < -100 ? -100 : percent);
}",
    ),
    ("powerOff", "\nstatic void powerOff(const char *port)\n{\n    writeWhole(\"motors/\", port, \"/brake\", 0);\n}"),
    ("setServo", "\nstatic void setServo(const char *port, Whole degrees)\n{\n    writeWhole(\"servos/\", port, \"/value\", degrees);\n}"),
    ("resetEncoder", "\nstatic void resetEncoder(const char *port)\n{\n    writeWhole(\"encoders/\", port, \"/value\", 0);\n}"),
    ("playSound", "\nstatic void playSound(Text file)\n{\n    writeFile(\"sound/play\", \"\", \"/value\", file.at);\n}"),
    (
        "playTone",
        "
static void playTone(Whole hertz, Whole ms)
{
    char words[64];

    snprintf(words, sizeof words, \"%lld %lld\", hertz, ms);
    writeFile(\"sound/tone\", \"\", \"/value\", words);
}",
    ),
    ("say", "\nstatic void say(Text words)\n{\n    writeFile(\"sound/say\", \"\", \"/value\", words.at);\n}"),
    ("light", "\nstatic void light(Whole red, Whole green)\n{\n    writeWhole(\"led/red\", \"\", \"/value\", red);\n    writeWhole(\"led/green\", \"\", \"/value\", green);\n}"),
    ("runCommand", "\nstatic void runCommand(Text command)\n{\n    if (system(command.at) < 0)\n        fail(command.at);\n}"),
    (
        "append",
        "
static void append(Text name, Text words)
{
    FILE *file = fopen(name.at, \"a\");

    if (!file || fputs(words.at, file) < 0)
        fail(name.at);
    fclose(file);
}",
    ),
    ("removeFile", "\nstatic void removeFile(Text name)\n{\n    remove(name.at);\n}"),
    ("detect", "\nstatic void detect(const char *mode)\n{\n    writeWhole(\"camera/\", mode, \"/detect\", 1);\n}"),
    ("say_text", "\nstatic void say_text(Text words)\n{\n    puts(words.at);\n}"),
    ("label", "\n/* Nothing is drawn: the text goes to the terminal. */\nstatic void label(Text words, Whole x, Whole y, Whole size)\n{\n    (void)x, (void)y, (void)size;\n    puts(words.at);\n}"),
    ("rest", "\n/* Everything stops. */\nstatic void rest(void)\n{\n    writeWhole(\"stop\", \"\", \"\", 1);\n}"),
];
