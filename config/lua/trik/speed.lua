-- The file `speed` of a motor whose entry names its encoder: what is written is held, whatever battery and load do.
--
-- Owns the options `encoder` and `speed_max`, the control law, and what ends it. The law is the shipped filter speed_hold
-- in tenths of degrees; in front of it stands the range, behind it what no motor does that is well. A law that fails
-- brings the motor to rest.
local Entry = include 'trik/entry.lua'
local number = include 'trik/number.lua'
local encoders = include 'trik/encoders.lua'
local abs = math.abs

-- Between two steps; each takes one transfer on the bus to read the encoder and one to drive the motor.
local PERIOD_MS = 20
-- Of a motor for which the robot file says nothing, in deg/s.
local SPEED_MAX = 1200
-- Time constant of the measured speed: one tick of an encoder more in a step are 32 deg/s.
local SMOOTH_S = 0.06
-- Percent of power for each deg/s that is missing, and for each degree.
local KP, KI = 0.05, 0.2
-- Beyond this the counts are no angles.
local JUMP_DPS = 200000
-- An encoder that turned by less than the first while the second was ordered is dead, or its wheel is stuck.
local STILL_DEG, ORDERED_DEG = 2, 180
-- So long may a wheel turn against so much power without slowing down.
local AGAINST_US, AGAINST_POWER = 200000, 50

-- A converter from ticks and the time since the ones before, in us, to the speed.
local function measured(scale, sign)
  local before, dps = nil, 0
  return function(a_s, a, b_s, b)
    local ticks, seconds = ba.i32(a, 0), ba.u32(a, 4) / 1e6
    local way = before and encoders.way(before, ticks, scale.ticks / scale.degrees) or 0
    before = ticks
    if seconds == 0 then return false end
    local now_dps = sign * way * scale.degrees / scale.ticks / seconds
    if abs(now_dps) > JUMP_DPS then
      dps = 0
      error('ENODEV: the encoder jumped by ' .. way .. ' ticks', 0)
    end
    dps = dps + (now_dps - dps) * (seconds / (SMOOTH_S + seconds))
    ba.i32(b, 0, number.round(dps, 1))
  end
end

-- A chain from the ordered speed, the measured one and the time since the step before to the power in percent.
local function law(speed_max)
  local since_us, us, turned, anchor, ordered, against_us, size_before = 0, 0, 0, 0, 0, 0, 0
  local function prepare(a_s, a, b_s, b)
    local wanted, dps = number.within('speed', ba.i32(a, 0), -speed_max, speed_max), ba.i32(a, 4)
    since_us = ba.u32(a, 8)
    us = (us + since_us) % 2 ^ 32
    turned = turned + dps * since_us / 1e6
    ordered = ordered + abs(wanted) * since_us / 1e6
    if wanted == 0 or abs(turned - anchor) > STILL_DEG then anchor, ordered = turned, 0 end
    if ordered > ORDERED_DEG then
      error('ENODEV: the encoder stands still while half a turn was ordered: it is unplugged, or the wheel is stuck', 0)
    end
    ba.i32(b, 0, 10 * wanted)
    ba.i32(b, 4, (number.round(10 * turned, 1) + 2 ^ 31) % 2 ^ 32 - 2 ^ 31)
    ba.u32(b, 8, us)
  end
  local function judge(a_s, a, b_s, b)
    local power, tenths = ba.i32(a, 0), ba.i32(a, 4)
    if ba.i32(a, 8) == 1 then error('ENODEV: the wheel does not turn with full power', 0) end
    local size = abs(tenths)
    if power * tenths >= 0 or abs(power) < AGAINST_POWER then
      against_us = 0
    elseif size >= size_before then
      against_us = against_us + since_us
    end
    size_before = size
    if against_us > AGAINST_US then
      error('ENODEV: the encoder counts against the power: change the polarity of the motor or of the encoder', 0)
    end
    ba.i32(b, 0, power)
  end
  return {
    { converter = prepare, output_tuple_size = 12 },
    filter.speed_hold { kf = 10 / speed_max, kp = KP / 10, ki = KI / 10, speed_ms = 0, speed_max = 10 * JUMP_DPS },
    judge,
  }
end

local function description(port, encoder, speed_max, scale, sign)
  return {
    about = 'speed of motor ' .. port .. ' that encoder ' .. encoder .. ' measures; what is written, -' .. speed_max
      .. ' to ' .. speed_max .. ', is held, and 0 lets it run out',
    src = regulator { feedback = 'trikfs:encoders/' .. encoder .. '/raw', actuator = 'trikfs:motors/' .. port },
    format = 'i32 speed', units = 'deg/s', poll_ms = PERIOD_MS,
    converter = measured(scale, sign), write_converter = law(speed_max),
  }
end

local speed = {}

-- Gives each motor whose entry names an encoder its file. `motors` is the group, `entries` has the entries of all ports,
-- type_of(port, entry) gives the type of an encoder.
function speed.add(motors, entries, type_of)
  local taken = {}
  for index = 1, 4 do
    local port = 'M' .. index
    local entry = entries[port]
    local encoder = entry and entry:get('encoder')
    local speed_max = entry and entry:whole('speed_max', SPEED_MAX, 1, 100000)
    if encoder ~= nil then
      if not encoders.ports[encoder] then
        entry:refuse("encoder must be 'E1', 'E2', 'E3' or 'E4', not " .. Entry.shown(encoder))
      end
      if taken[encoder] then
        entry:refuse("encoder '" .. encoder .. "' measures motor " .. taken[encoder] .. ' already')
      end
      taken[encoder] = port
      local other = entries[encoder] or Entry.new({ port = encoder }, 0)
      local scale, sign = encoders.scale(encoder, type_of(encoder, other), other)
      motors[port].attributes.speed = description(port, encoder, speed_max, scale, sign)
    elseif entry and entry.given.speed_max ~= nil then
      entry:refuse("speed_max is for a motor with an encoder: name it, for example encoder = 'E1'")
    end
  end
end

return speed
