-- The filters of the library libtrikfs_filters.so in Lua, equal bit for bit: filter.NAME{ parameters } is a converter.
-- For configurations that shall run where no library can be built, and to read, copy and change.
--
-- Every tuple is an array of little-endian 32-bit values: integers (i32) for the plain names, floats (f32) for the names
-- that end in _f32. Most filters work on each value on its own; those in `fuse` make one result of two values and of the
-- time between tuples. A value that is not a finite number is a fault, and so is a result that is none; after a fault the
-- filter begins afresh. The equations and their sources stand in docs/converters/filters.md; tests/golden/filters holds
-- both implementations to the same results. heading, kalman_linear, madgwick, mahony and odometry are in the library only.
--
-- Numbers here are doubles. Integer results are exact because every intermediate value stays below 2^53, and because
-- math.floor(n / d) is the exact floor for whole |n| < 2^53: a quotient below a whole number differs from it by at least
-- 1/d, more than the division can be off.

local floor, abs = math.floor, math.abs

-- The largest double that rounds to a finite float is below this bound, halfway from the largest float to 2^128.
local F32_BOUND = 2 ^ 128 - 2 ^ 103
local F32_MAX = 2 ^ 128 - 2 ^ 104
local I32_MIN, I32_MAX = -2 ^ 31, 2 ^ 31 - 1
-- Largest multiplier or divisor of integer ratios: a difference of two integers times this is below 2^53.
local SPAN_MAX = 2 ^ 20
-- Largest real parameter without a limit of its own, and longest period.
local REAL_MAX, PERIOD_MS_MAX = 1e9, 3600000
-- Longest time between two tuples that is still bridged.
local GAP_US_MAX = 1000000

-- dividend / divisor, rounded to nearest, halves away from zero.
local function divide_rounding(dividend, divisor)
  local sign = 1
  if dividend < 0 then dividend, sign = -dividend, -sign end
  if divisor < 0 then divisor, sign = -divisor, -sign end
  local quotient = floor(dividend / divisor)
  if 2 * (dividend - quotient * divisor) >= divisor then quotient = quotient + 1 end
  return sign * quotient
end

-- The two kinds of values: how to read and write one, and their arithmetic.
-- `finite` tells numbers from the rest, where there is a rest; `narrow` gives nil for a result that is not a finite number.
local I32 = {
  suffix = '', type = 'i32', whole = true, least = I32_MIN, greatest = I32_MAX, span = SPAN_MAX,
  ratio = function(value, multiplier, divisor) return divide_rounding(value * multiplier, divisor) end,
  quotient = function(dividend, divisor)
    if dividend < 0 then return -floor(-dividend / divisor) end
    return floor(dividend / divisor)
  end,
  narrow = function(value)
    if value < I32_MIN then return I32_MIN end
    if value > I32_MAX then return I32_MAX end
    return value
  end,
}
-- The nearest value to a real number.
function I32.nearest(real)
  if real - real ~= 0 then return nil end
  local whole = floor(abs(real) + 0.5)
  return I32.narrow(real < 0 and -whole or whole)
end
local F32 = {
  suffix = '_f32', type = 'f32', whole = false, least = -F32_MAX, greatest = F32_MAX, span = math.huge,
  ratio = function(value, multiplier, divisor) return value * multiplier / divisor end,
  quotient = function(dividend, divisor) return dividend / divisor end,
  finite = function(value) return value - value == 0 end,
  narrow = function(value)
    if value > -F32_BOUND and value < F32_BOUND then return value end
    return nil
  end,
}

F32.nearest = F32.narrow

-- Reads parameters of one filter. Errors point at the configuration: level 2 is the generator, level 3 its caller.
local Params = {}
Params.__index = Params

function Params:refuse(text, level)
  error(self.filter .. ': ' .. text, level + 1)
end

-- Checks one number.
function Params:check(name, value, least, greatest, whole, level)
  if type(value) == 'number' and value >= least and value <= greatest and not (whole and floor(value) ~= value) then
    return value
  end
  local kind = whole and 'a whole number from ' or 'from '
  local limits = string.format('%.17g to %.17g', least, greatest)
  self:refuse(name .. ' must be ' .. kind .. limits .. ', not ' .. tostring(value), level + 1)
end

-- The parameter `name`, or its default when the configuration gives none.
function Params:fetch(name, default)
  self.known[name] = true
  local value = self.given[name]
  if value == nil then return default end
  return value
end

-- A parameter within limits.
function Params:get(name, default, least, greatest, whole)
  return (self:check(name, self:fetch(name, default), least, greatest, whole, 4))
end

-- A parameter that is any value of the kind.
function Params:value(kind, name, default)
  return (self:check(name, self:fetch(name, default), kind.least, kind.greatest, kind.whole, 4))
end

-- A real number within limits.
function Params:real(name, default, least, greatest)
  return (self:check(name, self:fetch(name, default), least, greatest, false, 4))
end

-- The time between two tuples in microseconds; nil if the configuration does not say.
function Params:period_us()
  local period_ms = self:fetch('period_ms', nil)
  if period_ms == nil then return nil end
  return self:check('period_ms', period_ms, 1, PERIOD_MS_MAX, true, 3) * 1000
end

-- Refuses a parameter that the filter does not have.
function Params:close(level)
  for name in pairs(self.given) do
    if not self.known[name] then self:refuse("no parameter '" .. tostring(name) .. "'", level + 1) end
  end
end

-- Each of these reads parameters and returns a function that makes one lane: step(value) gives a result, nil while
-- there is none yet, or nil and a reason.
local OVERFLOW = 'the result is not a finite number'
local make = {}

function make.median3()
  return function()
    local older, newer
    return function(value)
      if not newer then older, newer = value, value end
      local low, high = newer, older
      if older < newer then low, high = older, newer end
      older, newer = newer, value
      if value < low then return low end
      if value > high then return high end
      return value
    end
  end
end

function make.moving_average(params, kind)
  local window = params:get('window', 8, 1, 256, true)
  return function()
    local ring, filled, oldest, sum = {}, 0, 0, 0
    return function(value)
      if filled < window then
        ring[filled] = value
        filled = filled + 1
      else
        sum = sum - ring[oldest]
        ring[oldest] = value
        oldest = (oldest + 1) % window
      end
      sum = sum + value
      if not kind.whole then
        -- A running sum of floats keeps the rounding error of every value that ever passed; add up, oldest first.
        sum = 0
        for i = oldest, filled - 1 do sum = sum + ring[i] end
        for i = 0, oldest - 1 do sum = sum + ring[i] end
      end
      local result = kind.narrow(kind.ratio(sum, 1, filled))
      return result, OVERFLOW
    end
  end
end

-- Integers: alpha in multiples of 2^-15, the state with 16 bits after the point. The change is below 2^49, so it is
-- multiplied in two parts of which neither product reaches 2^53.
local function low_pass_i32(alpha)
  local weight = floor(alpha * 2 ^ 15 + 0.5)
  return function()
    local state
    return function(value)
      if not state then
        state = value * 2 ^ 16
      else
        local change = value * 2 ^ 16 - state
        local high = floor(change / 2 ^ 24)
        local low = change - high * 2 ^ 24
        state = state + high * weight * 2 ^ 9 + floor((low * weight + 2 ^ 14) / 2 ^ 15)
      end
      return floor((state + 2 ^ 15) / 2 ^ 16)
    end
  end
end

function make.low_pass(params, kind)
  local alpha = params:get('alpha', 0.25, 1 / 32768, 1, false)
  if kind.whole then return low_pass_i32(alpha) end
  return function()
    local state
    return function(value)
      if not state then state = value else state = state + alpha * (value - state) end
      return kind.narrow(state), OVERFLOW
    end
  end
end

function make.scale(params, kind)
  local x0, y0 = params:value(kind, 'x0', 0), params:value(kind, 'y0', 0)
  local x1, y1 = params:value(kind, 'x1', 1), params:value(kind, 'y1', 1)
  local min = params:value(kind, 'min', kind.least)
  local max = params:value(kind, 'max', kind.greatest)
  local run = params:check('x1 - x0', x1 - x0, -kind.span, kind.span, kind.whole, 3)
  local rise = params:check('y1 - y0', y1 - y0, -kind.span, kind.span, kind.whole, 3)
  if x0 == x1 then params:refuse('x0 and x1 must differ', 3) end
  if min > max then params:refuse('min must not be above max', 3) end
  return function()
    return function(value)
      local result = kind.ratio(value - x0, rise, run) + y0
      if result < min then result = min elseif result > max then result = max end
      return kind.narrow(result), OVERFLOW
    end
  end
end

function make.inverse(params, kind)
  local k = params:value(kind, 'k', 8697)
  local raw_offset = params:value(kind, 'raw_offset', 0)
  local offset = params:value(kind, 'offset', -2)
  return function()
    return function(value)
      local shifted = value + raw_offset
      if shifted <= 0 then return nil, 'the raw value is beyond the pole of the curve' end
      return kind.narrow(kind.quotient(k, shifted) + offset), OVERFLOW
    end
  end
end

function make.dead_band(params, kind)
  local width = params:get('width', 0, 0, kind.greatest, kind.whole)
  local center = params:value(kind, 'center', 0)
  return function()
    return function(value)
      local deviation = value - center
      local result = center
      if deviation > width then
        result = value - width
      elseif deviation < -width then
        result = value + width
      end
      return kind.narrow(result), OVERFLOW
    end
  end
end

function make.rate(params, kind)
  local period_ms = params:get('period_ms', 1000, 1, 3600000, true)
  return function()
    local previous
    return function(value)
      local last = previous
      previous = value
      if not last then return nil end
      return kind.narrow(kind.ratio(value - last, 1000, period_ms)), OVERFLOW
    end
  end
end

function make.debounce(params)
  local samples = params:get('samples', 3, 1, 1000, true)
  return function()
    local stable, candidate, times = nil, nil, 0
    return function(value)
      if not stable then stable = value end
      times = (times > 0 and candidate == value) and times + 1 or 1
      candidate = value
      if value == stable then
        times = 0
      elseif times >= samples then
        stable, times = value, 0
      end
      return stable
    end
  end
end

function make.hysteresis(params, kind)
  local low, high = params:value(kind, 'low', 0), params:value(kind, 'high', 1)
  if low >= high then params:refuse('low must be below high', 3) end
  return function()
    local is_high = false
    return function(value)
      is_high = value >= high or (is_high and value > low)
      return is_high and 1 or 0
    end
  end
end

function make.kalman(params, kind)
  local q, r = params:real('q', 1, 0, REAL_MAX), params:real('r', 16, 1e-9, REAL_MAX)
  return function()
    local estimate, variance
    return function(value)
      if not estimate then
        estimate, variance = value, r
      else
        local predicted = variance + q
        local gain = predicted / (predicted + r)
        estimate, variance = estimate + gain * (value - estimate), (1 - gain) * predicted
      end
      return kind.nearest(estimate), OVERFLOW
    end
  end
end

-- Each of these reads parameters and returns a function that makes one step(first, second, seconds), which gives up to
-- three real results; seconds is nil for the first tuple.
local fuse = {}

function fuse.complementary(params)
  local time_constant = params:real('time_constant_ms', 1000, 0, PERIOD_MS_MAX) / 1000
  local wrap = params:real('wrap', 0, 0, REAL_MAX)
  local function wrapped(angle)
    if wrap > 0 then return angle - wrap * floor(angle / wrap + 0.5) end
    return angle
  end
  return function()
    local angle
    return function(rate, measured, seconds)
      if angle and seconds then
        local predicted = angle + rate * seconds
        angle = predicted + wrapped(measured - predicted) * (seconds / (time_constant + seconds))
      else
        angle = measured
      end
      angle = wrapped(angle)
      return angle
    end
  end
end

-- The limited output of a controller, and the sum of its integral part after a step: the step is taken if it does not
-- drive an output at its limit further.
local function controlled(others, sum, step, min, max)
  local wanted = others + sum + step
  if not ((wanted > max and step > 0) or (wanted < min and step < 0)) then
    sum = math.min(math.max(sum + step, min), max)
  end
  return math.min(math.max(wanted, min), max), sum
end

function fuse.pid(params)
  local kp = params:real('kp', 1, -REAL_MAX, REAL_MAX)
  local ki = params:real('ki', 0, -REAL_MAX, REAL_MAX)
  local kd = params:real('kd', 0, -REAL_MAX, REAL_MAX)
  local filter = params:real('filter_ms', 0, 0, PERIOD_MS_MAX) / 1000
  local min = params:real('min', -100, -REAL_MAX, REAL_MAX)
  local max = params:real('max', 100, -REAL_MAX, REAL_MAX)
  if min > max then params:refuse('min must not be above max', 3) end
  return function()
    local before, derivative, sum = nil, 0, 0
    return function(setpoint, measured, seconds)
      local difference, step = setpoint - measured, 0
      if before and seconds then
        local slope = (measured - before) / seconds
        derivative = derivative + (slope - derivative) * (seconds / (filter + seconds))
        step = ki * difference * seconds
      end
      before = measured
      local output
      output, sum = controlled(kp * difference - kd * derivative, sum, step, min, max)
      return output
    end
  end
end

-- The difference of two counters of 32 bits.
local function way_between(before, now)
  return (now - before + 2 ^ 31) % 2 ^ 32 - 2 ^ 31
end

-- Returns trips(wanted, position, at_limit, seconds): true from a stall until the wanted speed is 0.
local function stall_guard(limit)
  local anchor, still, tripped = 0, 0, false
  return function(wanted, position, at_limit, seconds)
    if wanted == 0 then
      anchor, still, tripped = position, 0, false
    elseif not at_limit or abs(way_between(anchor, position)) > 1 then
      anchor, still = position, 0
    else
      still = still + seconds
      tripped = tripped or (limit > 0 and still >= limit)
    end
    return tripped
  end
end

function fuse.speed_hold(params)
  local kf = params:real('kf', 0, 0, REAL_MAX)
  local kp, ki = params:real('kp', 0.05, 0, REAL_MAX), params:real('ki', 0.5, 0, REAL_MAX)
  local max = params:real('max', 100, 0, REAL_MAX)
  local smoothing = params:real('speed_ms', 50, 0, PERIOD_MS_MAX) / 1000
  local stall = params:real('stall_ms', 1000, 0, PERIOD_MS_MAX) / 1000
  local speed_max = params:real('speed_max', 10000, 1, REAL_MAX)
  return function()
    local before, speed, sum, trips = nil, 0, 0, stall_guard(stall)
    return function(wanted, position, seconds)
      seconds = seconds or 0
      local way, step = before and way_between(before, position) or 0, 0
      before = position
      -- Not in the first tuple, nor when the counter was set back.
      if seconds > 0 and abs(way) <= speed_max * seconds then
        speed = speed + (way / seconds - speed) * (seconds / (smoothing + seconds))
        step = ki * (wanted * seconds - way)
      end
      local power
      power, sum = controlled(kf * wanted + kp * (wanted - speed), sum, step, -max, max)
      local tripped = trips(wanted, position, abs(power) >= max, seconds)
      if wanted == 0 or tripped then power, sum = 0, 0 end
      return power, speed, tripped and 1 or 0
    end
  end
end

-- How many results there are at most, and of which kinds of values.
local results_of = { complementary = 1, pid = 1, speed_hold = 3 }
local kinds_of = { complementary = { I32, F32 }, pid = { I32, F32 }, speed_hold = { I32 } }

-- One step for both values of the tuple, which may be followed by the time in microseconds.
local function fused(name, kind, period_us, make_step)
  local access, finite, nearest = ba[kind.type], kind.finite, kind.nearest
  local most = results_of[name]
  local step, stamped, begun, stamp
  local first, second, third

  local function fail(reason)
    step, begun, stamp = make_step(), false, nil
    error(name .. ': ' .. reason, 0)
  end

  -- The seconds since the tuple before; nil for the first one and 0 for the same one.
  local function elapsed(now)
    local before = stamp
    stamp = now
    if not before then return nil end
    local us = (now - before) % 2 ^ 32
    if us >= 2 ^ 31 then fail('time went back by ' .. 2 ^ 32 - us .. ' us') end
    if us > GAP_US_MAX then fail(us .. ' us since the last tuple, more than ' .. GAP_US_MAX) end
    return us / 1e6
  end

  local function open(a_s, b_s)
    stamped = a_s == 12
    if not (stamped or a_s == 8) or b_s % 4 ~= 0 or b_s < 4 or b_s > 4 * most then
      local gives = most == 1 and '4' or '4 or 8 or 12'
      local sizes = 'tuples of ' .. a_s .. ' to ' .. b_s .. ' bytes'
      error(name .. ': ' .. sizes .. '; it takes 8, 4 more with a time_us, and gives ' .. gives, 0)
    end
    if not stamped and not period_us then
      error(name .. ': period_ms is missing, and the tuple does not end with a time_us', 0)
    end
    step = make_step()
  end

  return function(a_s, a, b_s, b)
    if not step then open(a_s, b_s) end
    local one, two = access(a, 0), access(a, 4)
    if finite and not finite(one) then fail('value 0: not a finite number') end
    if finite and not finite(two) then fail('value 1: not a finite number') end
    local seconds
    if stamped then seconds = elapsed(ba.u32(a, 8)) elseif begun then seconds = period_us / 1e6 end
    begun = true
    if seconds ~= 0 then
      local x, y, z = step(one, two, seconds)
      first, second, third = nearest(x), y and nearest(y), z and nearest(z)
      if not first or (y and b_s > 4 and not second) then fail(OVERFLOW) end
    end
    access(b, 0, first)
    if b_s > 4 then access(b, 4, second) end
    if b_s > 8 then access(b, 8, third) end
  end
end

-- One lane for each value of the tuple, made at the first call: the sizes are known only then.
local function lanes(name, kind, make_lane)
  local access, finite = ba[kind.type], kind.finite
  local steps, count

  local function begin()
    steps = {}
    for lane = 0, count - 1 do steps[lane] = make_lane() end
  end

  local function fail(lane, reason)
    begin()
    error(name .. ': value ' .. lane .. ': ' .. reason, 0)
  end

  return function(a_s, a, b_s, b)
    if not steps then
      if a_s ~= b_s or a_s == 0 or a_s % 4 ~= 0 then
        local sizes = 'tuples of ' .. a_s .. ' to ' .. b_s .. ' bytes'
        error(name .. ': ' .. sizes .. '; it needs equal sizes, a multiple of 4', 0)
      end
      count = a_s / 4
      begin()
    end
    if finite then
      for lane = 0, count - 1 do
        if not finite(access(a, 4 * lane)) then fail(lane, 'not a finite number') end
      end
    end
    -- All lanes take their value even if an earlier one fails; the first reason counts.
    local complete, at, reason = true, nil, nil
    for lane = 0, count - 1 do
      local result, problem = steps[lane](access(a, 4 * lane))
      if result then
        access(b, 4 * lane, result)
      elseif problem then
        if not at then at, reason = lane, problem end
      else
        complete = false
      end
    end
    if at then fail(at, reason) end
    if not complete then return false end
  end
end

-- The parameters of a filter as its caller gave them.
local function open(name, given)
  if given ~= nil and type(given) ~= 'table' then
    error(name .. ': parameters are a table, as in filter.' .. name .. '{}', 3)
  end
  return setmetatable({ filter = name, given = given or {}, known = {} }, Params)
end

local filter = {}

-- Copies tuples of any size.
function filter.identity(given)
  local params = open('identity', given)
  params:close(2)
  return function(a_s, a, b_s, b)
    if a_s ~= b_s then
      error('identity: tuples of ' .. a_s .. ' to ' .. b_s .. ' bytes; it needs equal sizes', 0)
    end
    for i = 0, a_s - 1 do ba.set(b, i, ba.get(a, i)) end
  end
end

for name, make_filter in pairs(make) do
  for _, kind in ipairs({ I32, F32 }) do
    filter[name .. kind.suffix] = function(given)
      local params = open(name, given)
      local make_lane = make_filter(params, kind)
      params:close(2)
      return (lanes(name, kind, make_lane))
    end
  end
end

for name, make_filter in pairs(fuse) do
  for _, kind in ipairs(kinds_of[name]) do
    filter[name .. kind.suffix] = function(given)
      local params = open(name, given)
      local period_us, make_step = params:period_us(), make_filter(params, kind)
      params:close(2)
      return (fused(name, kind, period_us, make_step))
    end
  end
end

-- A mistyped name is told with the right ones.
return setmetatable(filter, {
  __index = function(_, name)
    local names = {}
    for known in pairs(filter) do names[#names + 1] = known end
    table.sort(names)
    error('there is no filter.' .. tostring(name) .. ' in Lua; there are: ' .. table.concat(names, ', ')
      .. "; others are in the library, as 'libtrikfs_filters.so#NAME'", 2)
  end,
})
