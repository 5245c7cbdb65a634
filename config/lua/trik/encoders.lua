-- Encoders E1 to E4: ticks of the MSP430 to degrees.
--
-- Owns the registers (E3 and E4 are not in order), the signs and the types. The runtime multiplies in 32 bits and
-- overflows; here everything is exact.
local number = include 'trik/number.lua'

local BUS, ADDRESS = '/dev/i2c-2', 0x48

-- So many ticks in so many degrees.
local types = {
  encoder95 = { ticks = 157, degrees = 100 },
  encoder126 = { ticks = 3296, degrees = 1000 },
}

-- Ports: the register, and whether the degrees keep the sign of the ticks.
local ports = {
  E1 = { register = 0x30 },
  E2 = { register = 0x31, plain = true },
  E3 = { register = 0x33 },
  E4 = { register = 0x32, plain = true },
}

-- A wheel that seems to have turned so far, and to be near 0 now, was set to 0.
local RESET_DEG, NEAR = 60, 4

local encoders = { group = 'encoders', ports = ports, types = types, default = 'encoder95' }

-- What makes degrees of ticks: so many ticks in so many degrees, and 1 or -1.
function encoders.scale(port, kind, entry)
  local inversed = entry:word('polarity', 'normal', { 'normal', 'inversed' }) == 'inversed'
  return types[kind], (ports[port].plain and 1 or -1) * (inversed and -1 or 1)
end

-- The way from one count to the next, for a counter of 32 bits of which `turn` make one degree. One that was set to 0 in
-- between counts from there.
function encoders.way(before, now, turn)
  local way = (now - before + 2 ^ 31) % 2 ^ 32 - 2 ^ 31
  if math.abs(way) > RESET_DEG * turn and math.abs(now) * NEAR < math.abs(way) then return now end
  return way
end

-- The encoders that the robot file names in any way, in order: nobody else knows whether one is plugged in.
function encoders.named(entries)
  local named, list = {}, {}
  for port, entry in pairs(entries) do
    local given = entry.given
    for _, encoder in pairs { port, given.encoder or port, given.left or port, given.right or port } do
      named[encoder] = true
    end
  end
  for index = 1, 4 do
    local port = 'E' .. index
    if named[port] then list[#list + 1] = port end
  end
  return list
end

-- The description of one encoder.
function encoders.make(port, kind, entry)
  local scale, sign = encoders.scale(port, kind, entry)
  local src = i2c {
    path = BUS, address = ADDRESS, register = ports[port].register, transfer = 'block', write_transfer = 'byte',
  }
  return {
    about = 'angle that encoder ' .. port .. ' has turned; writing 0 begins anew',
    src = src, input_tuple_size = 4, format = 'i32 position', units = 'deg', poll_ms = 20,
    converter = function(a_s, a, b_s, b)
      ba.i32(b, 0, sign * number.divide(ba.i32(a, 0) * scale.degrees, scale.ticks))
    end,
    write_converter = function(a_s, a, b_s, b)
      local position = ba.i32(a, 0)
      if position ~= 0 then error('EINVAL: an encoder can only be set to 0, not to ' .. position, 0) end
    end,
    attributes = {
      raw = {
        about = 'ticks of the encoder, with the sign of the device',
        src = src, input_tuple_size = 4, format = 'i32 ticks', mode = 0444,
      },
    },
  }
end

return encoders
