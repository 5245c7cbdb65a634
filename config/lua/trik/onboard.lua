-- What every controller has on its board: battery, keys, LEDs, loudspeaker.
--
-- Owns their names and scales. None of them is plugged in, so a robot file need not name them.
local number = include 'trik/number.lua'
local text = include 'trik/text.lua'

local onboard = { top = true, ports = { battery = {}, keys = {}, led = {}, sound = {} } }

-- Ten bits of 3.3 V behind a divider of 7.15 and 2.37 kOhm.
local function battery()
  local src = i2c { path = '/dev/i2c-2', address = 0x48, register = 0x26, transfer = 'word' }
  local function reading(a)
    local raw = ba.u16(a, 0)
    if raw > 1023 then error('EIO: the coprocessor gave ' .. raw .. ', more than ten bits', 0) end
    return raw
  end
  return {
    about = 'voltage of the battery; ENODEV below 1 V, because then there is none',
    src = src, format = 'f64 voltage', units = 'V', poll_ms = 1000, timeout_ms = 3000, mode = 0444,
    converter = function(a_s, a, b_s, b)
      local mv = number.round(reading(a) * 3300 * 952, 1023 * 237)
      if mv < 1000 then error('ENODEV: no battery: ' .. mv .. ' mV', 0) end
      ba.f64(b, 0, mv / 1000)
    end,
    attributes = {
      raw = {
        about = 'reading of the converter, 0 to 1023',
        src = src, format = 'i32 raw', mode = 0444,
        converter = function(a_s, a, b_s, b) ba.i32(b, 0, reading(a)) end,
      },
      cells = {
        about = 'cells in series that the board is set to: 2 or 3',
        src = gpio { number = 56, direction = 'in' }, format = 'i32 cells',
        converter = function(a_s, a, b_s, b) ba.i32(b, 0, 2 + ba.get(a, 0)) end,
      },
    },
  }
end

local KEYS = { 'POWER', 'UP', 'ESC', 'LEFT', 'RIGHT', 'DOWN', 'ENTER' }

local function keys()
  local codes, fields = {}, {}
  for index, key in ipairs(KEYS) do
    codes[index], fields[index] = 'KEY_' .. key, 'i32 ' .. key:lower()
  end
  return {
    about = 'the keys of the controller, 1 while pressed: ' .. table.concat(KEYS, ', '):lower(),
    src = evdev { path = '/dev/input/by-path/platform-soc@1c00000:gpio-keys-event', axes = codes },
    format = table.concat(fields, ', '), on_event = true,
    -- The kernel says 2 for a key that is held down.
    converter = function(a_s, a, b_s, b)
      for at = 0, b_s - 4, 4 do ba.i32(b, at, ba.i32(a, at) ~= 0 and 1 or 0) end
    end,
  }
end

-- A file of sysfs with one whole number.
local function attribute_number(path, format, about, greatest)
  return {
    about = about, src = attribute { path = path }, input_tuple_size = 64, format = format,
    converter = function(a_s, a, b_s, b)
      local text = ba.text(a)
      local value = tonumber(text:match('^%s*(%d+)'))
      if not value or value > 2147483647 then error("EIO: '" .. text:sub(1, 20) .. "' is no number", 0) end
      ba.i32(b, 0, value)
    end,
    write_converter = function(a_s, a, b_s, b)
      local value = number.within(format:match('%S+$'), ba.i32(a, 0), 0, greatest)
      local text = ('%d\n'):format(value)
      for at = 1, #text do ba.set(b, at - 1, text:byte(at)) end
    end,
  }
end

local function led()
  local nodes = {}
  for _, colour in ipairs { 'green', 'red' } do
    nodes[colour] = attribute_number(
      '/sys/class/leds/led_' .. colour .. '/brightness', 'i32 brightness',
      'the ' .. colour .. ' light: 1 on, 0 off; green and red together are orange', 1)
  end
  return nodes
end

-- Numbers become the text that the program takes.
local function tone()
  return {
    about = 'a tone of 20 to 7000 Hz for 1 to 10000 ms; one after the other, and at most 8 wait',
    src = program { run = { '/usr/lib/trikfs/tone' } }, input_tuple_size = 32,
    format = 'i32 frequency_hz, i32 duration_ms',
    converter = function() return false end,
    write_converter = function(a_s, a, b_s, b)
      local frequency = number.within('frequency_hz', ba.i32(a, 0), 20, 7000)
      text.put(b, frequency .. ' ' .. number.within('duration_ms', ba.i32(a, 4), 1, 10000))
    end,
  }
end

-- Bytes of a spoken text.
local SPOKEN = 400

-- The script of the system gives its text on to a program of speech, which takes words that begin with '-' for options, as
-- it takes negative numbers then; what begins with a blank is none, and sounds the same.
local function say()
  return {
    about = 'a text to be spoken; one after the other, and at most 8 wait',
    src = program { run = { '/etc/trik/say' } }, format = 'text ' .. SPOKEN, input_tuple_size = SPOKEN + 1,
    converter = function() return false end,
    write_converter = function(a_s, a, b_s, b)
      local words = ba.text(a)
      text.put(b, words:sub(1, 1) == '-' and ' ' .. words or words)
    end,
  }
end

local function sound()
  return {
    tone = tone(),
    volume = attribute_number('/sys/bus/i2c/devices/2-0050/volume', 'i32 volume', 'loudness of the loudspeaker, 0 to 20', 20),
    say = say(),
    play = {
      about = 'path of a sound file (WAV) to be played; one after the other, and at most 8 wait',
      src = program { run = { '/usr/bin/aplay', '--quiet' } }, format = 'text 400',
    },
  }
end

local makers = { battery = battery, keys = keys, led = led, sound = sound }

-- The nodes of one device, by their names at the top.
function onboard.make(port)
  return { [port] = makers[port]() }
end

return onboard
