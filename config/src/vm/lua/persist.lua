-- Writes what the converters of one node reach: functions with their upvalues, tables, and the globals that they name.
--
-- segments: the node's path; tree: the global `trikfs` as the program left it; noted: what permanents.lua gave;
-- constant(f, i) looks into functions; first: what math.random gives first in a new state. create(...) and fill(...)
-- append values to the two halves of the image, refer(id) an object to the second: objects are made before they are
-- filled, so that they may refer to each other in circles. The order of the numbers is that of restore.rs.
--
-- What cannot be written raises an error: a coroutine, a foreign value, a function of the host that is not noted.
local segments, tree, globals, noted, first, raw, string, debug, constant, create, fill, refer = ...
local error, next, rawequal, rawget, type, unpack = raw.error, raw.next, raw.rawequal, raw.rawget, raw.type, raw.unpack
local dump, getupvalue, upvalueid, getmetatable, getfenv =
  raw.dump or string.dump, debug.getupvalue, debug.upvalueid, debug.getmetatable, debug.getfenv
local TABLE, FUNCTION, PERMANENT = 1, 2, 3
local END, ENTRY, METATABLE, UPVALUE, JOIN, ENVIRONMENT, GLOBAL, ROOT = 0, 1, 2, 3, 4, 5, 6, 7

local names, late, pristine = noted.names, raw.late, noted.pristine
local queue, ids, count = {}, {}, 0
local every

-- The number of an object; it is made if it has none.
local function id(object)
  local known = ids[object]
  if known then return known end
  count = count + 1
  ids[object], queue[count] = count, object
  local path = names[object]
  if path then
    create(PERMANENT, #path, unpack(path))
    if rawequal(object, globals) then every() end
  elseif type(object) == 'table' then
    local list, others = #object, 0
    for _ in next, object do others = others + 1 end
    create(TABLE, list, others > list and others - list or 0)
  else
    create(FUNCTION, dump(object))
  end
  return count
end

local function put(value)
  local kind = type(value)
  if kind == 'table' or kind == 'function' then
    refer(id(value))
  elseif kind == 'nil' or kind == 'boolean' or kind == 'number' or kind == 'string' then
    fill(value)
  else
    error('a ' .. kind, 0)
  end
end

-- An object is given its number before the operation that refers to it begins: `id` may write operations of its own.
local function ready(value)
  local kind = type(value)
  if kind == 'table' or kind == 'function' then id(value) end
end

local function entry(object, key, value)
  ready(object) ready(key) ready(value)
  fill(ENTRY) put(object) put(key) put(value)
end

local function metatable(object, value)
  ready(object) ready(value)
  fill(METATABLE) put(object) put(value)
end

-- Of the tree remain the node and the groups on the way to it.
local function pruned()
  local root = {}
  local from, to = tree, root
  for i = 1, #segments do
    if type(from) ~= 'table' then break end
    local inner = rawget(from, segments[i])
    local is_group = type(inner) == 'table' and rawget(inner, 'src') == nil
    local copy = is_group and {} or inner
    to[segments[i]] = copy
    if not is_group then break end
    from, to = inner, copy
  end
  return root
end

-- Names whose value can lead to any other: code that uses one may name a global that stands nowhere in it.
local reaches_all = { load = true, loadstring = true, include = true }
local looked_at = {}

-- The global `name`, as far as it is the program's own.
local function global(name)
  if looked_at[name] then return end
  looked_at[name] = true
  local value, original = rawget(globals, name), pristine[name]
  if reaches_all[name] or rawequal(value, globals) then every() end
  if value == nil then
    if original ~= nil then fill(GLOBAL, name, nil) end
  elseif not rawequal(value, original) and not rawequal(value, late[name]) then
    if name == 'trikfs' and rawequal(value, tree) then value = pruned() end
    ready(value)
    fill(GLOBAL, name) put(value)
  end
end

function every()
  if looked_at[every] then return end
  looked_at[every] = true
  for name in next, pristine do global(name) end
  for name, value in next, globals do
    if type(name) == 'string' then global(name) else entry(globals, name, value) end
  end
end

-- The globals that the code of a function names, and those within it.
local function globals_of(prototype)
  local i = -1
  while true do
    local k = constant(prototype, i)
    if k == nil then return end
    if type(k) == 'proto' then globals_of(k) elseif type(k) == 'string' then global(k) end
    i = i - 1
  end
end

local owners = {}

local function upvalues(f)
  local i = 1
  while true do
    local name, value = getupvalue(f, i)
    if name == nil then return end
    local cell = upvalueid(f, i)
    local owner = owners[cell]
    if owner then
      fill(JOIN) put(f) fill(i) put(owner[1]) fill(owner[2])
    else
      owners[cell] = { f, i }
      ready(value)
      fill(UPVALUE) put(f) fill(i) put(value)
    end
    i = i + 1
  end
end

local function entries(object)
  for key, value in next, object do entry(object, key, value) end
  local meta = getmetatable(object)
  if meta ~= nil then metatable(object, meta) end
end

-- What the program changed in tables that every state has.
local function changes()
  for object, contents in next, noted.contents do
    for key, value in next, object do
      if not rawequal(contents[key], value) then entry(object, key, value) end
    end
    for key in next, contents do
      if rawget(object, key) == nil then entry(object, key, nil) end
    end
    local meta = getmetatable(object)
    if not rawequal(meta, noted.metatables[object]) then metatable(object, meta) end
  end
end

-- Only the functions of a chain: what else a stage is made of was read when the configuration was loaded.
local function functions(chain)
  if type(chain) ~= 'table' then return chain end
  local one = rawget(chain, 'converter')
  if one ~= nil then return { converter = one } end
  local list = {}
  for position, stage in next, chain do
    if type(stage) == 'table' then stage = rawget(stage, 'converter') end
    if type(position) == 'number' and type(stage) == 'function' then list[position] = stage end
  end
  return list
end

-- Whether a table is a node and no group: it has a source, which is no node that is called `src`.
local function is_node(from)
  local src = rawget(from, 'src')
  if type(src) ~= 'table' then return src ~= nil end
  return rawget(src, 'src') == nil or rawget(src, '') ~= nil
end

-- A tree with nothing but what the host looks for: `src` tells a node from a group.
local function sought()
  local root = {}
  local from, to = tree, root
  if type(from) ~= 'table' then return root end
  for i = 1, #segments do
    -- The tree itself is no node, whatever its nodes are called.
    if i > 1 and is_node(from) then
      to.src, to.attributes = true, {}
      from, to = rawget(from, 'attributes'), to.attributes
      if type(from) ~= 'table' then return root end
    end
    from = rawget(from, segments[i])
    if type(from) ~= 'table' then return root end
    local inner = {}
    to[segments[i]], to = inner, inner
  end
  to.src, to.params = true, rawget(from, 'params')
  to.converter, to.write_converter = functions(rawget(from, 'converter')), functions(rawget(from, 'write_converter'))
  return root
end

-- A new state would draw again the numbers that were drawn while the program ran.
local math = late.math
if math and noted.is_drawn == nil then noted.is_drawn = noted.contents[math].random() ~= first end
if noted.is_drawn then error('drawn numbers', 0) end

local root = sought()
id(root)
changes()
local at = 1
while at <= count do
  local object = queue[at]
  if not names[object] then
    if type(object) == 'table' then
      entries(object)
    else
      globals_of(object)
      upvalues(object)
      local environment = getfenv(object)
      if not rawequal(environment, globals) then
        id(environment)
        fill(ENVIRONMENT) put(object) put(environment)
      end
    end
  end
  at = at + 1
end
fill(ROOT) put(root) fill(END)
