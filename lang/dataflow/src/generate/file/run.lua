local floor, ceil, huge = math.floor, math.ceil, math.huge
local sin, cos, log, exp, asin, acos = math.sin, math.cos, math.log, math.exp, math.asin, math.acos
local atan, atan2, sqrt, abs = math.atan, math.atan2, math.sqrt, math.abs
local band, bor, bxor, bnot, lshift, arshift = bit.band, bit.bor, bit.bxor, bit.bnot, bit.lshift, bit.arshift
local error, pairs, pcall, tostring, type = error, pairs, pcall, tostring, type

local function fail(reason) error(reason, 0) end

local function number(value)
  if type(value) == 'number' then return value end
  if value == nil then fail('there is no value where a number is needed') end
  fail(type(value) == 'boolean' and 'a truth is no number' or 'a list is no number')
end

local function numberOfAny(value)
  if value == true then return 1 end
  if value == false then return 0 end
  return number(value)
end

local function demand(value)
  if value ~= nil then number(value) end
end

-- What is whole has no sign where it is 0: that is what adding 0 does.
local function whole(number)
  if number >= -2147483648 and number <= 2147483647 and floor(number) == number then return number + 0 end
  if not (number > -9.2e18 and number < 9.2e18) then return 0 end
  local down = floor(number)
  if number - down >= 0.5 then down = down + 1 end
  down = down % 4294967296
  return down >= 2147483648 and down - 4294967296 or down
end

local function asWhole(value)
  if type(value) ~= 'number' then fail(value == nil and 'there is no value where a number is needed' or 'this is no number') end
  local size = abs(value)
  local down = floor(size)
  if size - down >= 0.5 then down = down + 1 end
  if not (down <= 2147483647) then fail('the number is too large for a whole one') end
  return (value < 0 and -down or down) + 0
end

local function truth(value)
  if type(value) == 'number' then return value ~= 0 end
  return value == true
end

local function cut(number)
  if number ~= number then return 0 end
  return (number > 2147483647 and 2147483647 or number < -2147483648 and -2147483648 or number) + 0
end

local function sign(number) return number > 0 and 1 or number < 0 and -1 or 0 end
local function least(one, other) return one < other and one or other end
local function most(one, other) return one < other and other or one end
local function clamp(number, limit) return number > limit and limit or number < -limit and -limit or number end
local function ignore() end

local function divide(left, right)
  if right == 0 then fail('division by 0') end
  return left / right
end

local function divideWhole(left, right)
  if right == 0 then fail('division by 0') end
  return whole(floor(left / right))
end

local function modulo(left, right)
  if right == 0 then fail('division by 0') end
  return left - floor(left / right) * right + 0
end

local function shiftLeft(left, right) return right >= 0 and right < 32 and lshift(left, right) or 0 end
local function shiftRight(left, right)
  if right >= 0 and right < 32 then return arshift(left, right) end
  return left < 0 and -1 or 0
end

local function same(one, other)
  if type(one) == 'table' and type(other) == 'table' then
    if one.n ~= other.n then return false end
    for at = 0, one.n - 1 do
      if not same(one[at], other[at]) then return false end
    end
    return true
  end
  if one == nil or other == nil then return one == other end
  if type(one) == 'table' or type(other) == 'table' then return false end
  return numberOfAny(one) == numberOfAny(other)
end

local function item(list, at)
  if at < 0 then fail('an index is below 0') end
  if type(list) == 'table' then return list[at] end
end

-- The first item says what all of them are.
local function numberOfItem(list, at)
  local value = item(list, at)
  if type(list) ~= 'table' or list[0] == nil then return number(value) end
  number(list[0])
  return numberOfAny(value)
end

local function put(list, at, value)
  if at < 0 then fail('an index is below 0') end
  if at >= ITEMS_MAX then fail('a list is too long') end
  local new = { n = at + 1 }
  if type(list) == 'table' then
    if list.n > new.n then new.n = list.n end
    for index = 0, list.n - 1 do new[index] = list[index] end
  end
  new[at] = value
  return new
end

local function length(list)
  if type(list) ~= 'table' then fail('only lists have a length here') end
  return list.n
end

local function needsValue(value)
  if value == nil then fail('there is no value') end
  return value
end

local function needsItems(list, count)
  if type(list) ~= 'table' or list.n < count then fail('a list of ' .. count .. ' items is needed') end
end

local function roundUp(ms) return ms < 1 and 10 or ceil(ms / 10) * 10 end
local function isOver(following, last, step)
  if step > 0 then return following > last end
  return following < last
end

-- A program from its beginning: a function of the microseconds since the tuple before and the table of readings, by the
-- names of fields. It gives the table of all fields.
local function new()
  local s = { now = 0, firings = 0 }
  local reactions, ticks, names = {}, {}, { reactions = {}, ticks = {} }
  local tokens, places, first, last = {}, {}, 1, 0
  local due, order, set = {}, {}, 0
  local at, queued = nil, 0

  local function post(place, token)
    if last - first + 1 >= DELIVERIES_MAX then fail('too many tokens are on their way') end
    last = last + 1
    places[last], tokens[last] = place, token
  end

  local function count()
    s.firings = s.firings + 1
    if s.firings > FIRINGS_MAX then fail('too many reactions in one instant, as in a cycle without a wait') end
  end

  local function stop() fail('ENODEV: the program has ended') end

  local function setTimer(id, time)
    set = set + 1
    due[id], order[id] = time, set
  end

  local function cancelTimer(id) due[id] = nil end

  local function repeatTimer(id, was, period)
    local time = was + period
    setTimer(id, time > s.now and time or s.now + period)
  end

  -- What a token weighs where it waits.
  local function weight(token) return type(token) == 'table' and token.n + 1 or 1 end

  local function has(queue) return queue.last >= queue.first end

  local function take(queue)
    local token = queue[queue.first]
    queue[queue.first] = nil
    queue.first = queue.first + 1
    queued = queued - weight(token)
    return token
  end

  local function push(queue, token, capacity, policy)
    local weighs = weight(token)
    if queue.last - queue.first + 1 >= capacity or queued + weighs > QUEUED_MAX then
      if policy == 2 then fail('more than ' .. capacity .. ' tokens wait') end
      -- The oldest one is lost, or this one if none waits.
      if not has(queue) then return end
      take(queue)
    end
    queued = queued + weighs
    queue.last = queue.last + 1
    queue[queue.last] = token
  end

  -- the program

  local function fire()
    -- What is set meanwhile is due later.
    local newest = set
    while true do
      local found
      for id = 1, #ticks do
        local time = due[id]
        if time and time <= s.now and order[id] <= newest
          and (not found or time < due[found] or time == due[found] and order[id] < order[found]) then
          found = id
        end
      end
      if not found then return end
      local time = due[found]
      due[found] = nil
      at = names.ticks[found]
      count()
      ticks[found](time)
    end
  end

  local function deliver()
    while first <= last do
      local place, token = places[first], tokens[first]
      tokens[first] = nil
      first = first + 1
      at = names.reactions[place]
      reactions[place](token)
    end
    first, last = 1, 0
  end

  local function instant(now, polls)
    s.now, s.firings = now, 0
    fire()
    at = nil
    if polls then poll() end
    deliver()
  end

  local us = 0
  local function tuple(passed, readings)
    if us == 0 then
      us = POLL_MS * 1000
      for field, value in pairs(readings) do s[field] = value end
      begin()
      deliver()
    end
    us = us + passed
    local now = floor(us / 1000)
    for _ = 1, INSTANTS_MAX do
      local soonest = huge
      for id = 1, #ticks do
        if due[id] and due[id] < soonest then soonest = due[id] end
      end
      if soonest >= now then break end
      instant(soonest > s.now and soonest or s.now, false)
    end
    for field, value in pairs(readings) do s[field] = value end
    instant(now, true)
  end

  return function(passed, readings)
    at = nil
    local good, reason = pcall(tuple, passed, readings)
    if not good then
      local text = tostring(reason)
      fail(text:match('^ENODEV: ') and text or (at or 'the program') .. ': ' .. text)
    end
    return s
  end
end

