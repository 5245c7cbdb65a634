-- Whole numbers as C has them, for the files in this folder.
--
-- Owns nothing. Numbers are doubles: everything here is exact below 2^53, see the header of filters.lua.
local floor = math.floor

local number = {}

-- dividend / divisor, cut towards zero; the divisor is not 0.
function number.divide(dividend, divisor)
  if divisor < 0 then dividend, divisor = -dividend, -divisor end
  if dividend < 0 then return -floor(-dividend / divisor) end
  return floor(dividend / divisor)
end

-- dividend / divisor for a divisor above 0, rounded to the nearest, halves away from zero.
function number.round(dividend, divisor)
  if dividend < 0 then return -floor((-2 * dividend + divisor) / (2 * divisor)) end
  return floor((2 * dividend + divisor) / (2 * divisor))
end

-- A copy of a list or table; only the first level is new.
function number.copy(from)
  local to = {}
  for key, value in pairs(from) do to[key] = value end
  return to
end

-- Refuses a written number outside its limits; the word at the beginning becomes the errno of the write.
function number.within(what, value, least, greatest)
  if value >= least and value <= greatest then return value end
  error('ERANGE: ' .. what .. ' is ' .. least .. ' to ' .. greatest .. ', not ' .. value, 0)
end

return number
