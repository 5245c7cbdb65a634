//! Helpers of the languages that drive the robot through files: what each reading and command means for the tree.
//!
//! Owns paths of the tree, as docs/user/trik.md has them.

/// Helpers in Lua; later ones may use earlier ones.
pub(super) const LUA: &[(&str, &str)] = &[
    ("tree", "-- Where the files of the robot are.\ntree = arg and arg[1] or os.getenv(\"TRIK_TREE\") or \"/trikfs\""),
    (
        "writeFile",
        "
-- Files stay open: when the program ends, motors whose files it has open stop.
local opened = {}
function writeFile(name, text)
  local file = opened[name] or assert(io.open(tree .. \"/\" .. name, \"w\"))
  opened[name] = file
  file:setvbuf(\"no\")
  assert(file:write(text))
end",
    ),
    (
        "readFile",
        "
function readFile(name)
  local file = assert(io.open(tree .. \"/\" .. name))
  local text = file:read(\"*a\")
  file:close()
  return text
end",
    ),
    (
        "readNumbers",
        "
-- All numbers of a file, from 0.
function readNumbers(name)
  local numbers, count = {}, 0
  for word in (readFile(name) or \"\"):gmatch(\"%S+\") do
    numbers[count] = tonumber(word)
    count = count + 1
  end
  return numbers
end",
    ),
    (
        "readNumber",
        "
function readNumber(name)
  return readNumbers(name)[0] or error(name .. \" has no value\")
end",
    ),
    (
        "milliseconds",
        "
local ffi = require(\"ffi\")
ffi.cdef(\"int poll(void *files, unsigned long count, int ms); typedef struct { long s, ns; } trik_time; int clock_gettime(int clock, trik_time *time);\")
function milliseconds()
  local now = ffi.new(\"trik_time\")
  ffi.C.clock_gettime(1, now)
  return tonumber(now.s) * 1000 + math.floor(tonumber(now.ns) / 1000000)
end",
    ),
    (
        "sleep",
        "
function sleep(ms)
  ffi.C.poll(nil, 0, ms)
end",
    ),
    (
        "wait",
        "
-- Other threads run meanwhile, if there are any.
function wait(ms)
  if runThreads and coroutine.running() then
    coroutine.yield(milliseconds() + math.max(ms, 10))
  else
    sleep(math.max(ms, 10))
  end
end",
    ),
    (
        "startThread",
        "
-- Threads take turns: one runs until it waits.
local threads, order = {}, 0
local function step(thread)
  order = order + 1
  thread.order = order
  current, thread.caller = thread, current
  local good, due = coroutine.resume(thread.run)
  current = thread.caller
  thread.due = due
  if not good then error(due, 0) end
  if coroutine.status(thread.run) == \"dead\" then thread.ended = true end
end
local function find(name)
  for _, thread in ipairs(threads) do
    if thread.name == name and not thread.ended then return thread end
  end
end
function startThread(name, run)
  local thread = { name = name, run = coroutine.create(run), mail = {} }
  threads[#threads + 1] = thread
  step(thread)
end
function joinThread(name)
  while find(name) do wait(10) end
end
function killThread(name)
  local thread = find(name)
  if thread then thread.ended = true end
  if thread == current then coroutine.yield(0) end
end
function sendMessage(name, text)
  local thread = find(name)
  if thread then table.insert(thread.mail, text) end
end
function receiveMessage(waits)
  while waits and #current.mail == 0 do wait(10) end
  return table.remove(current.mail, 1) or \"\"
end
function runThreads(main)
  startThread(\"main\", main)
  while true do
    local first
    for index = #threads, 1, -1 do
      local thread = threads[index]
      if thread.ended then
        table.remove(threads, index)
      elseif not first or thread.due < first.due or thread.due == first.due and thread.order < first.order then
        first = thread
      end
    end
    if not first then return end
    local rest = first.due - milliseconds()
    if rest > 0 then sleep(rest) end
    step(first)
  end
end",
    ),
    (
        "random",
        "
function random(low, high)
  return math.random(low, high)
end",
    ),
    (
        "toNumber",
        "
-- A value as a number; a text that is none counts as 0.
function toNumber(value)
  if type(value) == \"boolean\" then return value and 1 or 0 end
  return type(value) == \"table\" and 0 or tonumber(value) or 0
end",
    ),
    (
        "sign",
        "
function sign(number)
  return number > 0 and 1 or number < 0 and -1 or 0
end",
    ),
    (
        "toWhole",
        "
-- The nearest whole number; halves go away from 0.
function toWhole(number)
  local whole, fraction = math.modf(number)
  if math.abs(fraction) >= 0.5 then whole = whole + (number > 0 and 1 or -1) end
  return (whole + 2147483648) % 4294967296 - 2147483648
end",
    ),
    (
        "toTruth",
        "
-- Whether a value counts as true.
function toTruth(value)
  if type(value) == \"string\" then return value ~= \"\" and value ~= \"0\" and value:lower() ~= \"false\" end
  return toWhole(toNumber(value)) ~= 0
end",
    ),
    (
        "toText",
        "
-- A value as a text, numbers with as few digits as they need; tables and nothing are empty.
function toText(value)
  if type(value) == \"number\" then
    for digits = 1, 17 do
      local text = string.format(\"%.\" .. digits .. \"g\", value)
      if tonumber(text) == value then
        return value == math.floor(value) and math.abs(value) < 1e15 and string.format(\"%d\", value) or text
      end
    end
  end
  return (value == nil or type(value) == \"table\") and \"\" or tostring(value)
end",
    ),
    (
        "toPrinted",
        "
-- A text as a display shows it: numbers with at most six digits behind the point.
function toPrinted(text)
  local number = tonumber(text)
  if not number then return text end
  text = string.format(\"%.6f\", number):gsub(\"0+$\", \"\"):gsub(\"%.$\", \"\")
  return text == \"-0\" and \"0\" or text
end",
    ),
    (
        "toValue",
        "
-- The value that a message stands for.
function toValue(message)
  local quoted = message:match(\"^%s*\\\"(.*)\\\"%s*$\") or message:match(\"^%s*'(.*)'%s*$\")
  if quoted then return quoted end
  if message == \"true\" or message == \"false\" then return message == \"true\" end
  return tonumber(message) or message
end",
    ),
    (
        "same",
        "
-- Whether two values are equal; a text is compared as what the other one is.
function same(left, right)
  if type(left) == \"string\" then return left == toText(right) end
  if type(left) == \"boolean\" then return left == toTruth(right) end
  if type(left) == \"number\" then return left == tonumber(right) end
  return left == right
end",
    ),
    (
        "divide",
        "
function divide(left, right)
  if right == 0 then error(\"Division by zero\") end
  return left / right
end",
    ),
    (
        "divideWhole",
        "
-- A quotient without its fraction.
function divideWhole(left, right)
  if right == 0 then error(\"Division by zero\") end
  return (math.modf(left / right))
end",
    ),
    (
        "modulo",
        "
-- What is left of a division, with the sign of the first number.
function modulo(left, right)
  if right == 0 then error(\"Division by zero\") end
  return math.fmod(left, right)
end",
    ),
    (
        "negated",
        "
-- The number with the other sign and as many digits as a small float has.
function negated(number)
  return -tonumber(require(\"ffi\").new(\"float[1]\", number)[0])
end",
    ),
    (
        "letters",
        "
-- How many letters a text has.
function letters(text)
  return select(2, text:gsub(\"[^\\128-\\191]\", \"\"))
end",
    ),
    (
        "item",
        "
-- An element of a table, 0 beyond its end.
function item(table, index)
  if index < 0 then error(\"Negative index for a table\") end
  return table[index] or 0
end",
    ),
    (
        "put",
        "
function put(table, index, value)
  if index < 0 then error(\"Negative index for a table\") end
  table[index] = value
end",
    ),
    (
        "copy",
        "
-- A table of its own, so that changing one does not change the other.
function copy(value)
  if type(value) ~= \"table\" then return value end
  local result = {}
  for index, part in pairs(value) do result[index] = copy(part) end
  return result
end",
    ),
    (
        "again",
        "
-- Whether a loop goes on. Its counter lives as long as the program: who leaves half way finds it so.
local counters = {}
function again(loop, times)
  local left = (counters[loop] or times) - 1
  counters[loop] = left >= 0 and left or nil
  return left >= 0
end",
    ),
    (
        "sensor",
        "
-- -1 without an echo.
function sensor(port)
  local good, value = pcall(readNumber, \"sensors/\" .. port .. \"/value\")
  return good and value or -1
end",
    ),
    ("encoder", "\nfunction encoder(port)\n  return readNumber(\"encoders/\" .. port .. \"/value\")\nend"),
    (
        "gyroscope",
        "
-- Rates around x, y and z, time, tilt around x and y, heading.
function gyroscope()
  local rates, tilt = readNumbers(\"gyroscope/value\"), readNumbers(\"gyroscope/tilt\")
  return { [0] = rates[0], rates[1], rates[2], milliseconds(), tilt[0], tilt[1], readNumber(\"gyroscope/heading\") }
end",
    ),
    ("accelerometer", "\nfunction accelerometer()\n  return readNumbers(\"accelerometer/value\")\nend"),
    ("lineSensor", "\nfunction lineSensor()\n  return readNumbers(\"camera/line/value\")\nend"),
    ("objectSensor", "\nfunction objectSensor()\n  return readNumbers(\"camera/object/value\")\nend"),
    (
        "colorSensor",
        "
-- Red, green and blue in the middle of the picture.
function colorSensor()
  local color = readNumbers(\"camera/color/value\")[4]
  return { [0] = math.floor(color / 65536), math.floor(color / 256) % 256, color % 256 }
end",
    ),
    ("lidar", "\nfunction lidar()\n  return readNumbers(\"lidar/value\")\nend"),
    (
        "button",
        "
local keys = { [0] = 116, 103, 1, 105, 106, 108, 28 }
-- Whether the key with a code is pressed, 1 or 0.
function button(code)
  local pressed = readNumbers(\"keys/value\")
  for index, known in pairs(keys) do
    if known == code then return pressed[index] end
  end
  return 0
end",
    ),
    (
        "anyButton",
        "
-- The code of a pressed key, or -1.
function anyButton(waits)
  repeat
    wait(20)
    for _, code in ipairs({ 105, 106, 103, 108, 28, 1, 116 }) do
      if button(code) ~= 0 then return code end
    end
  until not waits
  return -1
end",
    ),
    ("padButton", "\nfunction padButton(number)\n  return readNumbers(\"gamepad/buttons/value\")[number - 1]\nend"),
    ("pad", "\nfunction pad(number, part)\n  return readNumbers(\"gamepad/pad\" .. number .. \"/value\")[part]\nend"),
    ("wheel", "\nfunction wheel()\n  return readNumber(\"gamepad/wheel/value\")\nend"),
    (
        "gamepadConnected",
        "\nfunction gamepadConnected()\n  return pcall(readNumber, \"gamepad/buttons/value\") and 1 or 0\nend",
    ),
    (
        "setPower",
        "
-- Percent, -100 to 100.
function setPower(port, percent)
  writeFile(\"motors/\" .. port .. \"/value\", math.max(-100, math.min(100, percent)))
end",
    ),
    ("powerOff", "\nfunction powerOff(port)\n  writeFile(\"motors/\" .. port .. \"/brake\", 0)\nend"),
    ("setServo", "\nfunction setServo(port, degrees)\n  writeFile(\"servos/\" .. port .. \"/value\", degrees)\nend"),
    ("resetEncoder", "\nfunction resetEncoder(port)\n  writeFile(\"encoders/\" .. port .. \"/value\", 0)\nend"),
    ("playSound", "\nfunction playSound(file)\n  writeFile(\"sound/play/value\", file)\nend"),
    ("playTone", "\nfunction playTone(hertz, ms)\n  writeFile(\"sound/tone/value\", hertz .. \" \" .. ms)\nend"),
    ("say", "\nfunction say(text)\n  writeFile(\"sound/say/value\", text)\nend"),
    ("light", "\nfunction light(red, green)\n  writeFile(\"led/red/value\", red)\n  writeFile(\"led/green/value\", green)\nend"),
    ("system", "\nfunction system(command)\n  os.execute(command .. \" &\")\nend"),
    (
        "append",
        "
function append(name, text)
  local file = assert(io.open(name, \"a\"))
  file:write(text)
  file:close()
end",
    ),
    ("removeFile", "\nfunction removeFile(name)\n  os.remove(name)\nend"),
    ("detect", "\nfunction detect(mode)\n  writeFile(\"camera/\" .. mode .. \"/detect\", 1)\nend"),
    ("say_text", "\nfunction say_text(text)\n  print(text)\nend"),
    ("label", "\n-- There is no file for the display: the text goes to the terminal.\nfunction label(text, x, y, size)\n  print(text)\nend"),
    ("rest", "\n-- Everything stops.\nfunction rest()\n  writeFile(\"stop\", 1)\nend"),
];

/// What each program in C begins with.
pub(super) const C_HEAD: &str = "
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

static __attribute__((unused)) void fail(const char *what)
{
    fprintf(stderr, \"%s: %s\\n\", what, errno ? strerror(errno) : \"not possible\");
    exit(1);
}
";

/// Helpers in C; later ones may use earlier ones.
pub(super) const C: &[(&str, &str)] = &[
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
    (
        "startThread",
        "
#define HAS_THREADS
/* Threads take turns: one runs until it waits. */
static pthread_mutex_t turn = PTHREAD_MUTEX_INITIALIZER;
static struct Thread { Text name; void (*run)(void); pthread_t id; int runs, killed; } threads[100];
static int threadCount;
static __thread struct Thread *current;

static void pauseFor(Whole ms)
{
    struct timespec time;

    time.tv_sec = ms / 1000;
    time.tv_nsec = ms % 1000 * 1000000;
    pthread_mutex_unlock(&turn);
    nanosleep(&time, NULL);
    pthread_mutex_lock(&turn);
    if (current && current->killed) {
        current->runs = 0;
        pthread_mutex_unlock(&turn);
        pthread_exit(NULL);
    }
}

static void *runThread(void *thread)
{
    current = thread;
    pthread_mutex_lock(&turn);
    current->run();
    current->runs = 0;
    pthread_mutex_unlock(&turn);
    return NULL;
}

static void startThread(Text name, void (*run)(void))
{
    struct Thread *thread = &threads[threadCount];

    if (threadCount == 100)
        fail(\"too many threads\");
    threadCount++;
    thread->name = name;
    thread->run = run;
    thread->runs = 1;
    if (pthread_create(&thread->id, NULL, runThread, thread) != 0)
        fail(\"pthread_create\");
}

static int isRunning(const Text *name)
{
    int index, found = 0;

    for (index = 0; index < threadCount; index++)
        found |= threads[index].runs && strcmp(threads[index].name.at, name->at) == 0;
    return found;
}

static __attribute__((unused)) void joinThread(Text name)
{
    while (isRunning(&name))
        pauseFor(10);
}

static __attribute__((unused)) void killThread(Text name)
{
    int index;

    for (index = 0; index < threadCount; index++)
        if (strcmp(threads[index].name.at, name.at) == 0)
            threads[index].killed = 1;
}

static void beginThreads(void)
{
    pthread_mutex_lock(&turn);
}

/* The program ends when all its threads have ended. */
static void endThreads(void)
{
    int index;

    for (index = 0; index < threadCount; index++)
        while (threads[index].runs)
            pauseFor(10);
}",
    ),
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
/* A text as a display shows it: numbers with at most six digits behind the point. */
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
/* Whether a loop goes on. Its counter lives as long as the program: who leaves half way finds it so. */
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
    ("label", "\n/* There is no file for the display: the text goes to the terminal. */\nstatic void label(Text words, Whole x, Whole y, Whole size)\n{\n    (void)x, (void)y, (void)size;\n    puts(words.at);\n}"),
    ("rest", "\n/* Everything stops. */\nstatic void rest(void)\n{\n    writeWhole(\"stop\", \"\", \"\", 1);\n}"),
];
