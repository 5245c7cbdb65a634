-- Notes what every state has from its beginning or makes on first use, so that persist.lua can name it.
--
-- globals: the program's; raw: LuaJIT's base library; debug: its debug library. Gives the notes: `names` leads from an
-- object to the keys by which any state reaches it (from the globals; '(raw)' begins in the base library, '(string)' in the
-- metatable of strings), `contents` and `metatables` hold what a table was made with, `pristine` the globals.
local globals, raw, debug = ...
local next, type, select = raw.next, raw.type, raw.select
local getmetatable = debug.getmetatable
local names, contents, metatables = {}, {}, {}

local function note(object, ...)
  local kind = type(object)
  if kind ~= 'table' and kind ~= 'function' or names[object] then return end
  names[object] = { ... }
  if kind ~= 'table' or object == raw then return end
  local copy = {}
  for key, value in next, object do
    copy[key] = value
    if select('#', ...) == 1 and type(key) == 'string' then note(value, ..., key) end
  end
  contents[object], metatables[object] = copy, getmetatable(object)
end

-- For the prelude and its parts. A global that is made late; a member of one that is made later still.
function raw.note(name, value) note(value, name) end
local pristine = {}
function raw.note_member(name, key, value)
  contents[pristine[name] or raw.late[name]][key] = value
  note(value, name, key)
end

-- Changes of the globals are looked at one by one.
names[globals] = { '_G' }
for name, value in next, globals do
  pristine[name] = value
  note(value, name)
end
note(getmetatable(''), '(string)')
for name, value in next, raw do
  if type(value) == 'function' then note(value, '(raw)', name) end
end

return { names = names, contents = contents, metatables = metatables, pristine = pristine }
