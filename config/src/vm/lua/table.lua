-- The table library with limits: what loops in C beyond the reach of a budget is written in Lua.
local table, raw = ...
local error, type, insert = raw.error, raw.type, table.insert

-- Positions far outside the list would make the library's loop shift nothing for minutes.
function table.insert(list, ...)
  if type(list) == 'table' and raw.select('#', ...) == 2 then
    local position, value = ...
    position = raw.tonumber(position)
    if position and not (position >= 1 and position <= #list + 1) then
      error("bad argument #2 to 'insert' (position out of bounds)", 2)
    end
    return insert(list, position, value)
  end
  return insert(list, ...)
end

local function less(a, b) return a < b end

-- Moves the value at `at` down the heap of the first `last` values until no child is greater.
local function sift(list, at, last, before)
  local value = list[at]
  while true do
    local child = 2 * at
    if child > last then break end
    if child < last and before(list[child], list[child + 1]) then child = child + 1 end
    if not before(value, list[child]) then break end
    list[at] = list[child]
    at = child
  end
  list[at] = value
end

-- Heapsort (Williams 1964): no recursion, and never more than about 2 n log2 n comparisons.
function table.sort(list, before)
  if type(list) ~= 'table' then error("bad argument #1 to 'sort' (table expected, got " .. type(list) .. ')', 2) end
  if before ~= nil and type(before) ~= 'function' then
    error("bad argument #2 to 'sort' (function expected, got " .. type(before) .. ')', 2)
  end
  before = before or less
  local count = #list
  for at = (count - count % 2) / 2, 1, -1 do sift(list, at, count, before) end
  for last = count, 2, -1 do
    list[1], list[last] = list[last], list[1]
    sift(list, 1, last - 1, before)
  end
end

return table
