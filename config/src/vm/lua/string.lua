-- The string library with limits. find and match are the host's; scan(text, pattern, from, anchors) gives first and last
-- position and the captures (the whole match if there are none) of a match, nil, or false and the reason; library(name)
-- opens one of LuaJIT's own.
local string, raw, find, match, scan, library = ...
local error, select, tostring, type, unpack = raw.error, raw.select, raw.tostring, raw.type, raw.unpack
local byte, sub, rep = string.byte, string.sub, string.rep
local BYTES_MAX = 16777216

raw.dump = raw.dump or string.dump
string.dump, string.find, string.match, string.gfind = nil, find, match, nil

function string.rep(text, count, separator)
  if (type(text) == 'string' or type(text) == 'number') and type(count) == 'number' then
    local size = (#tostring(text) + (separator and #tostring(separator) or 0)) * count
    if size > BYTES_MAX then error('a string of ' .. size .. ' bytes is too long', 2) end
  end
  return rep(text, count, separator)
end

-- The library's own format calls __tostring from C, each time deeper into the machine stack.
local format = string.format

local function texts(count, value, ...)
  if type(value) == 'table' then value = tostring(value) end
  if count == 1 then return value end
  return value, texts(count - 1, ...)
end

function string.format(template, ...)
  local count = select('#', ...)
  if count == 0 then return format(template) end
  return format(template, texts(count, ...))
end

local function text(value, position, name)
  if type(value) == 'number' then return tostring(value) end
  if type(value) == 'string' then return value end
  error('bad argument #' .. position .. " to '" .. name .. "' (string expected, got " .. type(value) .. ')', 3)
end

function string.gmatch(subject, pattern)
  subject, pattern = text(subject, 1, 'gmatch'), text(pattern, 2, 'gmatch')
  local at = 1
  local function step(from, to, ...)
    if not from then
      at = #subject + 2
      if from == false then error(to, 2) end
      return nil
    end
    at = to >= from and to + 1 or from + 1
    return ...
  end
  return function()
    if at > #subject + 1 then return nil end
    return step(scan(subject, pattern, at, false))
  end
end

-- The replacement for one match: `%0` the whole, `%1` the first capture, which is the third value of `found`.
local function expand(template, whole, found)
  local out, at = '', 1
  while true do
    local mark = find(template, '%', at, true)
    if not mark then return out .. sub(template, at) end
    out = out .. sub(template, at, mark - 1)
    local digit = byte(template, mark + 1)
    if not digit then
      error("invalid use of '%' in replacement string", 3)
    elseif digit == 48 then
      out = out .. whole
    elseif digit > 48 and digit <= 57 then
      local capture = found[digit - 46]
      if capture == nil then error('invalid capture index', 3) end
      out = out .. capture
    else
      out = out .. sub(template, mark + 1, mark + 1)
    end
    at = mark + 2
  end
end

function string.gsub(subject, pattern, replacement, limit)
  subject, pattern = text(subject, 1, 'gsub'), text(pattern, 2, 'gsub')
  local kind = type(replacement)
  if kind == 'number' then replacement, kind = tostring(replacement), 'string' end
  if kind ~= 'string' and kind ~= 'table' and kind ~= 'function' then
    error("bad argument #3 to 'gsub' (string/function/table expected, got " .. kind .. ')', 2)
  end
  local template = kind == 'string' and find(replacement, '%', 1, true)
  local anchored = byte(pattern) == 94
  local out, count, at, copied = {}, 0, 1, 1
  while at <= #subject + 1 and not (limit and count >= limit) do
    local found = { scan(subject, pattern, at, true) }
    local from, to = found[1], found[2]
    if from == false then error(to, 2) end
    if not from then break end
    local whole, value = sub(subject, from, to)
    if template then
      value = expand(replacement, whole, found)
    elseif kind == 'string' then
      value = replacement
    elseif kind == 'table' then
      value = replacement[found[3]]
    else
      value = replacement(unpack(found, 3))
    end
    if not value then
      value = whole
    elseif type(value) ~= 'string' and type(value) ~= 'number' then
      error('invalid replacement value (a ' .. type(value) .. ')', 2)
    end
    out[#out + 1] = sub(subject, copied, from - 1)
    out[#out + 1] = value
    count = count + 1
    if to >= from then at, copied = to + 1, to + 1 else at, copied = from + 1, from end
    if anchored then break end
  end
  out[#out + 1] = sub(subject, copied)
  return library('table').concat(out), count
end

return string
