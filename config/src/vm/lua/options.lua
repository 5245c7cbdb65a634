-- What stands before the globals that make a whole node of a table of options: `dcml` and `dataflow`.
--
-- Owns what they get, the sizes of types, and how values and names are shown in messages. chunk(name) gives the function of
-- a model or program, or nil and why. Knows no option.
local _, raw, _, chunk = ...
local error, ipairs, next, pairs, pcall = raw.error, raw.ipairs, raw.next, raw.pairs, raw.pcall
local tostring, type = raw.tostring, raw.type

local SIZES = { i8 = 1, u8 = 1, i16 = 2, u16 = 2, i32 = 4, u32 = 4, f32 = 4, f64 = 8 }

local function shown(value)
  if type(value) == 'string' then return "'" .. value .. "'" end
  return type(value) == 'number' and tostring(value) or 'a ' .. type(value)
end

local function sorted(names)
  local list = {}
  for name in pairs(names) do list[#list + 1] = tostring(name) end
  table.sort(list)
  return list
end
