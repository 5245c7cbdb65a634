-- Servos S1 to S6: degrees or percent to the width of pulses of the processor's PWM channels. S1 to S3 can measure
-- pulses instead.
--
-- Owns the channels of the ports and the widths of the servo types. No pulses means no power.
local number = include 'trik/number.lua'

local PERIOD_NS = 20000000
-- The number that switches a servo off, for `rest`; no position is like it.
local OFF = -2147483648

-- Widths of the pulses in ns, and the numbers that mean the least and the greatest.
local types = {
  angularServomotor = { min = 700000, zero = 1425000, max = 2150000, least = -90, greatest = 90, units = 'deg' },
  continuousRotationServomotor = {
    min = 700000, zero = 1500000, max = 2300000, least = -100, greatest = 100, units = '%',
  },
  manipulatorServomotor = { min = 530000, zero = 1415000, max = 2300000, least = 0, greatest = 100, units = '%' },
  quadroMotor = { min = 1160000, zero = 1580000, max = 2000000, least = 0, greatest = 100, units = '%' },
  pwmCapture = { captures = true },
  quadroEsc = { min = 1100000, zero = 1500000, max = 1900000, least = 0, greatest = 100, units = '%' },
}

local ports = {
  S1 = { chip = 2, channel = 0, capture = '/sys/class/pwm/ecap_cap.2/' },
  S2 = { chip = 1, channel = 0, capture = '/sys/class/pwm/ecap_cap.1/' },
  S3 = { chip = 0, channel = 0, capture = '/sys/class/pwm/ecap_cap.0/' },
  S4 = { chip = 3, channel = 1 },
  S5 = { chip = 5, channel = 0 },
  S6 = { chip = 5, channel = 1 },
}

local servos = { group = 'servos', ports = ports, types = types, default = 'angularServomotor' }

-- The driver waits so long for pulses, and one channel for the other.
local CAPTURE_MS = 31000

-- A text of the driver with whole numbers between commas, -1 if no pulse came.
local function captured(path, count, about, format, units, make)
  return {
    about = about, src = attribute { path = path }, input_tuple_size = 64, format = format, units = units,
    timeout_ms = CAPTURE_MS, mode = 0444,
    converter = function(a_s, a, b_s, b)
      local text, numbers = ba.text(a):match('^[^\n]*'), {}
      for part in (text .. ','):gmatch('([^,]*),') do
        if not part:find('^ *-?%d+ *$') or #part > 11 then error("EIO: '" .. text:sub(1, 40) .. "' is no measurement", 0) end
        numbers[#numbers + 1] = tonumber(part)
      end
      if #numbers ~= count then error("EIO: '" .. text:sub(1, 40) .. "' is no measurement", 0) end
      for _, value in ipairs(numbers) do
        if value < 0 then error('ETIMEDOUT: no pulses', 0) end
        if value > 2147483647 then error('EIO: ' .. value .. ' is no measurement', 0) end
      end
      make(b, numbers)
    end,
  }
end

-- The description of a port that measures pulses.
local function capture(port, entry)
  local folder = ports[port].capture
  if not folder then entry:refuse('only S1, S2 and S3 can measure pulses') end
  local node = captured(folder .. 'freq', 3, 'frequency of the pulses that come into ' .. port
    .. ', the middle one of three periods; an error without pulses', 'i32 frequency', 'Hz',
    function(b, numbers)
      table.sort(numbers)
      ba.i32(b, 0, numbers[2])
    end)
  node.attributes = {
    duty_cycle = captured(folder .. 'duty_percentage', 1, 'how much of a period the pulse lasts', 'i32 duty_cycle', '%',
      function(b, numbers) ba.i32(b, 0, numbers[1]) end),
    raw = captured(folder .. 'freq', 3, 'frequencies of three periods after each other',
      'i32 first, i32 second, i32 third', 'Hz',
      function(b, numbers)
        for index = 1, 3 do ba.i32(b, 4 * (index - 1), numbers[index]) end
      end),
  }
  return node
end

-- What is done once at the start: a port that measures takes its pin from the servo.
function servos.setup(port, kind)
  if types[kind].captures then return { path = ports[port].capture .. 'capture', write = '1' } end
end

-- The description of one servo.
function servos.make(port, kind, entry)
  if types[kind].captures then return capture(port, entry) end
  local sort, place = types[kind], ports[port]
  local inversed = entry:word('polarity', 'normal', { 'normal', 'inversed' }) == 'inversed'
  local least, greatest = sort.least, sort.greatest
  local span, mean = greatest - least, (least + greatest) / 2
  local function mirrored(position) return inversed and 2 * mean - position or position end
  local src = pwm {
    chip = '/sys/class/pwm/pwmchip' .. place.chip, channel = place.channel, period_ns = PERIOD_NS,
  }
  local function width(position)
    local range = position <= mean and sort.zero - sort.min or sort.max - sort.zero
    return number.divide(sort.zero * span + (position - mean) * 2 * range, span)
  end
  return {
    about = 'position of the servo on ' .. port .. ', ' .. least .. ' to ' .. greatest .. '; an error while it is off',
    src = src, format = 'i32 position', units = sort.units, rest = OFF,
    converter = function(a_s, a, b_s, b)
      local duty = ba.u32(a, 0)
      if duty == 0 then error('EIO: the servo is off', 0) end
      local range = duty <= sort.zero and sort.zero - sort.min or sort.max - sort.zero
      ba.i32(b, 0, mirrored(mean + number.round((duty - sort.zero) * span, 2 * range)))
    end,
    write_converter = function(a_s, a, b_s, b)
      local position = ba.i32(a, 0)
      if position == OFF then return ba.i32(b, 0, 0) end
      number.within('position', position, least, greatest)
      ba.i32(b, 0, width(mirrored(position)))
    end,
    attributes = {
      power = {
        about = '0 switches the servo off; reads 1 while it is on',
        src = src, format = 'i32 power',
        converter = function(a_s, a, b_s, b) ba.i32(b, 0, ba.u32(a, 0) > 0 and 1 or 0) end,
        write_converter = function(a_s, a, b_s, b)
          if ba.i32(a, 0) ~= 0 then error('EINVAL: only 0 can be written; a position switches the servo on', 0) end
        end,
      },
      raw = {
        about = 'width of the pulses, 0 while the servo is off',
        src = src, format = 'u32 duty_cycle', units = 'ns', mode = 0444,
      },
    },
  }
end

return servos
