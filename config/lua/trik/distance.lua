-- Ultrasonic distance sensors HC-SR04 on D1 to D3: input events of the kernel driver.
--
-- Owns the device names. The driver measures only while its device is open, and tells of changes only.
local ports = {
  D1 = { path = '/dev/input/by-path/platform-trik_jd1-event' },
  D2 = { path = '/dev/input/by-path/platform-trik_jd2-event' },
  D3 = { path = '/dev/input/by-path/platform-trik_jf1-event' },
}

local distance = { group = 'sensors', ports = ports, types = { ultrasonic = {} }, default = 'ultrasonic' }

-- The description of one sensor.
function distance.make(port, _, entry)
  local median = entry:boolean('median3', true)
  -- The driver cannot tell a port without a sensor; a robot file that names the port says that there is one.
  local silence = 'ETIMEDOUT: no echo: nothing in reach'
    .. (entry.number == 0 and ', or nothing is plugged into ' .. port or '')
  local echo = {
    output_tuple_size = 4,
    converter = function(a_s, a, b_s, b)
      local cm = ba.i32(a, 0)
      if cm < 0 then error(silence, 0) end
      -- What the kernel has before the first measurement; the least that the sensor can measure is 2.
      if cm == 0 then error('ETIMEDOUT: not measured yet', 0) end
      ba.i32(b, 0, cm)
    end,
  }
  return {
    about = 'distance by the ultrasonic sensor on ' .. port .. ', up to 400; an error if there is no echo',
    src = 'trikfs:sensors/' .. port .. '/raw',
    format = 'i32 distance', units = 'cm', on_event = true,
    converter = median and { echo, filter.median3 {} } or { echo },
    attributes = {
      raw = {
        about = 'as the driver tells it: distance in cm, -1 without an echo, and the time of the echo in us',
        src = evdev { path = ports[port].path, axes = { 'ABS_DISTANCE', 'ABS_MISC' } },
        -- Telling of changes only, the driver may have said long ago what there is to read now.
        format = 'i32 distance, i32 echo_us', on_event = true,
      },
    },
  }
end

return distance
