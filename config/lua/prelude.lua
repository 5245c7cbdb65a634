-- What every configuration and converter finds when it starts: the safe part of Lua, byte arrays, id_create, trikfs_log,
-- include. Everything else (string, table, math, bit, coroutine, filter, the source constructors) is made when its name
-- is first used, because a state of its own for every open file has to be small.
--
-- raw: LuaJIT's base library, never shown to a configuration. The rest are functions of the host:
-- log(text); chunk(name) gives the function of an included file, or nil and the reason;
-- part(name) gives what the global `name` is made of, or nothing; accessor(type) gives the maker of ba.TYPE, or nothing;
-- ffi() opens LuaJIT's foreign function interface.
local raw, log, chunk, part, accessor, ffi = ...

local error, pcall, select, tostring, type = raw.error, raw.pcall, raw.select, raw.tostring, raw.type
local rawset, setmetatable, rawload = raw.rawset, raw.setmetatable, raw.load

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

local get, set = ba.get, ba.set
local library, pointer, scratch

local function open_ffi()
  library = ffi()
  pointer = library.typeof('uint8_t *')
end

setmetatable(ba, {
  __metatable = false,
  __index = function(_, name)
    local make = accessor(name)
    if not make then return nil end
    if not library then open_ffi() end
    scratch = scratch or library.new(
      'union { uint8_t b[8]; int16_t i16; uint16_t u16; int32_t i32; uint32_t u32; float f32; double f64; }')
    local access = make(sizes, bytes, scratch, library.copy, refuse, wrap, type, error, select)
    rawset(ba, name, access)
    return access
  end,
})

-- For the host: the proxy of a buffer.
local function array(address, size)
  if not library then open_ffi() end
  local proxy = setmetatable({}, opaque)
  bytes[proxy], sizes[proxy] = pointer(address), size
  return proxy
end

local function id_create(n)
  if type(n) ~= 'number' or n < 0 or n % 1 ~= 0 then error('id_create wants a number of bytes', 2) end
  return function(a_s, a, b_s, b)
    for i = 0, n - 1 do set(b, i, get(a, i)) end
  end
end

local function trikfs_log(...)
  local count = select('#', ...)
  local text = tostring((...))
  for i = 2, count do text = text .. '\t' .. tostring((select(i, ...))) end
  log(count > 0 and text or '')
end

local function load(text, name, _, env)
  if type(text) ~= 'string' then error('load takes the text of a program', 2) end
  if type(name) ~= 'string' then name = '=load' end
  if env == nil then return rawload(text, name, 't') end
  return rawload(text, name, 't', env)
end

local function handle(handler, ok, ...)
  if ok then return true, ... end
  return false, handler(...)
end

local function include(name)
  local run, problem = chunk(name)
  if not run then error(problem, 2) end
  return run()
end

local function made(maker, ...)
  if maker then return maker(...) end
  return ...
end

local params = {}
local globals = {
  assert = raw.assert, error = error, getmetatable = raw.getmetatable, ipairs = raw.ipairs, next = raw.next,
  pairs = raw.pairs, pcall = pcall, rawequal = raw.rawequal, rawget = raw.rawget, rawset = rawset, select = select,
  setmetatable = setmetatable, tonumber = raw.tonumber, tostring = tostring, type = type, unpack = raw.unpack,
  _VERSION = raw._VERSION,
  -- The real xpcall runs its handler where no hook can end it.
  xpcall = function(f, handler, ...) return handle(handler, pcall(f, ...)) end,
  load = load, loadstring = load, include = include, print = trikfs_log, trikfs_log = trikfs_log,
  ba = ba, id_create = id_create, params = params,
}
globals._G = globals

setmetatable(globals, {
  __metatable = false,
  __index = function(_, name)
    local value = made(part(name))
    if value ~= nil then rawset(globals, name, value) end
    return value
  end,
})

-- The first method call on a string opens the string library, which then takes the place of this function.
local function method(_, name)
  local library = made(part('string'))
  if raw.rawget(globals, 'string') == nil then rawset(globals, 'string', library) end
  return library[name]
end

return globals, array, params, method
