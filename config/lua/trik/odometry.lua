-- Where a robot with two driven wheels is, from their encoders.
--
-- Owns the entry `odometry` of a robot file. The equations are those of the filter odometry in docs/converters/filters.md:
-- exact in straight lines and on circles. They stand here because a robot must come up without any library.
local Entry = include 'trik/entry.lua'
local encoders = include 'trik/encoders.lua'
local number = include 'trik/number.lua'
local sin, cos, pi = math.sin, math.cos, math.pi

-- As often as the encoders are sampled, whose newest samples are used: nothing more goes over the bus.
local PERIOD_MS = 20
-- No wheel turns so far between two samples: its counter jumped.
local JUMP_DEG = 3600

local odometry = { top = true, ports = { odometry = {} } }

local function wheel(entry, name)
  local port = entry:get(name)
  if not encoders.ports[port] then
    entry:refuse(name .. " must be the encoder of the " .. name .. " wheel: 'E1', 'E2', 'E3' or 'E4', not "
      .. Entry.shown(port))
  end
  return port
end

-- A converter from the degrees of both wheels to the place and direction.
local function integrator(diameter_mm, track_mm)
  local x, y, heading, left, right = 0, 0, 0, nil, nil
  local function way(before, now)
    local degrees = before and encoders.way(before, now, 1) or 0
    if degrees > JUMP_DEG or degrees < -JUMP_DEG then
      x, y, heading, left, right = 0, 0, 0, nil, nil
      error('ENODEV: an encoder jumped by ' .. degrees .. ' degrees: the place is lost and begins anew at 0 0', 0)
    end
    return degrees * pi * diameter_mm / 360
  end
  return function(a_s, a, b_s, b)
    local now_left, now_right = ba.i32(a, 0), ba.i32(a, 4)
    local of_left, of_right = way(left, now_left), way(right, now_right)
    left, right = now_left, now_right
    -- The chord of the arc, in the direction of its middle.
    local half = (of_right - of_left) / track_mm / 2
    local chord = (of_left + of_right) / 2 * (half == 0 and 1 or sin(half) / half)
    x, y = x + chord * cos(heading + half), y + chord * sin(heading + half)
    heading = heading + 2 * half
    heading = heading - 2 * pi * math.floor((heading + pi) / (2 * pi))
    -- To a tenth of a millimetre and a hundredth of a degree: more digits would be those of the arithmetic. The sum
    -- takes the sign from a zero.
    ba.f32(b, 0, (number.round(10 * x, 1) + 0) / 10)
    ba.f32(b, 4, (number.round(10 * y, 1) + 0) / 10)
    ba.f32(b, 8, (number.round(heading * 18000 / pi, 1) + 0) / 100)
  end
end

-- The node; absent unless the robot file names it.
function odometry.make(_, entry, listed)
  local about = 'place from the encoders: x ahead and y to the left of where it began, in mm, and heading to the left in degrees'
  if not listed then
    local reason = "the robot file does not say how large the wheels are: add { port = 'odometry', ... }"
    return { odometry = { about = about, src = absent { reason = reason }, input_tuple_size = 1, mode = 0444 } }
  end
  local left, right = wheel(entry, 'left'), wheel(entry, 'right')
  if left == right then entry:refuse("left and right are the same encoder, '" .. left .. "'") end
  local diameter_mm = entry:number_of('wheel_diameter_mm', nil, 1, 1000)
  return {
    odometry = {
      about = about, src = { 'newest:encoders/' .. left, 'newest:encoders/' .. right }, poll_ms = PERIOD_MS, always = true,
      format = 'f32 x, f32 y, f32 heading', mode = 0444,
      converter = integrator(diameter_mm, entry:number_of('track_mm', nil, 1, 10000)),
    },
  }
end

return odometry
