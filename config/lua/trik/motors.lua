-- Power motors M1 to M4: percent to the duty registers of the MSP430, linear in speed.
--
-- Owns the tables of the motor types and the signs of the ports. Facts: the motor section of the MSP430's register map
-- as trikRuntime uses it. The firmware reports nothing back: reading gives what was written last, and the least power with
-- the duty that was sent when that is not known.
local number = include 'trik/number.lua'
local divide = number.divide

local BUS, ADDRESS = '/dev/i2c-2', 0x48
-- What the duty register takes for "brake".
local BRAKE = 127

-- measures: points of duty in percent and speed in any unit; period: what the period register gets.
local types = {
  powerMotor = { period = 4096, measures = { { 0, 0 }, { 100, 100 } } },
  motor95 = { period = 4096, measures = { { 0, 0 }, { 5, 7 }, { 20, 1352 }, { 40, 1996 }, { 100, 2400 } } },
  motor100 = { period = 4096, measures = { { 0, 0 }, { 5, 30 }, { 20, 1700 }, { 40, 2335 }, { 100, 2650 } } },
  motor350 = {
    period = 10000,
    measures = { { 0, 0 }, { 9, 10 }, { 10, 1331 }, { 15, 2601 }, { 30, 4127 }, { 65, 5110 }, { 100, 5443 } },
  },
}

-- Ports: the duty register (the period register is 4 below it), and whether the duty keeps its sign.
local ports = {
  M1 = { register = 0x14, plain = true },
  M2 = { register = 0x15 },
  M3 = { register = 0x16 },
  M4 = { register = 0x17 },
}

-- Gives a function that gives the list of the duty for 0 to 100 percent of the greatest speed. The list is made when
-- it is first asked for, because most open files never do.
local function linearised(measures)
  local list
  return function()
    if list then return list end
    list = {}
    local greatest, segment = measures[#measures][2], 1
    for percent = 0, 99 do
      while percent * greatest >= 100 * measures[segment + 1][2] do segment = segment + 1 end
      local from, to = measures[segment], measures[segment + 1]
      local span = 100 * (to[2] - from[2])
      list[percent] = divide(from[1] * span + (to[1] - from[1]) * (percent * greatest - 100 * from[2]), span)
    end
    list[100] = 100
    return list
  end
end

local motors = { group = 'motors', ports = ports, types = types, default = 'motor100' }

-- Checks the points of a motor that somebody measured.
local function measured(entry, default)
  local measures = entry:points('measures', 2, 32)
  if not measures then return default end
  local last = measures[#measures]
  if measures[1][1] ~= 0 or measures[1][2] ~= 0 or last[1] ~= 100 then
    entry:refuse('measures must begin with {0, 0} and end with {100, SPEED}')
  end
  for index = 2, #measures do
    if measures[index][2] <= measures[index - 1][2] or measures[index][1] < measures[index - 1][1] then
      entry:refuse('measures must rise from point to point')
    end
  end
  return measures
end

-- The description of one motor.
function motors.make(port, kind, entry)
  local register = ports[port].register
  local table_of = linearised(measured(entry, types[kind].measures))
  local inversed = entry:word('polarity', 'normal', { 'normal', 'inversed' }) == 'inversed'
  local sign = (ports[port].plain and 1 or -1) * (inversed and -1 or 1)
  local src = i2c { path = BUS, address = ADDRESS, register = register, transfer = 'byte', readable = false }
  return {
    about = 'power of motor ' .. port .. ': -100 to 100, 0 lets it run out, 127 brakes; reads what was written last, after anything else the least power with the duty',
    src = src, format = 'i32 duty_cycle', units = '%', rest = 0, read_back = true,
    converter = function(a_s, a, b_s, b)
      local duty = ba.i8(a, 0)
      if duty < -100 or duty > 100 then return ba.i32(b, 0, BRAKE) end
      local list, wanted, percent = table_of(), duty < 0 and -duty or duty, 0
      while list[percent] < wanted do percent = percent + 1 end
      ba.i32(b, 0, (duty < 0 and -percent or percent) * sign)
    end,
    write_converter = function(a_s, a, b_s, b)
      local percent = ba.i32(a, 0)
      if percent == BRAKE then return ba.i8(b, 0, BRAKE) end
      number.within('duty_cycle', percent, -100, 100)
      local duty = table_of()[percent < 0 and -percent or percent]
      ba.i8(b, 0, (percent < 0 and -duty or duty) * sign)
    end,
    attributes = {
      brake = {
        about = '1 brakes, 0 lets the motor run out; reads 1 while it brakes',
        src = src, format = 'i32 brake',
        converter = function(a_s, a, b_s, b)
          local duty = ba.i8(a, 0)
          ba.i32(b, 0, (duty < -100 or duty > 100) and 1 or 0)
        end,
        write_converter = function(a_s, a, b_s, b)
          ba.i8(b, 0, number.within('brake', ba.i32(a, 0), 0, 1) * BRAKE)
        end,
      },
      raw = {
        about = 'what the duty register of the motor has, after linearisation and sign',
        src = src, format = 'i8 duty', mode = 0444,
      },
    },
  }
end

-- What is done once at the start: the period of the motor's pulses.
function motors.setup(port, kind)
  local period = types[kind].period
  return {
    to = i2c { path = BUS, address = ADDRESS, register = ports[port].register - 4, transfer = 'word' },
    write = string.char(period % 256, (period - period % 256) / 256),
  }
end

return motors
