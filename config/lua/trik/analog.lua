-- Analog sensors A1 to A6: ten bits of the MSP430 to what the sensor measures.
--
-- Owns the registers (they count down) and the sensor types. Results are not cut to their usual limits.
local number = include 'trik/number.lua'
local divide = number.divide

local BUS, ADDRESS = '/dev/i2c-2', 0x48
local GREATEST = 1023

-- Integer line through (r1, n1) and (r2, n2), cut towards zero.
local function line(r1, n1, r2, n2)
  return function(raw) return divide(n1 * (r2 - r1) + (raw - r1) * (n2 - n1), r2 - r1) end
end

-- Hyperbola through three points of distance and reading: scale / (raw + offset) + shift. All divisions cut towards
-- zero, as the runtime's do.
local function hyperbola(points)
  local x1, y1, x2, y2 = points[1][1], points[1][2], points[2][1], points[2][2]
  local x3, y3 = points[3][1], points[3][2]
  local divisor = x1 * y3 - x2 * y3 + x2 * y1 - x1 * y2 + x3 * y2 - x3 * y1
  if divisor == 0 or y1 == y2 then return nil end
  local offset = divide(
    -x1 * y1 * y3 - x3 * y2 * y3 + x3 * y1 * y3 + x1 * y1 * y2 + x2 * y2 * y3 - x2 * y1 * y2, divisor)
  local scale = divide((x1 - x2) * (y1 + offset) * (y2 + offset), y2 - y1)
  if y1 + offset == 0 then return nil end
  local shift = x1 - divide(scale, y1 + offset)
  return function(raw)
    if raw + offset == 0 then return 0 end
    return divide(scale, raw + offset) + shift
  end, scale
end

local POINTS = { { 25, 322 }, { 35, 235 }, { 15, 511 } }

local types = {
  generic = {
    format = 'i32 percent', units = '%', about = 'reading of analog port %s, 0 to 100',
    make = function() return line(0, 0, GREATEST, 100) end,
  },
  sharpGP2 = {
    format = 'i32 distance', units = 'cm', about = 'distance by the infrared sensor on %s, good from 8 to 80; 0 without a signal',
    make = function(entry)
      local convert = hyperbola(entry:points('points', 3, 3) or POINTS)
      if not convert then entry:refuse('points must be three points of a falling curve') end
      return convert
    end,
  },
  touch = {
    format = 'i32 touch', units = '', about = '1 while the touch sensor on %s is pressed, else 0',
    make = function() return line(100, 1, GREATEST, 0) end,
  },
  light = {
    format = 'i32 darkness', units = '%', about = 'darkness seen by the sensor on %s: about 0 white to 100 black',
    make = function() return line(30, 0, GREATEST, 100) end,
  },
}

local ports = {}
for index = 1, 6 do ports['A' .. index] = { register = 0x26 - index } end

-- The names of trikRuntime's model files mean the same.
local synonyms = { sharpGP2Sensor = 'sharpGP2', touchSensor = 'touch', lightSensor = 'light' }

local analog = { group = 'sensors', ports = ports, types = types, synonyms = synonyms, default = 'generic' }

-- The description of one analog sensor.
function analog.make(port, kind, entry)
  local sort = types[kind]
  local convert = sort.make(entry)
  local median = entry:boolean('median3', false)
  local src = i2c { path = BUS, address = ADDRESS, register = ports[port].register, transfer = 'word' }
  local function reading(a)
    local raw = ba.u16(a, 0)
    if raw > GREATEST then error('EIO: the coprocessor gave ' .. raw .. ', more than ten bits', 0) end
    return raw
  end
  local converter = function(a_s, a, b_s, b) ba.i32(b, 0, convert(reading(a))) end
  return {
    about = sort.about:format(port),
    src = src, format = sort.format, units = sort.units, poll_ms = 20, mode = 0444,
    converter = median and { { converter = converter, output_tuple_size = 4 }, filter.median3 {} } or converter,
    attributes = {
      raw = {
        about = 'reading of the port, 0 to 1023',
        src = src, format = 'i32 raw', mode = 0444,
        converter = function(a_s, a, b_s, b) ba.i32(b, 0, reading(a)) end,
      },
    },
  }
end

return analog
