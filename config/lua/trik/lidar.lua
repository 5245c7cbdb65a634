-- Lidar Delta2A on the serial port: packets of one sixteenth of a turn to 360 distances.
--
-- Owns the layout of a packet between its length and its checksum, which the source has seen to. Big-endian.
local lidar = { top = true, ports = { lidar = {} } }

local PACKET_BYTES, HEAD_BYTES = 1024, 13
-- How often packets are looked for, and without a whole turn for how long there is no picture any more: the line itself
-- does not tell that the lidar is unplugged.
local PERIOD_MS, TIMEOUT_MS = 50, 3000

-- The mean of the distances of one degree, without the least and the greatest when there are more than two.
local function mean(sum, count, least, greatest)
  if count > 2 then sum, count = sum - least - greatest, count - 2 end
  return math.floor(sum / count)
end

local function converter()
  local sum, count, least, greatest = {}, {}, {}, {}
  local before, whole = nil, false
  local function clear()
    for degree = 0, 359 do sum[degree], count[degree], least[degree], greatest[degree] = 0, 0, 65535, 0 end
  end
  clear()
  local function add(a, start)
    local probes = math.floor((ba.u16_be(a, 6) - 5) / 3)
    if probes < 0 or HEAD_BYTES + 3 * probes + 2 > ba.u16_be(a, 1) + 2 then error('EIO: the packet contradicts itself', 0) end
    for probe = 0, probes - 1 do
      local quarters = ba.u16_be(a, HEAD_BYTES + 3 * probe + 1)
      if quarters > 0 then
        local degree = math.floor((start + 2250 * probe / probes) / 100) % 360
        local mm = quarters / 4
        sum[degree], count[degree] = sum[degree] + mm, count[degree] + 1
        if mm < least[degree] then least[degree] = mm end
        if mm > greatest[degree] then greatest[degree] = mm end
      end
    end
  end
  return function(a_s, a, b_s, b)
    -- Other packets tell of the state of the motor.
    if ba.get(a, 4) ~= 0x61 or ba.get(a, 5) ~= 0xAD then return false end
    local start = ba.u16_be(a, 11)
    if start >= 36000 then error('EIO: the packet begins at ' .. start / 100 .. ' degrees', 0) end
    local turned = before ~= nil and start < before
    local ready = turned and whole
    if ready then
      for degree = 0, 359 do
        local n = count[degree]
        ba.u16(b, 2 * degree, n > 0 and mean(sum[degree], n, least[degree], greatest[degree]) or 0)
      end
    end
    if turned then
      clear()
      whole = true
    end
    before = start
    add(a, start)
    return ready
  end
end

-- The node of the lidar; absent unless the robot file names it.
function lidar.make(_, entry, listed)
  local about = 'distance in each direction, from 0 to 359 degrees; 0 where nothing came back'
  if not listed then
    return {
      lidar = {
        about = about, units = 'mm', input_tuple_size = 1,
        src = absent { reason = "there is no lidar in the robot file: add { port = 'lidar' }" },
      },
    }
  end
  local fields = {}
  for degree = 0, 359 do fields[degree + 1] = 'u16 d' .. degree end
  return {
    lidar = {
      about = about, units = 'mm', poll_ms = PERIOD_MS, timeout_ms = TIMEOUT_MS, budget_us = 100000,
      src = packets {
        path = entry:path('path', '/dev/ttyS1'), baud = 230400, start = '\170',
        length = { at = 1, bytes = 2, add = 2 }, order = 'big', checksum = 'sum16',
      },
      input_tuple_size = PACKET_BYTES, format = table.concat(fields, ', '), converter = converter(),
    },
  }
end

return lidar
