-- Gyroscope and accelerometer: samples of the IIO buffers to rates, tilt and heading.
--
-- Owns the calibration, which happens in every open file by itself: the files of newest values share one, made after the
-- start. The bias of the gyroscope is the mean while the robot stands still, and follows slowly whenever it seems to stand
-- still again; `heading` corrects the rest by the encoders, which tell a robot that creeps from one that stands.
-- Angles are integrated with a quaternion, one step for each sample, as trikRuntime does.
local number = include 'trik/number.lua'
local sin, cos, sqrt, pi = math.sin, math.cos, math.sqrt, math.pi

-- 8.75 mdps for one count at the full scale of 250 degrees in a second; 4096 counts for one g at 2 g.
local MDPS_NUMERATOR, MDPS_DIVISOR = 35, 4
local COUNTS_OF_G = 4096
-- Standing still: the readings of each axis stay within so many counts (3.5 dps), and their mean is what a chip may
-- show at rest (10 dps, the zero-rate level of the data sheet); after the first calibration the mean stays within so many
-- counts of the bias (0.5 dps).
local STILL_COUNTS, ZERO_RATE_COUNTS, DRIFT_COUNTS = 400, 1143, 57
-- The chips give a hundred samples in a second and more; one that gives none for so long is broken.
local MAX_AGE_MS = 1000
-- A robot that creeps looks the same, so the bias follows by no more than this in a second (0.5 dps in a minute): no chip
-- warms up faster (0.04 dps in a degree, by the data sheet), and a creep of some seconds does no harm.
local FOLLOW_COUNTS_PER_S = 1
-- A robot that sticks and slips turns unevenly, and less than an encoder sees: the means of the four quarters of 2 s differ
-- by no more than this (0.1 dps, four times the noise of the chip). Of shorter windows by more, as noise does.
local QUARTERS, STEADY_COUNTS, STEADY_WINDOW_MS = 4, 12, 2000
-- What the angle of a robot whose encoders stand still may turn by in a microsecond, in mdeg: as much as DRIFT_COUNTS.
local DRIFT_MDEG_PER_US = 0.0005
local MDEG_PER_US_OF_COUNT = MDPS_NUMERATOR / MDPS_DIVISOR / 1e6
-- After a longer pause between two samples nobody knows how far the robot has turned.
local GAP_US = 500000

local imu = { top = true, ports = { gyroscope = {}, accelerometer = {} } }

-- The axes of both chips as trikRuntime reports them. Tuple: position of the chip's name in the list, x, y, z, time.
local function axes(a)
  local x, y, z = ba.i32(a, 4), ba.i32(a, 8), ba.i32(a, 12)
  if ba.i32(a, 0) == 2 then return x, -y, z end
  return -y, -x, z
end

-- Microseconds from one time stamp in ns to the next; each is two halves, because together they are beyond 2^53.
local function elapsed_us(high, low, high_before, low_before)
  return ((high - high_before) * 4294967296 + (low - low_before)) / 1000
end

-- Watches whether something turns evenly through a window. Returns a function that takes how far it has come since the
-- window began, of which `weight` is the measure, and the time of the window; it gives the greatest difference between the
-- means of the quarters that are over. The first quarter begins with a weight of 0.
local function quarters(window_us)
  local done, from, weight_from, least, greatest = 0, 0, 0, nil, nil
  return function(way, weight, lasted_us)
    if lasted_us < (done + 1) * window_us / QUARTERS then return greatest and greatest - least or 0 end
    local mean = (way - from) / (weight - weight_from)
    least, greatest = math.min(least or mean, mean), math.max(greatest or mean, mean)
    done, from, weight_from = done + 1, way, weight
    return greatest - least
  end
end

local function steady_counts(window_us) return STEADY_COUNTS * sqrt(STEADY_WINDOW_MS * 1000 / window_us) end

-- Watches for the robot to stand still. Returns a function that takes one sample and gives the bias once there is one,
-- or nil; it fails each time that `window_ms` pass in movement before the first bias.
local function watch(window_ms, bias)
  local window_us = window_ms * 1000
  local uneven_most = steady_counts(window_us)
  local sum, low, high, parts, uneven, count, lasted_us = {}, {}, {}, {}, {}, 0, 0
  -- The bias after a window in which the robot stood still.
  local function follow(mean)
    if not bias then return mean end
    local most, followed = FOLLOW_COUNTS_PER_S * lasted_us / 1e6, {}
    for axis = 1, 3 do
      if uneven[axis] > uneven_most then return bias end
      followed[axis] = bias[axis] + math.max(-most, math.min(most, mean[axis] - bias[axis]))
    end
    return followed
  end
  return function(sample, us)
    lasted_us = lasted_us + us
    for axis = 1, 3 do
      local value = sample[axis]
      if count == 0 then sum[axis], low[axis], high[axis], parts[axis] = 0, value, value, quarters(window_us) end
      sum[axis] = sum[axis] + value
      if value < low[axis] then low[axis] = value end
      if value > high[axis] then high[axis] = value end
      uneven[axis] = parts[axis](sum[axis], count + 1, lasted_us)
    end
    count = count + 1
    if lasted_us < window_us then return bias end
    local still, mean = true, {}
    for axis = 1, 3 do
      mean[axis] = sum[axis] / count
      still = still and high[axis] - low[axis] <= STILL_COUNTS
      local distance = math.abs(mean[axis] - (bias and bias[axis] or 0))
      still = still and distance <= (bias and DRIFT_COUNTS or ZERO_RATE_COUNTS)
    end
    if still then bias = follow(mean) end
    count, lasted_us = 0, 0
    if not bias then error('EIO: not calibrated yet: let the robot stand still for ' .. window_ms .. ' ms', 0) end
    return bias
  end
end

-- Takes one tuple of the gyroscope: gives the microseconds since the one before, or nil if it is the same or the first.
local function clock()
  local high, low
  return function(a, pos)
    local now_high, now_low = ba.i32(a, pos + 4), ba.u32(a, pos)
    local before_high, before_low = high, low
    if now_high == before_high and now_low == before_low then return nil end
    high, low = now_high, now_low
    return before_high and elapsed_us(now_high, now_low, before_high, before_low)
  end
end

-- The rotation that takes a direction of gravity to straight up, as a unit quaternion w, x, y, z.
local function upright(x, y, z)
  local length = sqrt(x * x + y * y + z * z)
  if length == 0 then error('EIO: the accelerometer gives no gravity', 0) end
  x, y, z = x / length, y / length, z / length
  -- Half way between both directions: w = 1 + dot, the axis is the cross product.
  local w, qx, qy = 1 + z, y, -x
  if w < 1e-9 then w, qx, qy = 0, 1, 0 end
  local norm = sqrt(w * w + qx * qx + qy * qy)
  local flat = sqrt(x * x + y * y + (1 - z) * (1 - z)) < 0.2
  return { w / norm, qx / norm, qy / norm, 0 }, flat
end

-- Turns a quaternion by the three half angles of one step.
local function turn(q, hx, hy, hz)
  local c1, s1, c2, s2, c3, s3 = cos(hz), sin(hz), cos(hy), sin(hy), cos(hx), sin(hx)
  local dw, dx = c1 * c2 * c3 + s1 * s2 * s3, s1 * c2 * c3 - c1 * s2 * s3
  local dy, dz = c1 * s2 * c3 + s1 * c2 * s3, c1 * c2 * s3 - s1 * s2 * c3
  local w, x, y, z = q[1], q[2], q[3], q[4]
  local nw, nx = w * dw - x * dx - y * dy - z * dz, w * dx + x * dw + y * dz - z * dy
  local ny, nz = w * dy - x * dz + y * dw + z * dx, w * dz + x * dy - y * dx + z * dw
  local norm = sqrt(nw * nw + nx * nx + ny * ny + nz * nz)
  q[1], q[2], q[3], q[4] = nw / norm, nx / norm, ny / norm, nz / norm
end

-- The angles of a quaternion in radians: pitch, yaw, roll.
local function angles(q)
  local w, x, y, z = q[1], q[2], q[3], q[4]
  local s = -2 * (y * z - x * w)
  if s >= 1 or s <= -1 then
    local yaw = math.atan2(-2 * (x * y - z * w), 1 - 2 * (y * y + z * z))
    return s > 0 and pi / 2 or -pi / 2, s > 0 and yaw or -yaw, 0
  end
  return math.asin(s), math.atan2(2 * (x * z + y * w), 1 - 2 * (x * x + y * y)),
    math.atan2(2 * (x * y + z * w), 1 - 2 * (x * x + z * z))
end

local function mdeg(radians) return number.round(radians * 180000 / pi, 1) end

-- A function that takes tuples of both sensors, one after the other, and gives the quaternion after each sample of the
-- gyroscope; nil while there is none.
local function integrator(window_ms, bias_given)
  local since, calibrated = clock(), watch(window_ms, bias_given)
  local q, flat, gx, gy, gz, count = nil, nil, 0, 0, 0, 0
  return function(a)
    local us = since(a, 16)
    if not us then return nil end
    if us <= 0 or us > GAP_US then
      -- The bias is still that of the chip; only the angles are lost.
      q, gx, gy, gz, count = nil, 0, 0, 0, 0
      local what = us > 0 and 'no samples for ' .. number.round(us, 1000) .. ' ms' or 'the time of the samples went back'
      error('EIO: ' .. what .. ': the angles begin anew', 0)
    end
    local x, y, z = axes(a)
    local bias = calibrated({ x, y, z }, us)
    if not q then
      gx, gy, gz, count = gx + ba.i32(a, 24), gy + ba.i32(a, 28), gz + ba.i32(a, 32), count + 1
      if not bias then return nil end
      q, flat = upright(gx / count, gy / count, gz / count)
    end
    local half = us * MDPS_NUMERATOR / MDPS_DIVISOR * pi / (180 * 1000 * 1e6 * 2)
    local hx, hy, hz = (x - bias[1]) * half, (y - bias[2]) * half, (z - bias[3]) * half
    if flat then hx, hz = hz, hx end
    turn(q, hx, hy, hz)
    return q
  end
end

local function calibration_ms(entry) return entry:whole('calibration_ms', 2000, 100, 60000) end

local function gyroscope(entry)
  local window_ms = calibration_ms(entry)
  local bias = entry:numbers('bias', 3, -32768, 32767)
  local timeout_ms = window_ms + 3000
  local since, calibrated = clock(), watch(window_ms, bias)
  local both = { 'trikfs:gyroscope/raw', 'trikfs:accelerometer/raw' }
  local tilt, heading = integrator(window_ms, bias), integrator(window_ms, bias)
  return {
    about = 'angular rates around x, y and z without the bias; the robot stands still for the first '
      .. window_ms .. ' ms',
    src = 'trikfs:gyroscope/raw', format = 'i32 x, i32 y, i32 z', units = 'mdeg/s', on_event = true, max_age_ms = MAX_AGE_MS,
    timeout_ms = timeout_ms,
    converter = function(a_s, a, b_s, b)
      local us = since(a, 16)
      if not us then return false end
      local sample = { axes(a) }
      local offset = calibrated(sample, us)
      if not offset then return false end
      for axis = 1, 3 do
        ba.i32(b, 4 * (axis - 1), number.round((sample[axis] - offset[axis]) * MDPS_NUMERATOR, MDPS_DIVISOR))
      end
    end,
    attributes = {
      raw = {
        about = 'the chip (1 L3GD20, 2 L3GD20H), its own x, y and z in counts of 8.75 mdeg/s, and the time in ns',
        src = iio {
          name = { 'l3gd20', 'l3gd20h' }, channels = { 'anglvel_x', 'anglvel_y', 'anglvel_z', 'timestamp' },
        },
        format = 'i32 chip, i32 x, i32 y, i32 z, i64 time',
      },
      heading = {
        about = 'angle around the vertical axis since the calibration, -180000 to 180000',
        src = both, format = 'i32 heading', units = 'mdeg', on_event = true, max_age_ms = MAX_AGE_MS, timeout_ms = timeout_ms,
        converter = function(a_s, a, b_s, b)
          local q = heading(a)
          if not q then return false end
          local _, _, roll = angles(q)
          ba.i32(b, 0, -mdeg(roll))
        end,
      },
      tilt = {
        about = 'angles around x and y against the vertical',
        src = both, format = 'i32 x, i32 y', units = 'mdeg', on_event = true, max_age_ms = MAX_AGE_MS, timeout_ms = timeout_ms,
        converter = function(a_s, a, b_s, b)
          local q = tilt(a)
          if not q then return false end
          local pitch, yaw = angles(q)
          ba.i32(b, 0, mdeg(pitch))
          ba.i32(b, 4, mdeg(yaw))
        end,
      },
    },
  }
end

local function accelerometer()
  return {
    about = 'acceleration along x, y and z; at rest 1000 upwards',
    src = 'trikfs:accelerometer/raw', format = 'i32 x, i32 y, i32 z', units = 'mg', on_event = true, max_age_ms = MAX_AGE_MS,
    converter = function(a_s, a, b_s, b)
      for at = 0, 8, 4 do ba.i32(b, at, number.round(ba.i32(a, at) * 1000, COUNTS_OF_G)) end
    end,
    attributes = {
      raw = {
        about = 'x, y and z in counts, 4096 for one g, and the time in ns',
        src = iio { name = 'mma8451', channels = { 'accel_x', 'accel_y', 'accel_z', 'timestamp' } },
        format = 'i32 x, i32 y, i32 z, i64 time',
      },
    },
  }
end

local HEADING_ABOUT = 'direction of the robot since the start, -180 to 180: grows to the left, seen from above'

-- The direction of the robot: the newest angle of the gyroscope, in degrees and counted as in geometry.
local function heading(timeout_ms)
  return {
    about = HEADING_ABOUT, src = { 'newest:gyroscope/heading' }, format = 'f32 heading', units = 'deg', poll_ms = 10,
    timeout_ms = timeout_ms, mode = 0444,
    converter = function(a_s, a, b_s, b) ba.f32(b, 0, 0 - ba.i32(a, 0) / 1000) end,
  }
end

-- A converter from the angle of the gyroscope, the degrees of `count` encoders and the time since the tuple before, in us.
-- What the angle turns by, evenly, while no encoder moves for `window_us` is drift: it is taken back, and taken off from
-- then on.
local function held_heading(count, window_us)
  local before, wheels, angle, drift = nil, {}, 0, 0
  local turned, lasted_us, begun, parts = 0, 0, 0, quarters(window_us)
  local uneven_most = steady_counts(window_us) * MDEG_PER_US_OF_COUNT
  local function wrapped(mdeg_now) return (mdeg_now + 180000) % 360000 - 180000 end
  return function(a_s, a, b_s, b)
    local now, us = ba.i32(a, 0), ba.u32(a, 4 * count + 4)
    local way = before and wrapped(now - before) or 0
    angle = before and wrapped(angle + way - drift * us) or now
    turned, lasted_us = turned + way, lasted_us + us
    local moved = not before
    for index = 1, count do
      local degrees = ba.i32(a, 4 * index)
      moved = moved or degrees ~= wheels[index]
      wheels[index] = degrees
    end
    before = now
    local is_over = lasted_us >= window_us
    local uneven = moved and 0 or parts(turned, lasted_us, lasted_us)
    if is_over and not moved and uneven <= uneven_most and math.abs(turned) <= DRIFT_MDEG_PER_US * lasted_us then
      angle, drift = begun, turned / lasted_us
    end
    if moved or is_over then turned, lasted_us, begun, parts = 0, 0, angle, quarters(window_us) end
    ba.f32(b, 0, 0 - number.round(angle, 1) / 1000)
  end
end

-- Makes `heading` of a tree know these encoders, a list of ports. None: the gyroscope has to do alone.
function imu.hold(tree, entry, ports)
  if #ports == 0 then return end
  local src = { 'newest:gyroscope/heading' }
  for _, port in ipairs(ports) do src[#src + 1] = 'newest:encoders/' .. port end
  local node = tree.heading
  node.src, node.interval = src, true
  -- Drift is measured while the robot stands, whether somebody reads the heading or not.
  node.always = true
  node.converter = held_heading(#ports, calibration_ms(entry) * 1000)
end

-- The nodes of both sensors, by their paths.
function imu.make(port, entry)
  if port == 'gyroscope' then
    local node = gyroscope(entry)
    return { gyroscope = node, heading = heading(node.timeout_ms) }
  end
  return { accelerometer = accelerometer() }
end

return imu
