-- What every configuration and converter finds when it starts: the safe part of Lua and byte arrays. Everything else
-- (id_create, trikfs_log, include, string, table, math, bit, coroutine, filter, the source constructors and more) is made
-- when its name is first used, because a state of its own for every open file has to be small.
--
-- raw: LuaJIT's base library, never shown to a configuration. The rest are functions of the host: part(name) gives what
-- the global `name` is made of, or nothing; accessor(type) gives the maker of ba.TYPE, or nothing; ffi() opens LuaJIT's
-- foreign function interface.
local raw, part, accessor, ffi = ...

local error, select, tostring, type = raw.error, raw.select, raw.tostring, raw.type
local rawset, setmetatable = raw.rawset, raw.setmetatable

-- Byte arrays. A program holds an empty table with a locked metatable; its bytes (a pointer into memory of the host that
-- stays where it is for the life of this state) and their number are known only here.
local bytes, sizes = {}, {}
local opaque = { __metatable = false, __newindex = function() error('use ba.set to write a byte array', 2) end }

local function refuse(array, pos, size)
  local length = sizes[array]
  if not length then error('not a byte array: ' .. tostring(array), 2) end
  if type(pos) ~= 'number' then error('a position is a number, not a ' .. type(pos), 2) end
  if pos % 1 ~= 0 then error('position ' .. pos .. ' is not a whole number', 2) end
  local what = size and size .. ' bytes at position ' .. pos .. ' are' or 'position ' .. pos .. ' is'
  error(what .. ' outside the array of ' .. length .. ' bytes', 2)
end

-- The low 32 bits of a number that does not fit into them, as a signed integer.
local function wrap(value, level)
  if type(value) ~= 'number' then error('a value is a number, not a ' .. type(value), level) end
  if value - value ~= 0 then error('the value ' .. value .. ' is not finite', level) end
  local whole = value >= 0 and value - value % 1 or -(-value - -value % 1)
  whole = whole % 4294967296
  return whole < 2147483648 and whole or whole - 4294967296
end

local ba = {}

function ba.get(array, pos)
  local length = sizes[array]
  if length and type(pos) == 'number' and pos >= 0 and pos < length and pos % 1 == 0 then return bytes[array][pos] end
  return refuse(array, pos)
end

function ba.set(array, pos, value)
  local length = sizes[array]
  if length and type(pos) == 'number' and pos >= 0 and pos < length and pos % 1 == 0 then
    if type(value) ~= 'number' or not (value >= -2147483648 and value < 2147483648) then value = wrap(value, 3) end
    bytes[array][pos] = value
    return
  end
  return refuse(array, pos)
end

function ba.len(array)
  local length = sizes[array]
  if length then return length end
  return refuse(array)
end

raw.get, raw.set = ba.get, ba.set
-- What is used of the foreign function interface. The library itself is kept as well, whole: its functions hold tables
-- that LuaJIT reaches without the collector's knowledge whenever a pointer or a union is made.
local pointer, new, copy, text_of, scratch, kept

local function open_ffi()
  local library = ffi()
  kept = library
  pointer, new, copy, text_of = library.typeof('uint8_t *'), library.new, library.copy, library.string
end

-- The text at the beginning of an array, up to its first zero byte: what an attribute of sysfs says.
local function text(array)
  local length = sizes[array] or refuse(array)
  local start, stop = bytes[array], 0
  while stop < length and start[stop] ~= 0 do stop = stop + 1 end
  return text_of(start, stop)
end

setmetatable(ba, {
  __metatable = false,
  __index = function(_, name)
    if name == 'text' then
      rawset(ba, name, text)
      if raw.note_member then raw.note_member('ba', name, text) end
      return text
    end
    local make = accessor(name)
    if not make then return nil end
    if not pointer then open_ffi() end
    scratch = scratch or new(
      'union { uint8_t b[8]; uint16_t h[4]; int16_t i16; uint16_t u16; int32_t i32; uint32_t u32; float f32; double f64; }')
    local access = make(sizes, bytes, scratch, copy, refuse, wrap, type, error, select)
    rawset(ba, name, access)
    if raw.note_member then raw.note_member('ba', name, access) end
    return access
  end,
})

-- For the host: the proxy of a buffer.
local function array(address, size)
  if not pointer then open_ffi() end
  local proxy = setmetatable({}, opaque)
  bytes[proxy], sizes[proxy] = pointer(address), size
  return proxy
end

local function made(maker, ...)
  if maker then return maker(...) end
  return ...
end

local globals

-- Globals that were made late, by name. In the state of which others are copies, `raw.note` and `raw.note_member` note what
-- is made here (permanents.lua).
local late = {}
raw.late = late

local function global(_, name)
  local value = made(part(name))
  if value ~= nil then
    late[name] = value
    rawset(globals, name, value)
    if raw.note then raw.note(name, value) end
  end
  return value
end

-- What nobody here uses would only take memory in every state.
for _, name in raw.ipairs {
  'collectgarbage', 'dofile', 'gcinfo', 'getfenv', 'loadfile', 'loadstring', 'module', 'newproxy', 'print', 'require',
  'setfenv', 'xpcall', '_G',
} do raw[name] = nil end

local params = {}
globals = {
  assert = raw.assert, error = error, getmetatable = raw.getmetatable, ipairs = raw.ipairs, next = raw.next,
  pairs = raw.pairs, pcall = raw.pcall, rawequal = raw.rawequal, rawget = raw.rawget, rawset = rawset, select = select,
  setmetatable = setmetatable, tonumber = raw.tonumber, tostring = tostring, type = type, unpack = raw.unpack,
  _VERSION = raw._VERSION,
  ba = ba, params = params,
}
globals._G = globals

setmetatable(globals, { __metatable = false, __index = global })

-- The first method call on a string opens the string library, which then takes the place of this function.
local function method(_, name)
  return (late.string or global(nil, 'string'))[name]
end

return globals, array, params, method
