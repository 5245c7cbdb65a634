-- Curves through measured points: local calibrate = include 'calibrate'. docs/converters/sensor.md uses it.
--
-- Owns nothing and converts nothing: it computes the numbers of a filter, once, when the configuration is loaded.

local calibrate = {}

local POINTS_MIN, POINTS_MAX = 2, 20

-- { measured, raw } pairs, or an error at the line of the configuration that called `calibrate.NAME`.
local function checked(points)
  local function refuse(text) error('points: ' .. text, 4) end
  if type(points) ~= 'table' then refuse('a list of { distance, raw } pairs, not a ' .. type(points)) end
  if #points < POINTS_MIN or #points > POINTS_MAX then
    refuse('there are ' .. POINTS_MIN .. ' to ' .. POINTS_MAX .. ' of them, not ' .. #points)
  end
  for i, point in ipairs(points) do
    local x, y
    if type(point) == 'table' then x, y = point[1], point[2] end
    if type(x) ~= 'number' or type(y) ~= 'number' or x - x ~= 0 or y - y ~= 0 then
      refuse('number ' .. i .. ' is no pair { distance, raw } of numbers')
    end
  end
  return points
end

-- Solves a system of linear equations, rows of coefficients with the right side at the end, by Gauss and Jordan with the
-- largest pivot of each column. Nil if it has no single solution.
local function solve(m)
  local n = #m
  for i = 1, n do
    local best = i
    for j = i + 1, n do
      if math.abs(m[j][i]) > math.abs(m[best][i]) then best = j end
    end
    m[i], m[best] = m[best], m[i]
    if m[i][i] == 0 then return nil end
    for j = 1, n do
      local factor = j ~= i and m[j][i] / m[i][i] or 0
      for column = i, n + 1 do m[j][column] = m[j][column] - factor * m[i][column] end
    end
  end
  local solution = {}
  for i = 1, n do solution[i] = m[i][n + 1] / m[i][i] end
  return solution
end

-- The numbers of the least squares: each row is coefficients with the right side at the end.
local function least_squares(rows)
  local n, m = #rows[1] - 1, {}
  for i = 1, n do
    m[i] = {}
    for j = 1, n + 1 do
      m[i][j] = 0
      for _, row in ipairs(rows) do m[i][j] = m[i][j] + row[i] * row[j] end
    end
  end
  return solve(m)
end

-- The parameters of filter.inverse_f32, distance = k / (raw + raw_offset) + offset, for { distance, raw } pairs.
-- Two points fix k and offset, with raw_offset 0; from three on all three numbers are fitted, exactly or best.
-- Multiplied out the curve is linear in what is sought: raw d = (k + offset raw_offset) + offset raw - raw_offset d.
function calibrate.inverse(points)
  local rows = {}
  for i, point in ipairs(checked(points)) do
    local d, raw = point[1], point[2]
    rows[i] = #points > 2 and { 1, raw, -d, raw * d } or { 1, raw, raw * d }
  end
  local found = least_squares(rows)
  local whole, offset, raw_offset = 0, 0, 0
  if found then whole, offset, raw_offset = found[1], found[2], found[3] or 0 end
  local k = whole - offset * raw_offset
  local falls = k > 0 and k < math.huge
  for _, point in ipairs(points) do falls = falls and point[2] + raw_offset > 0 end
  if not falls then error('points: they do not lie on a curve that falls as the signal grows', 2) end
  return { k = k, raw_offset = raw_offset, offset = offset }
end

return calibrate
