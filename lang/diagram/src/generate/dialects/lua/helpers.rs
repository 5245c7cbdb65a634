//! Helpers of programs in Lua: what operators of the language do not do, and what each reading and command means for
//! the tree.
//!
//! Owns paths of the tree, as docs/user/trik.md has them.

/// Helpers in Lua; later ones may use earlier ones.
pub(super) const HELPERS: &[(&str, &str)] = &[
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
        "startThread joinThread killThread sendMessage receiveMessage runThreads",
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
-- Who was killed goes no further.
local function mayEnd()
  if current and current.ended then coroutine.yield(0) end
end
function startThread(name, run)
  local thread = { name = name, run = coroutine.create(run), mail = {} }
  threads[#threads + 1] = thread
  step(thread)
  mayEnd()
end
function joinThread(name)
  while find(name) do wait(10) end
end
function killThread(name)
  local thread = find(name)
  if thread then thread.ended = true end
  mayEnd()
end
function sendMessage(name, text)
  local thread = find(name)
  if thread then
    table.insert(thread.mail, text)
    -- The thread that waited for it goes first.
    if thread.receives then step(thread) end
  end
  mayEnd()
end
function receiveMessage(waits)
  while waits and #current.mail == 0 do
    current.receives = true
    coroutine.yield(math.huge)
    current.receives = false
  end
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
    local rest = math.min(first.due - milliseconds(), 1000)
    if rest > 0 then sleep(rest) end
    if first.due ~= math.huge then step(first) end
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
-- A text as a display shows it: numbers with at most six digits after the point.
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
-- Whether a loop goes on. Its counter lives as long as the program: leaving part-way does not reset it.
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
    ("label", "\n-- Nothing is drawn: the text goes to the terminal.\nfunction label(text, x, y, size)\n  print(text)\nend"),
    ("rest", "\n-- Everything stops.\nfunction rest()\n  writeFile(\"stop\", 1)\nend"),
];
